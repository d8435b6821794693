#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "hal/time.hpp"

namespace forager::hal {

// One ordered, time-stamped record of everything that happened in a run: what was decided, commanded, sent
// and heard. All parts and all doubles of a run share one, so order across devices is visible, and equal
// seeds give equal bytes. A journal copies what it is given and never fails towards the caller.
class Journal {
 public:
  virtual ~Journal() = default;
  // source: who ("mission", "autopilot", "sim-reader"); text: one line without the line break.
  void note(Instant now, std::string_view source, std::string_view text) { do_note(now, source, text); }
  // Bytes on a wire; direction is "tx" or "rx" as seen by `source`.
  void wire(Instant now, std::string_view source, std::string_view direction,
            std::span<const std::byte> bytes) {
    do_wire(now, source, direction, bytes);
  }

 private:
  virtual void do_note(Instant now, std::string_view source, std::string_view text) = 0;
  virtual void do_wire(Instant now, std::string_view source, std::string_view direction,
                       std::span<const std::byte> bytes) = 0;
};

// Keeps nothing.
class NullJournal final : public Journal {
 private:
  void do_note(Instant, std::string_view, std::string_view) override {}
  void do_wire(Instant, std::string_view, std::string_view, std::span<const std::byte>) override {}
};

}  // namespace forager::hal
