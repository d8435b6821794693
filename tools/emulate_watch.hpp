#pragma once

#include <string>
#include <string_view>

#include "boards/emulate.hpp"
#include "hal/time.hpp"

namespace forager::tools {

// What an emulator says while it serves: for a person where it can be reached (stdout), what happens and how
// it stands (stderr); for a program the same as JSON lines on stdout. Every line is out before the next call.
class EmulateWatch {
 public:
  struct Options {
    std::string device;  // "reader", "autopilot"
    bool json = false;
    bool notes = true;
    bool status_line = false;  // on a terminal
    double status_every_s = 5.0;
  };
  // `start` is where the notes count their time from.
  EmulateWatch(Options options, hal::Instant start);
  ~EmulateWatch();
  EmulateWatch(const EmulateWatch&) = delete;
  EmulateWatch& operator=(const EmulateWatch&) = delete;

  void listening(const boards::EmulatedServer& server);
  void note(hal::Instant now, std::string_view source, std::string_view text);
  void update(const boards::EmulatedServer& server, hal::Instant now, double wall_time_s);
  void ended(std::string_view why);

 private:
  void clear_line();

  Options options_;
  hal::Instant start_;
  double next_status_s_;
  bool line_open_ = false;
};

}  // namespace forager::tools
