#pragma once

#include <cstdint>
#include <vector>

#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "mocks/antenna_pattern.hpp"
#include "mocks/detection.hpp"
#include "mocks/tag_dipole.hpp"

namespace forager::mocks {

// An antenna on the vehicle and the reader port its cable goes to.
struct AntennaMounting {
  int port = 0;              // 1-based
  hal::Vec3 position_body;   // metres
  double bearing_rad = 0.0;  // boresight in the body frame, left positive
  double tilt_rad = 0.0;     // boresight above the horizontal of the body
};

// How radio waves and tags behave in the simulated warehouse. One set serves every scene; a fit to recorded
// runs replaces the numbers.
struct AirParameters {
  // Detection (mocks/detection.hpp). R0 is the boresight distance at which half of the median tags answer
  // within T0 of listening at 30 dBm.
  double r0_m = 2.4;
  double t0_s = 1.0;
  AntennaPattern pattern;
  double pattern_exponent = kPaperPatternExponent;

  // A chip wakes up only above a threshold of power: beyond this normalised range a tag is dead, however long
  // the reader listens. Infinite: no limit.
  double power_up_limit = 2.0;
  // Sensitivity of a tag (chip, orientation, what it is glued to), fixed for ever: standard deviation in dB,
  // cut at 3 deviations.
  double spread_db = 3.0;
  // Tags as dipoles that hear one polarisation, on top of the spread. Off: what orientation costs is part of
  // the spread.
  TagDipoles dipoles;
  // Multipath between one antenna and one tag, frozen while both stay: power of the direct path over that of
  // the scattered ones (Rician K) in dB, 60 and above: none; and the distance over which it changes.
  double rician_k_db = 6.0;
  double fade_length_m = 0.17;  // half a wavelength at 867 MHz
  // Loss for each obstacle between antenna and tag, dB on the forward link; 0: waves pass through everything.
  double occlusion_db = 0.0;

  // Strength of replies: at 1 m on boresight with 30 dBm, then the two-way radar equation.
  double rssi_at_1m_dbm = -53.0;
  double rssi_noise_db = 1.5;

  // The reader's rhythm. One radio listens on its ports in turn; it leaves a port when nothing new answered
  // for its patience (log-normal) and after max_dwell at the latest.
  double patience_median_s = 0.018;
  double patience_log_sigma = 0.8;
  double max_dwell_s = 1.5;
  double settle_s = 0.001;  // from switching to the first possible reply
  // round_parameters() (mocks/gen2_slot_parameters.hpp) derives both from the link; these are of no certain
  // one.
  double singulation_s = 1.0 / 300;  // one reply at most in this time
  double round_s = 0.014;            // with target AB a tag answers once per round

  // How long a tag that was counted stays silent once its timer runs (Gen2 table 6.14), even over tags.
  double s1_persistence_min_s = 0.5;
  double s1_persistence_max_s = 5.0;
  double s2_persistence_min_s = 2.0;  // S2 and S3, after power was lost
  double s2_persistence_max_s = 20.0;

  // Tags expected to answer less often than this within T0 are not drawn at all: of N such tags fewer than
  // N * hazard_cut * (time / T0) answers are lost. 0 draws every tag.
  double hazard_cut = 1e-6;

  // What is left out or computed again less often, each by itself; all are on unless their cost in accuracy
  // is being measured.
  //
  // Tags in range are found through a grid. Off: by a look at every one. The same replies, byte for byte.
  bool skip_by_grid = true;
  // Tags in directions an antenna does not hear are not drawn. Their hazard is 0: no error.
  bool skip_behind = true;
  // Nothing is drawn for an antenna before which there is no tag in range. No error.
  bool skip_blind_antennas = true;
  // Tags that their session keeps silent for the next second are not drawn. No error: an answer of theirs
  // would be refused.
  bool skip_silent = true;
  // While body and antenna moved by less than this and turned by less than that since the geometry was last
  // computed, it stands. The replies are those of antennas displaced by no more; both errors vanish at rest.
  // 0: computed anew every 5 ms.
  double unchanged_m = 0.005;
  double unchanged_rad = 0.005;
};

// Errors: invalid_argument naming the field, its value and what is allowed.
[[nodiscard]] hal::Result<> validate(const AirParameters& air, const std::vector<AntennaMounting>& antennas);

}  // namespace forager::mocks
