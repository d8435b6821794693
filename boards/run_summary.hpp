#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "boards/layout_check.hpp"
#include "flight/mission.hpp"

namespace forager::boards {

struct PortSummary {
  std::uint8_t port = 0;
  std::string name;
  double bearing_rad = 0.0;
  std::uint64_t reads = 0;
  double new_tags = 0.0;  // heard first by this port (shares with the split rule)
};

// What a run came to.
struct RunSummary {
  std::string scene;
  std::string title;
  std::string board;
  std::string policy;
  std::uint64_t seed = 0;
  std::optional<std::size_t> tags_present;  // wanted tags in the world; empty in a real place
  std::size_t tags_read = 0;                // of those (in a real place: all different tags)
  std::size_t other_tags_read = 0;          // bystanders
  std::uint64_t reads = 0;
  double sim_time_s = 0.0;     // from the start of the run to its end
  double flight_time_s = 0.0;  // from take-off to touch-down
  double path_m = 0.0;
  std::size_t decisions = 0;
  std::uint32_t windows = 0;
  flight::EndReason end = flight::EndReason::none;
  std::string detail;               // why, in words
  std::uint32_t reader_losses = 0;  // times the link was lost
  std::uint32_t autopilot_losses = 0;
  bool radio_may_be_on = false;  // the reader has not confirmed that it stopped
  std::uint32_t crashes = 0;
  std::optional<double> battery_fraction;
  std::vector<PortSummary> ports;
  // Against the scene's list of its tags, where that is wrong on purpose; empty: it lists them as they are.
  std::optional<LayoutCheck> layout;
};

}  // namespace forager::boards
