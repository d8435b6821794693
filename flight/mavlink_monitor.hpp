#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flight/mavlink/frame.hpp"
#include "flight/mavlink/messages_link.hpp"
#include "flight/mavlink/parser.hpp"
#include "hal/time.hpp"

namespace forager::flight {

// "GUIDED", "LAND"; a mode of an autopilot or vehicle that is not known here as "mode 23".
[[nodiscard]] std::string mode_text(const mavlink::Heartbeat& heartbeat);
// "hexarotor", "ground station", "type 99".
[[nodiscard]] std::string vehicle_text(std::uint8_t mav_type);
// "ArduPilot", "no autopilot", "autopilot 99".
[[nodiscard]] std::string autopilot_text(std::uint8_t mav_autopilot);

// Who says what on a MAVLink line, and how often; for a person who looks at it from outside. Believes every
// good frame, whoever sent it.
class MavlinkMonitor {
 public:
  // One kind of message of one component.
  struct Traffic {
    std::uint8_t sysid = 0;
    std::uint8_t compid = 0;
    std::uint32_t id = 0;
    std::string_view name;
    std::uint64_t frames = 0;
    std::uint64_t interval_frames = 0;
    std::uint64_t bytes = 0;
    hal::Instant last;
  };
  // A component that has sent a heartbeat.
  struct Component {
    std::uint8_t sysid = 0;
    std::uint8_t compid = 0;
    mavlink::Heartbeat heartbeat;
    mavlink::Version version = mavlink::Version::v2;
    bool is_signed = false;
    hal::Instant last_heartbeat;
    std::optional<int> battery_percent;   // SYS_STATUS or BATTERY_STATUS of its system
    std::optional<double> battery_volts;  // SYS_STATUS
  };

  // Gives the text of a STATUSTEXT, "[4] PreArm: ...", else nothing.
  std::optional<std::string> take(const mavlink::Frame& frame, hal::Instant now);
  // Begins an interval.
  void next_interval();

  // By system, component and id.
  [[nodiscard]] std::span<const Traffic> traffic() const { return traffic_; }
  [[nodiscard]] std::span<const Component> components() const { return components_; }
  [[nodiscard]] std::uint64_t interval_frames() const { return interval_frames_; }
  // The first that is an autopilot; null: none was heard.
  [[nodiscard]] const Component* autopilot() const;

 private:
  Component* component(std::uint8_t sysid, std::uint8_t compid);
  void take_heartbeat(const mavlink::Frame& frame, hal::Instant now);
  void take_battery(const mavlink::Frame& frame);

  std::vector<Traffic> traffic_;
  std::vector<Component> components_;
  std::uint64_t interval_frames_ = 0;
};

// Why no frame came, or none of an autopilot, the likeliest cause first; one line.
struct MavlinkSilence {
  bool link_open = false;
  std::string link_problem;  // why it is not open
  bool serial = false;       // a serial line, where baud rates can differ
  mavlink::ParserStats parser;
  bool autopilot_heard = false;
};
[[nodiscard]] std::string why_silent(const MavlinkSilence& facts);

}  // namespace forager::flight
