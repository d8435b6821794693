#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "boards/calibration_data.hpp"
#include "boards/calibration_likelihood.hpp"
#include "boards/scene.hpp"
#include "hal/error.hpp"

namespace forager::boards {

// One parameter found, with the interval that holds the truth in 95 % of such recordings.
struct FittedParameter {
  std::string name;  // as in a scene's [world.radio]: "r0_m", "spread_db", "rician_k_db"
  std::string unit;
  double value = 0.0;
  double low = 0.0;  // at the edge of what is looked at: open on this side
  double high = 0.0;
  bool open_low = false;
  bool open_high = false;
  bool held = false;  // given, not fitted
};

// Observed and expected over one span of ranges.
struct CalibrationResidual {
  double from_m = 0.0;
  double to_m = 0.0;
  double slices = 0.0;        // time slices of tags at ports
  double seen = 0.0;          // with at least one read
  double expected = 0.0;      // by the fitted parameters
  double standardised = 0.0;  // (seen - expected) / sqrt(variance); sensitivity and fade widen it
};

// A tag that was heard mostly from where its listed place is out of reach. It is left out of the fit.
struct MisplacedTag {
  std::string epc;
  hal::Vec3 listed;
  hal::Vec3 heard_from;  // the vehicle at the strongest read
  std::uint64_t reads = 0;
};

struct Calibration {
  std::vector<FittedParameter> parameters;
  std::vector<MisplacedTag> misplaced;
  std::vector<CalibrationResidual> residuals;
  double log_likelihood = 0.0;
  int evaluations = 0;
  std::size_t tags = 0;
  std::uint64_t reads = 0;
  std::uint64_t strangers = 0;
};

struct CalibrationOptions {
  // Held at a value instead of fitted.
  std::optional<double> spread_db;
  std::optional<double> rician_k_db;
  CalibrationSlicing slicing;
};

// Fits R0, spread and fade to a recording by maximum likelihood (CalibrationLikelihood); antennas, pattern,
// T0 and power-up limit are the scene's. Intervals are profile likelihoods: where twice the loss of
// log-likelihood, the other parameters fitted anew, reaches 3.84 times
// what the estimate scatters more than the likelihood says (sandwich variance over tags, at least 1).
//
// Errors: refused, when the recording cannot tell a parameter, naming it and why: too few reads or tags, no
// poses, all ranges the same, everything heard or nothing, a vehicle that never left the fade it started in,
// a likelihood that is flat in a parameter.
[[nodiscard]] hal::Result<Calibration> calibrate(const Recording& recording, const Scene& scene,
                                                 const CalibrationOptions& options = {});

// Twice the loss of log-likelihood against the best fit when one parameter (0 R0, 1 spread, 2 K) is fixed at
// a value and the others are fitted, divided by the same excess: below 3.84 its 95 % interval holds the
// value. For tests of coverage. Errors: those of calibrate.
[[nodiscard]] hal::Result<std::array<double, 3>> profile_losses(const Recording& recording,
                                                                const Scene& scene,
                                                                const CalibrationParameters& truth);

// A simulated recording: the scene's vehicle is carried along its waypoints at its mission's speed, back and
// forth (or hovers, without waypoints) for `seconds`, and everything its reader hears is written down. The
// vehicle and its camera take no part. Its tags are where the scene lists them; reads of those it does not
// list are counted as strangers and left out. Deterministic by seed.
[[nodiscard]] hal::Result<Recording> simulate_recording(const Scene& scene, std::uint64_t seed,
                                                        double seconds);

}  // namespace forager::boards
