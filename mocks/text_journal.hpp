#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "hal/journal.hpp"

namespace forager::mocks {

struct TextJournalConfig {
  bool keep = true;  // collect the lines in text()
  // Wire bytes longer than this are written as their number and a 64-bit hash instead of hexadecimal digits.
  std::size_t max_hex_bytes = 64;
  std::function<void(std::string_view line)> sink;  // optional: gets every line, its line break included
};

// Journal as deterministic text, one line per entry, time in seconds with nine decimals:
//   12.040000000 mission heading goal 1.571
//   12.040000000 autopilot tx fd1c0000...
// Equal runs give equal bytes and so equal hash(). Each entry allocates only when text() grows.
class TextJournal final : public hal::Journal {
 public:
  explicit TextJournal(TextJournalConfig config = {});

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] std::uint64_t lines() const { return lines_; }
  // 64-bit digest of all lines so far (FNV-1a over their hashes; not cryptographic).
  [[nodiscard]] std::uint64_t hash() const { return hash_; }
  // Lines (without line break) that contain `part`, in order.
  [[nodiscard]] std::size_t count(std::string_view part) const;
  // Offset of the first line containing `part` at or after `from`; npos if none. For "this before that".
  [[nodiscard]] std::size_t find(std::string_view part, std::size_t from = 0) const {
    return text_.find(part, from);
  }
  void clear();

 private:
  void do_note(hal::Instant now, std::string_view source, std::string_view text) override;
  void do_wire(hal::Instant now, std::string_view source, std::string_view direction,
               std::span<const std::byte> bytes) override;
  void begin(hal::Instant now, std::string_view source);
  void finish();

  TextJournalConfig config_;
  std::string line_;
  std::string text_;
  std::uint64_t lines_ = 0;
  std::uint64_t hash_;
};

}  // namespace forager::mocks
