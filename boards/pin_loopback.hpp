#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/digital_in.hpp"
#include "hal/digital_out.hpp"
#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// An output wired to an input: drives one level after the other, waits for the edge, and measures how long
// after the command the kernel saw it. Ends with the output inactive.
class PinLoopback {
 public:
  struct Config {
    std::uint32_t toggles = 100;
    hal::Duration wait = std::chrono::milliseconds(100);  // for an edge; then the wire is taken for broken
  };
  struct Result {
    std::uint32_t toggles = 0;
    std::uint32_t edges = 0;  // that came as they should
    std::uint32_t extra = 0;  // that nobody caused: bouncing contacts, noise
    std::vector<hal::Duration> latency{};
    std::string fault{};  // empty: none
  };
  // Both borrowed.
  PinLoopback(hal::DigitalOut& out, hal::EdgeIn& in, const Config& config)
      : out_(&out), in_(&in), config_(config) {}

  // False: it is over. Errors: those of the lines.
  [[nodiscard]] hal::Result<bool> update(hal::Instant now);
  [[nodiscard]] const Result& result() const { return result_; }

 private:
  [[nodiscard]] hal::Result<> toggle(hal::Instant now);
  [[nodiscard]] hal::Result<> take_edges();
  bool end(std::string fault);

  hal::DigitalOut* out_;
  hal::EdgeIn* in_;
  Config config_;
  Result result_;
  bool level_ = false;
  bool seen_ = true;  // the edge of the last toggle has come
  bool level_right_ = false;
  std::optional<hal::Instant> toggled_;
  std::optional<hal::Instant> settle_;
};

}  // namespace forager::boards
