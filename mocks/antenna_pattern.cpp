#include "mocks/antenna_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mocks/detection_scalar.hpp"
#include "mocks/lane_beam.hpp"

namespace forager::mocks {
namespace {

double squared(double x) { return x * x; }

bool usable_width(double width_rad) { return width_rad > 0.0 && width_rad <= hal::kPi; }

double interpolate(const std::vector<PatternSample>& cut, double angle_rad) {
  if (!(angle_rad >= cut.front().angle_rad && angle_rad <= cut.back().angle_rad)) return 0.0;
  const auto above = std::upper_bound(cut.begin(), cut.end(), angle_rad,
                                      [](double a, const PatternSample& s) { return a < s.angle_rad; });
  if (above == cut.end()) return cut.back().power;
  const auto below = above - 1;
  const double share = (angle_rad - below->angle_rad) / (above->angle_rad - below->angle_rad);
  return below->power + share * (above->power - below->power);
}

hal::Result<> check_cut(const std::vector<PatternSample>& cut, const char* name) {
  const auto refuse = [&](std::string detail) {
    return hal::fail(hal::ErrorCode::invalid_argument, "antenna pattern", fmt::format("read {} table", name),
                     std::move(detail));
  };
  if (cut.size() < 2) return refuse("fewer than two samples");
  for (std::size_t i = 0; i < cut.size(); ++i) {
    if (!std::isfinite(cut[i].angle_rad) || !(cut[i].power >= 0.0 && cut[i].power <= 1.0))
      return refuse(
          fmt::format("sample {}: power {} at {} rad is not within 0..1", i, cut[i].power, cut[i].angle_rad));
    if (i > 0 && cut[i].angle_rad <= cut[i - 1].angle_rad)
      return refuse(fmt::format("sample {}: angle {} does not ascend", i, cut[i].angle_rad));
  }
  return {};
}

}  // namespace

struct PatternSeries {
  LaneBeam<double> f64;
  LaneBeam<float> f32;
  double scale;  // of the amplitude, to be 1 on boresight

  explicit PatternSeries(const AntennaPattern::Beam& beam)
      : PatternSeries(beam.shape == AntennaPattern::Shape::cosine_squared, beam.width_h_rad,
                      beam.width_v_rad) {}
  PatternSeries(bool cosine, double width_h_rad, double width_v_rad)
      : f64(make_lane_beam<double>(cosine, width_h_rad, width_v_rad)),
        f32(make_lane_beam<float>(cosine, width_h_rad, width_v_rad)),
        scale(1.0 / left_out_of_amplitude(cosine, width_h_rad, width_v_rad)) {}
};

AntennaPattern AntennaPattern::cosine_squared(double width_h_rad, double width_v_rad) {
  return AntennaPattern(Beam{Shape::cosine_squared, width_h_rad, width_v_rad});
}

AntennaPattern AntennaPattern::gaussian(double width_h_rad, double width_v_rad) {
  return AntennaPattern(Beam{Shape::gaussian, width_h_rad, width_v_rad});
}

hal::Result<AntennaPattern> AntennaPattern::table(std::vector<PatternSample> azimuth,
                                                  std::vector<PatternSample> elevation) {
  FORAGER_TRY(check_cut(azimuth, "azimuth"));
  FORAGER_TRY(check_cut(elevation, "elevation"));
  return AntennaPattern(Table{std::move(azimuth), std::move(elevation)});
}

AntennaPattern::AntennaPattern(Beam beam) : form_(beam), series_(std::make_shared<PatternSeries>(beam)) {}

AntennaPattern AntennaPattern::with(PatternArithmetic arithmetic) const {
  AntennaPattern other = *this;
  other.arithmetic_ = arithmetic;
  return other;
}

double AntennaPattern::power(hal::Vec3 point) const {
  const Beam* const beam = std::get_if<Beam>(&form_);
  if (beam == nullptr) return table_power(*std::get_if<Table>(&form_), point);
  return arithmetic_ == PatternArithmetic::trigonometry ? trigonometric_power(*beam, point)
                                                        : series_power(*beam, point);
}

double AntennaPattern::series_power(const Beam& beam, hal::Vec3 point) const {
  const auto amplitude = [&]<class T>(const LaneBeam<T>& lanes, double scale) {
    const auto x = static_cast<T>(point.x), y = static_cast<T>(point.y), z = static_cast<T>(point.z);
    if (!(x > T(0))) return 0.0;
    if (needs_exact(lanes, x, y, z)) return std::sqrt(trigonometric_power(beam, point));
    return static_cast<double>(pattern_amplitude(lanes, x, y, z)) * scale;
  };
  return std::min(
      1.0, squared(arithmetic_ == PatternArithmetic::series_f32 ? amplitude(series_->f32, series_->scale)
                                                                : amplitude(series_->f64, series_->scale)));
}

std::optional<AntennaPattern::Beam> AntennaPattern::beam() const {
  const Beam* const beam = std::get_if<Beam>(&form_);
  return beam != nullptr ? std::optional(*beam) : std::nullopt;
}

double AntennaPattern::trigonometric_power(const Beam& beam, hal::Vec3 point) {
  // Written so that NaN falls on the side of 0.
  if (!(point.x > 0.0) || !usable_width(beam.width_h_rad) || !usable_width(beam.width_v_rad)) return 0.0;
  const double azimuth = std::atan2(point.y, point.x);
  const double elevation = std::atan2(point.z, std::sqrt(squared(point.x) + squared(point.y)));
  if (beam.shape == Shape::gaussian) {
    const double exponent =
        squared(2.0 * azimuth / beam.width_h_rad) + squared(2.0 * elevation / beam.width_v_rad);
    return exponent >= 0.0 ? std::exp2(-exponent) : 0.0;
  }
  if (!(std::abs(azimuth) < beam.width_h_rad && std::abs(elevation) < beam.width_v_rad)) return 0.0;
  return squared(std::cos(0.5 * hal::kPi * (azimuth / beam.width_h_rad)) *
                 std::cos(0.5 * hal::kPi * (elevation / beam.width_v_rad)));
}

double AntennaPattern::table_power(const Table& table, hal::Vec3 point) {
  if (point == hal::Vec3{}) return 0.0;
  const double azimuth = std::atan2(point.y, point.x);
  const double elevation = std::atan2(point.z, std::hypot(point.x, point.y));
  return interpolate(table.azimuth, azimuth) * interpolate(table.elevation, elevation);
}

}  // namespace forager::mocks
