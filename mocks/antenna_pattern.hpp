#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "hal/units.hpp"

namespace forager::mocks {

// One measured point of a radiation pattern: angle off boresight, and power relative to boresight (0..1).
struct PatternSample {
  double angle_rad = 0.0;
  double power = 0.0;
};

// How the power of a pattern is computed: libm's arc tangents and cosines; polynomials instead (within 2e-15
// of that, some four times as fast); the same in single precision (within 1e-6).
enum class PatternArithmetic : unsigned char { trigonometry, series, series_f32 };

struct PatternSeries;  // the polynomials; mocks/antenna_pattern.cpp

// Normalised power pattern D0 of an antenna, 0..1, 1 along +x of the antenna frame (x boresight, y left, z
// up). Separable: a cut over the azimuth atan2(y, x) times a cut over the elevation atan2(z, hypot(x, y)).
class AntennaPattern {
 public:
  // cos^2(pi/2 azimuth/width_h) cos^2(pi/2 elevation/width_v): half power at +-width/2, first null at +-width
  // and exactly 0 from there on and behind (x <= 0). The bare formula rises again beyond its null. Widths
  // beyond 0..pi give an antenna that radiates nothing.
  [[nodiscard]] static AntennaPattern cosine_squared(double width_h_rad, double width_v_rad);

  // 2^-((2 azimuth/width_h)^2 + (2 elevation/width_v)^2), 0 behind: half power at +-width/2, no null.
  [[nodiscard]] static AntennaPattern gaussian(double width_h_rad, double width_v_rad);

  // Measured cuts, linear between samples and 0 outside them; a table that reaches +-pi has a back lobe.
  // Errors: invalid_argument (fewer than two samples, angles not ascending, power outside 0..1, NaN).
  [[nodiscard]] static hal::Result<AntennaPattern> table(std::vector<PatternSample> azimuth,
                                                         std::vector<PatternSample> elevation);

  // The laboratory's antenna: cosine squared with 70 degrees both ways.
  AntennaPattern()
      : AntennaPattern(Beam{Shape::cosine_squared, hal::deg_to_rad(70.0), hal::deg_to_rad(70.0)}) {}

  // D0 towards a point in the antenna frame (metres; only its direction counts). Never NaN: the origin and
  // points that are not numbers give 0.
  [[nodiscard]] double power(hal::Vec3 point_antenna) const;

  // The same pattern, computed otherwise; `series` is what all begin with. A table is looked up either way.
  [[nodiscard]] AntennaPattern with(PatternArithmetic arithmetic) const;

  enum class Shape : unsigned char { cosine_squared, gaussian };
  struct Beam {
    Shape shape;
    double width_h_rad;
    double width_v_rad;
  };
  // What a formula made it from; nullopt for measured cuts.
  [[nodiscard]] std::optional<Beam> beam() const;

 private:
  struct Table {
    std::vector<PatternSample> azimuth;
    std::vector<PatternSample> elevation;
  };
  explicit AntennaPattern(Beam beam);
  explicit AntennaPattern(Table table) : form_(std::move(table)) {}
  [[nodiscard]] double series_power(const Beam& beam, hal::Vec3 point) const;
  static double trigonometric_power(const Beam& beam, hal::Vec3 point);
  static double table_power(const Table& table, hal::Vec3 point);

  std::variant<Beam, Table> form_;
  PatternArithmetic arithmetic_ = PatternArithmetic::series;
  std::shared_ptr<const PatternSeries> series_;  // shared by all copies; none for a table
};

}  // namespace forager::mocks
