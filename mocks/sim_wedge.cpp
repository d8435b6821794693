#include "mocks/sim_wedge.hpp"

#include <algorithm>
#include <array>

namespace forager::mocks {
namespace {

constexpr std::size_t kReport = 8;
constexpr std::byte kLeftShift{0x02};
constexpr std::uint8_t kLamps = 0x1F;
// HID 1.11, appendix B.1 and E.6.
constexpr std::array<std::uint8_t, 63> kDescriptor{
    0x05, 0x01, 0x09, 0x06, 0xA1, 0x01,                                      // desktop, keyboard, collection
    0x05, 0x07, 0x19, 0xE0, 0x29, 0xE7, 0x15, 0x00, 0x25, 0x01,              // modifiers: eight of
    0x75, 0x01, 0x95, 0x08, 0x81, 0x02,                                      // one bit
    0x95, 0x01, 0x75, 0x08, 0x81, 0x01,                                      // a byte that is reserved
    0x95, 0x05, 0x75, 0x01, 0x05, 0x08, 0x19, 0x01, 0x29, 0x05, 0x91, 0x02,  // five lamps
    0x95, 0x01, 0x75, 0x03, 0x91, 0x01,                                      // and three bits
    0x95, 0x06, 0x75, 0x08, 0x15, 0x00, 0x25, 0x65,                          // six keys of
    0x05, 0x07, 0x19, 0x00, 0x29, 0x65, 0x81, 0x00, 0xC0};                   // a hundred and one

struct Key {
  char letter;
  std::uint8_t usage;
  bool shift;
};
constexpr Key kSigns[] = {{'\n', 0x28, false}, {'\t', 0x2B, false}, {' ', 0x2C, false},
                          {'-', 0x2D, false},  {';', 0x33, false},  {':', 0x33, true},
                          {',', 0x36, false},  {'.', 0x37, false},  {'0', 0x27, false}};

Key key_of(char letter) {
  if (letter >= 'a' && letter <= 'z') return {letter, static_cast<std::uint8_t>(0x04 + letter - 'a'), false};
  if (letter >= 'A' && letter <= 'Z') return {letter, static_cast<std::uint8_t>(0x04 + letter - 'A'), true};
  if (letter >= '1' && letter <= '9') return {letter, static_cast<std::uint8_t>(0x1E + letter - '1'), false};
  const auto* const sign = std::find_if(std::begin(kSigns), std::end(kSigns),
                                        [&](const Key& key) { return key.letter == letter; });
  return sign == std::end(kSigns) ? Key{letter, 0, false} : *sign;
}

}  // namespace

SimWedge::SimWedge(SimWedgeConfig config)
    : config_(std::move(config)),
      facts_{.vendor = config_.vendor,
             .product = config_.product,
             .serial = config_.serial,
             .manufacturer = "forager",
             .product_name = "Tag reader as keyboard",
             .path = config_.path,
             .usage_page = 0x01,
             .usage = 0x06,
             .interface_number = 0,
             .driver = "hid-generic"} {}

std::span<const std::uint8_t> SimWedge::report_descriptor() const { return kDescriptor; }

void SimWedge::power(bool) {
  reports_.clear();
  lamps_ = 0;
}

bool SimWedge::output(std::span<const std::byte> report) {
  if (report.size() != 2 || report[0] != std::byte{0}) return false;
  if ((std::to_integer<std::uint8_t>(report[1]) & ~kLamps) != 0) return false;
  lamps_ = std::to_integer<std::uint8_t>(report[1]);
  return true;
}

void SimWedge::type(std::string_view text) {
  for (char letter : text) {
    if (config_.capitals && letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
    const Key key = key_of(letter);
    if (key.usage == 0) {
      untyped_ += letter;
      continue;
    }
    std::array<std::byte, kReport> keys{};
    keys[0] = key.shift ? kLeftShift : std::byte{0};
    keys[2] = std::byte{key.usage};
    reports_.push(keys);
    reports_.push(std::array<std::byte, kReport>{});
  }
}

}  // namespace forager::mocks
