#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "reader/epc.hpp"

namespace forager::reader {

struct WedgeTextCounters {
  std::uint64_t reports = 0;
  std::uint64_t odd_reports = 0;  // not those of a boot keyboard
  std::uint64_t rollovers = 0;    // the keyboard could not say which keys are down
  std::uint64_t epcs = 0;
  std::uint64_t rejected = 0;  // words that are no EPC
};

// What a reader types that plays a keyboard (the AdvanReader-160's USB HID service), as EPCs. Takes the
// reports of a boot keyboard (HID 1.11, appendix B.1: modifiers, a reserved byte, six keys; usages of page
// 7), with the layout of the United States, which is what the codes mean by themselves.
//
// What stands between two EPCs is not published, so everything a reader can be set to is taken: Enter, Tab,
// space, comma or semicolon ends an EPC; `-`, `:` and `.` within one are left out; letters may be of either
// case; "0x" in front is left out. Where nothing stands between them, `digits` tells how long each is, or a
// pause ends one: the caller says pause(). Words that are no EPC are counted and left out.
class WedgeText {
 public:
  // digits: of every EPC, in hexadecimal; 0: as long as they come.
  explicit WedgeText(std::size_t digits = 0) : digits_(digits) {}

  // The next report; EPCs that it completes are appended.
  void feed(std::span<const std::byte> report, std::vector<Epc>& epcs);
  // Nothing has come for a while: what is there is whole.
  void pause(std::vector<Epc>& epcs) { end_word(epcs); }
  // Forgets keys held down and half a word: the keyboard was plugged in anew.
  void reset();

  [[nodiscard]] bool in_word() const { return size_ > 0 || spoilt_; }
  [[nodiscard]] const WedgeTextCounters& counters() const { return counters_; }
  // The last word that was no EPC, for people.
  [[nodiscard]] const std::string& last_rejected() const { return last_rejected_; }

 private:
  static constexpr std::size_t kKeys = 6;
  static constexpr std::size_t kMostLetters = 2 * Epc::kMaxBytes;

  void key(std::uint8_t usage, std::uint8_t modifiers, std::vector<Epc>& epcs);
  void end_word(std::vector<Epc>& epcs);

  std::size_t digits_;
  std::array<std::uint8_t, kKeys> down_{};
  std::array<char, kMostLetters> word_{};
  std::size_t size_ = 0;
  bool spoilt_ = false;  // the word has what no EPC has
  WedgeTextCounters counters_;
  std::string last_rejected_;
};

}  // namespace forager::reader
