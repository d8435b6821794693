#pragma once

#include <string>
#include <string_view>

#include "flight/mavlink_link.hpp"
#include "flight/mavlink_monitor.hpp"
#include "hal/time.hpp"
#include "tools/bench_session.hpp"

namespace forager::tools {

// One moment of a watched MAVLink line.
struct MavlinkMoment {
  hal::Instant now;
  hal::Duration interval{};
  const flight::MavlinkLink& link;
  const flight::MavlinkMonitor& monitor;
  std::string why;  // nothing of an autopilot came in the interval
};

// Prints what `forager mavlink listen` hears: a table that is written over at a terminal, elsewhere one line
// an interval, or JSON lines; and at the end the table of the whole.
class MavlinkOutput {
 public:
  explicit MavlinkOutput(bool json) : out_(json), live_(!json && LiveView::possible()) {}

  void note(hal::Instant now, std::string_view source, std::string_view text);
  void raw(hal::Instant now, const flight::mavlink::Frame& frame);
  void moment(const MavlinkMoment& moment);
  void end(const MavlinkMoment& moment);

 private:
  BenchOutput out_;
  bool live_;
  std::string last_why_;
};

}  // namespace forager::tools
