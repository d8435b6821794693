#pragma once

#include <string>
#include <string_view>

#include "boards/brake_bench.hpp"
#include "boards/brake_board.hpp"
#include "hal/time.hpp"
#include "servo/brakes.hpp"

namespace forager::tools {

// What `forager brake` prints: text for people, or JSON lines.
class BrakeOutput {
 public:
  explicit BrakeOutput(bool json) : json_(json) {}

  void list(const boards::BrakeBoard& board) const;
  void note(hal::Instant now, std::string_view source, std::string_view text) const;
  // How things stand, if that is other than what was printed last.
  void state(hal::Instant now, const servo::BrakePair& pair, const boards::BrakeBench& bench);

 private:
  void line(std::string_view side, const boards::BrakeLine& line) const;
  bool json_;
  std::string last_;
};

}  // namespace forager::tools
