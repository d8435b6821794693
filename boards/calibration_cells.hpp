#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "boards/calibration_data.hpp"
#include "boards/scene.hpp"

namespace forager::boards {

// What one tag did at one port while the geometry stayed about the same: in `seen` of the time slices it was
// heard, for seen_listen_s each until then on average; in the others it was not, for unseen_listen_s
// together.
struct CalibrationBin {
  double range_m = 0.0;  // R / D0^e: the range on boresight at which the link would be the same
  double seen_listen_s = 0.0;
  double unseen_listen_s = 0.0;
  std::uint32_t seen = 0;
  std::uint32_t unseen = 0;
};

// A recording brought into the form that the likelihood wants. Bins of one tag that share their fade stand
// together as a cell (one port, one place of the antenna), cells of one tag as the tag's.
struct CalibrationCells {
  std::vector<CalibrationBin> bins;
  std::vector<std::size_t> cell_begin;  // into bins, and the end
  std::vector<std::size_t> tag_begin;   // into cells, and the end
  double slices = 0.0;                  // seen or not, of all bins
  double seen_slices = 0.0;
  double nearest_m = 0.0;  // 5 and 95 % points of the ranges of what was heard
  double farthest_m = 0.0;
  std::uint64_t reads = 0;  // taken in; those without a pose are not
  // Tags (indices) that were heard, but mostly from where their listed place is out of reach; they have no
  // bins.
  std::vector<std::uint32_t> misplaced;
  double moved_m = 0.0;  // largest distance between two places
};

// How long the radio listens to a port is not in the recording. A burst of reads on one port without a pause
// above `burst_gap_s` is time spent there; the rest of each slice is shared evenly by the ports.
struct CalibrationSlicing {
  double slice_s = 0.2;
  double burst_gap_s = 0.06;
  double rest_m = 0.02;  // moved by less: still the same geometry
  double rest_rad = 0.035;
  double fade_length_m = 0.12;  // places nearer than this share their fade
  // Places from which replies would come at less than this above the reader's sensitivity are left out: there
  // it drops the weaker ones, whatever the tags do. Twice the noise of a reported RSSI.
  double above_sensitivity_db = 3.0;
};

// The antennas are those of the scene's read plan, on the vehicle's centre. Tags never in front of an antenna
// have no bins.
[[nodiscard]] CalibrationCells cells_of(const Recording& recording, const Scene& scene,
                                        const CalibrationSlicing& slicing = {});

}  // namespace forager::boards
