#include "reader/wedge_text.hpp"

#include <algorithm>
#include <string_view>

namespace forager::reader {
namespace {

constexpr std::size_t kReport = 8;
constexpr std::uint8_t kErrorRollOver = 0x01;
// Control, Alt and the system keys, left and right (HID 1.11, section 8.3): what is typed with them is no
// text.
constexpr std::uint8_t kCommands = 0xDD;

// HID Usage Tables, page 7, with the layout of the United States; 0: nothing to be had from it.
char letter_of(std::uint8_t usage) {
  constexpr std::uint8_t kA = 0x04;
  constexpr std::uint8_t k1 = 0x1E;
  constexpr std::uint8_t kEnter = 0x28;
  constexpr std::uint8_t kKeypad1 = 0x59;
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz";
  constexpr std::string_view kDigits = "1234567890";
  if (usage >= kA && usage < kA + kLetters.size()) return kLetters[usage - kA];
  if (usage >= k1 && usage < k1 + kDigits.size()) return kDigits[usage - k1];
  if (usage >= kKeypad1 && usage < kKeypad1 + kDigits.size()) return kDigits[usage - kKeypad1];
  switch (usage) {
    case kEnter:
    case 0x58:  // of the keypad
      return '\n';
    case 0x2B:
      return '\t';
    case 0x2C:
      return ' ';
    case 0x2D:
    case 0x56:
      return '-';
    case 0x33:
      return ';';  // and ':' with Shift
    case 0x36:
      return ',';
    case 0x37:
    case 0x63:
      return '.';
    default:
      return '\0';
  }
}

bool hexadecimal(char letter) { return (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'f'); }

}  // namespace

void WedgeText::reset() {
  down_.fill(0);
  size_ = 0;
  spoilt_ = false;
}

void WedgeText::feed(std::span<const std::byte> report, std::vector<Epc>& epcs) {
  ++counters_.reports;
  if (report.size() == kReport + 1) report = report.subspan(1);  // with a number in front
  if (report.size() != kReport) {
    ++counters_.odd_reports;
    return;
  }
  std::array<std::uint8_t, kKeys> now{};
  std::transform(report.begin() + 2, report.end(), now.begin(),
                 [](std::byte key) { return std::to_integer<std::uint8_t>(key); });
  if (now[0] == kErrorRollOver) {
    ++counters_.rollovers;
    return;
  }
  const auto modifiers = std::to_integer<std::uint8_t>(report[0]);
  for (auto each = now.begin(); each != now.end(); ++each) {
    const bool held = std::find(down_.begin(), down_.end(), *each) != down_.end();
    const bool twice = std::find(now.begin(), each, *each) != each;
    if (*each != 0 && !held && !twice) key(*each, modifiers, epcs);
  }
  down_ = now;
}

void WedgeText::key(std::uint8_t usage, std::uint8_t modifiers, std::vector<Epc>& epcs) {
  constexpr std::uint8_t kShift = 0x22;
  char letter = letter_of(usage);
  if ((modifiers & kCommands) != 0 || letter == '\0') return;
  if (letter == ';' && (modifiers & kShift) != 0) letter = ':';
  if (std::string_view("\n\t ,;").find(letter) != std::string_view::npos) return end_word(epcs);
  if (std::string_view("-:.").find(letter) != std::string_view::npos) return;
  if (letter == 'x' && size_ == 1 && word_[0] == '0') {
    size_ = 0;
    return;
  }
  // Digits are digits without Shift only: with it they are signs.
  const bool sign = (modifiers & kShift) != 0 && letter >= '0' && letter <= '9';
  if (size_ == word_.size() || !hexadecimal(letter) || sign) {
    spoilt_ = true;
    return;
  }
  word_[size_++] = letter;
  if (digits_ != 0 && size_ == digits_) end_word(epcs);
}

void WedgeText::end_word(std::vector<Epc>& epcs) {
  if (!in_word()) return;
  const std::string_view word(word_.data(), size_);
  const auto epc = Epc::from_hex(word);
  const bool whole = !spoilt_ && epc.has_value() && (digits_ == 0 || size_ == digits_);
  if (whole) {
    ++counters_.epcs;
    epcs.push_back(*epc);
  } else {
    ++counters_.rejected;
    last_rejected_.assign(word);
  }
  size_ = 0;
  spoilt_ = false;
}

}  // namespace forager::reader
