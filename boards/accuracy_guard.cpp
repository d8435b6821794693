#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "boards/accuracy_row.hpp"
#include "boards/wide.hpp"
#include "flight/obstacle_guard.hpp"
#include "hal/random.hpp"

// The nearest range the obstacle guard finds in the corridor, against the same rule evaluated pixel by pixel
// to 100 bits on the same pixels: only a point whose rounding moves it across the corridor's edge can differ.
namespace forager::boards {
namespace {

constexpr int kColumns = 640;
constexpr int kRows = 480;
constexpr hal::Instant kNow{std::chrono::seconds(1)};
constexpr flight::GuardConfig kConfig{};
constexpr double kHalfM = kConfig.half_width_m + kConfig.side_margin_m;

hal::DepthCameraModel camera() { return {kColumns, kRows, 343.0, 442.0, 320.0, 240.0, 0.15, 7.0}; }

double left_of(int column) { return -(column + 0.5 - camera().cx_px) / camera().fx_px; }
double above(int row) { return -(row + 0.5 - camera().cy_px) / camera().fy_px; }

std::size_t pixel_at(int row, int column) {
  return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
}

struct Frame {
  std::vector<float> metres;
  std::vector<std::uint16_t> millimetres;
  double pitch_rad = 0.0;
};
using Frames = std::vector<Frame>;

// Shelves at both sides, floor, end wall, 3 % of the pixels unknown. wall_m = half the corridor: every pixel
// of the walls lies on its edge and rounding decides.
Frame aisle(hal::Random& random, double wall_m, double noise_m) {
  Frame frame;
  frame.pitch_rad = random.uniform(-0.1, 0.1);
  const double end_m = random.uniform(1.0, 7.0);
  const double floor_m = random.uniform(1.0, 2.0);
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const double down = std::max(-above(r), 1e-9);
      const double depth_m =
          std::min({end_m, wall_m / std::abs(left_of(c)), floor_m / down}) + noise_m * random.normal();
      const bool known = !random.chance(0.03);
      frame.metres.push_back(known ? static_cast<float>(depth_m) : 0.0F);
      frame.millimetres.push_back(known ? static_cast<std::uint16_t>(depth_m * 1000.0) : std::uint16_t{0});
    }
  return frame;
}

double nearest_of(std::vector<double>& inside) {
  if (inside.size() < kConfig.nearest) return camera().max_m;
  const auto kth = inside.begin() + kConfig.nearest - 1;
  std::nth_element(inside.begin(), kth, inside.end());
  return std::min(*kth, camera().max_m);
}

// Depth of a pixel in metres; 0 unknown.
double metres(const Frame& frame, std::size_t pixel, bool as_metres) {
  return as_metres ? static_cast<double>(frame.metres[pixel]) : frame.millimetres[pixel] * 1e-3;
}

double exact_range_m(const Frame& frame, bool as_metres) {
  const WideDirection pitch = direction(Wide(frame.pitch_rad));
  std::vector<double> inside;
  for (int r = 0; r < kRows; ++r) {
    const Wide up = pitch.cos * Wide(-(r + 0.5 - camera().cy_px)) / Wide(camera().fy_px) - pitch.sin;
    for (int c = 0; c < kColumns; ++c) {
      const std::size_t pixel = pixel_at(r, c);
      const double depth = metres(frame, pixel, as_metres);
      if (!(depth >= camera().min_m)) continue;
      const Wide wide = as_metres ? Wide(depth) : Wide(frame.millimetres[pixel]) / Wide(1000.0);
      const Wide left = wide * Wide(std::abs(c + 0.5 - camera().cx_px));
      if (Wide(kHalfM) * Wide(camera().fx_px) < left) continue;
      const Wide height = wide * up;
      if (Wide(kConfig.above_m) < height || height < Wide(-kConfig.below_m)) continue;
      inside.push_back(depth);
    }
  }
  return nearest_of(inside);
}

// The rule as one writes it down: project, then compare.
template <class T>
double projected_range_m(const Frame& frame) {
  const hal::DepthCameraModel model = camera();
  const T cosine = std::cos(static_cast<T>(frame.pitch_rad));
  const T sine = std::sin(static_cast<T>(frame.pitch_rad));
  const T focal_x = static_cast<T>(model.fx_px);
  const T focal_y = static_cast<T>(model.fy_px);
  std::vector<double> inside;
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const T depth = static_cast<T>(frame.metres[pixel_at(r, c)]);
      if (!(depth >= static_cast<T>(model.min_m))) continue;
      const T y = -depth * (static_cast<T>(c) + T(0.5) - static_cast<T>(model.cx_px)) / focal_x;
      const T z = -depth * (static_cast<T>(r) + T(0.5) - static_cast<T>(model.cy_px)) / focal_y;
      const T height = cosine * z - sine * depth;
      if (std::abs(y) <= static_cast<T>(kHalfM) && height <= static_cast<T>(kConfig.above_m) &&
          height >= static_cast<T>(-kConfig.below_m))
        inside.push_back(static_cast<double>(depth));
    }
  return nearest_of(inside);
}

template <bool kMetres>
double guarded_range_m(const Frame& frame) {
  // One guard as in flight: it keeps its tables from frame to frame.
  static thread_local flight::ObstacleGuard guard(kConfig);
  hal::DepthFrame image{kNow, camera(), std::span<const float>(frame.metres)};
  if (!kMetres) image.pixels = std::span<const std::uint16_t>(frame.millimetres);
  return guard.check(image, 0.5, frame.pitch_rad, kNow).range_m;
}

AccuracyRow row(const std::string& name, std::string variant, const std::shared_ptr<Frames>& frames,
                double (*solve)(const Frame&), bool as_metres) {
  AccuracyRow out{
      .name = name, .variant = std::move(variant), .reference = "every pixel projected to 100 bits"};
  for (const Frame& frame : *frames) {
    const double exact = exact_range_m(frame, as_metres);
    const double error = std::abs(solve(frame) - exact);
    out.max_abs_error = std::max(out.max_abs_error, error);
    out.max_rel_error = std::max(out.max_rel_error, error / exact);
  }
  const auto sink = std::make_shared<double>(0.0);
  out.work = [frames, solve, sink] { *sink += solve(frames->front()); };
  return out;
}

}  // namespace

std::vector<AccuracyRow> accuracy_guard(const AccuracyOptions& options) {
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(10.0 * options.effort)));
  hal::Random random(options.seed);
  std::vector<AccuracyRow> rows;
  for (const bool on_the_edge : {false, true}) {
    const std::string name = on_the_edge ? "obstacle guard: range, metres, walls on the corridor's edge"
                                         : "obstacle guard: range, metres, aisle";
    const auto frames = std::make_shared<Frames>();
    for (std::size_t i = 0; i < count; ++i)
      frames->push_back(on_the_edge ? aisle(random, kHalfM, 0.0)
                                    : aisle(random, random.uniform(0.7, 1.75), 0.01));
    rows.push_back(row(name, "tables, millimetres", frames, guarded_range_m<false>, false));
    rows.push_back(row(name, "tables, f32 metres", frames, guarded_range_m<true>, true));
    rows.push_back(row(name, "projection, f32", frames, projected_range_m<float>, true));
    rows.push_back(row(name, "projection, f64", frames, projected_range_m<double>, true));
  }
  return rows;
}

}  // namespace forager::boards
