#pragma once

namespace forager::tools {

// Catches SIGINT, SIGTERM and SIGHUP so that a mission can land instead of dying; a second signal of any of
// them kills the program at once, as if nothing were caught. SIGHUP stays ignored if it was (nohup). One per
// process.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  [[nodiscard]] static bool raised();
  // Goes on as if none had come, for whatever must still be brought into its safe state.
  static void forget();
  // Name of the signal caught ("SIGINT"), or "".
  [[nodiscard]] static const char* name();
};

}  // namespace forager::tools
