#include "flight/mission.hpp"

namespace forager::flight {

std::string_view to_string(DecisionKind kind) {
  switch (kind) {
    case DecisionKind::forward:
      return "F";
    case DecisionKind::turn_left:
      return "TL";
    case DecisionKind::turn_right:
      return "TR";
    case DecisionKind::turn_back:
      return "TB";
    case DecisionKind::stay:
      return "S";
    case DecisionKind::land:
      return "L";
  }
  return "?";
}

std::string_view to_string(EndReason reason) {
  switch (reason) {
    case EndReason::none:
      return "none";
    case EndReason::no_new_tags:
      return "no_new_tags";
    case EndReason::path_complete:
      return "path_complete";
    case EndReason::time_limit:
      return "time_limit";
    case EndReason::battery:
      return "battery";
    case EndReason::reader_lost:
      return "reader_lost";
    case EndReason::pose_lost:
      return "pose_lost";
    case EndReason::autopilot_lost:
      return "autopilot_lost";
    case EndReason::store_failed:
      return "store_failed";
    case EndReason::autopilot_mode:
      return "autopilot_mode";
    case EndReason::refused:
      return "refused";
    case EndReason::halted:
      return "halted";
  }
  return "?";
}

}  // namespace forager::flight
