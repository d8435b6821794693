#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "hal/error.hpp"
#include "hal/journal.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// The journal of a run: deterministic text lines into a file, and notes (not wire bytes) to a listener.
class RunJournal : public hal::Journal {
 public:
  using Listener = std::function<void(hal::Instant now, std::string_view source, std::string_view text)>;

  // path empty: no file. Errors: not_present, permission, io.
  [[nodiscard]] static hal::Result<std::unique_ptr<RunJournal>> open(const std::string& path,
                                                                     Listener listener);

  // 64-bit digest of all lines so far.
  [[nodiscard]] virtual std::uint64_t hash() const = 0;
  // Writes out what is buffered; false when the file could not be written.
  virtual bool flush() = 0;
};

}  // namespace forager::boards
