#pragma once

#include <string_view>

#include "boards/esc_bench.hpp"
#include "flight/esc_bank.hpp"
#include "hal/time.hpp"

namespace forager::tools {

// What `forager esc` prints: text for people, or JSON lines.
class EscOutput {
 public:
  EscOutput(bool json, bool pulses) : json_(json), pulses_(pulses) {}

  // Notes of bank and emulated ESCs; changes of pulses only if asked for.
  void note(hal::Instant now, std::string_view source, std::string_view text);
  // Something a person must do or know.
  void tell(hal::Instant now, std::string_view text);
  void list(const boards::EscBoard& board);
  // The last it prints: that the lines are told once more to stop is no news.
  void end(const flight::EscBank& bank, const boards::EscBench& bench, hal::Instant now);

 private:
  bool json_;
  bool pulses_;
  bool ended_ = false;
};

}  // namespace forager::tools
