#include "tests/kernel/usb_descriptors.hpp"

#include <string>

namespace forager::kernel {
namespace {

// USB 2.0, table 9-5.
constexpr std::uint8_t kDevice = 1;
constexpr std::uint8_t kConfiguration = 2;
constexpr std::uint8_t kString = 3;

constexpr std::uint8_t low(std::size_t value) { return static_cast<std::uint8_t>(value); }
constexpr std::uint8_t high(std::size_t value) { return static_cast<std::uint8_t>(value >> 8U); }

// Strings 1, 2 and 3; 0: none.
std::uint8_t number_of(const std::string& text, std::uint8_t number) { return text.empty() ? 0 : number; }

std::vector<std::uint8_t> device(const hal::UsbDeviceFacts& facts) {
  return {18,
          kDevice,
          0x00,
          0x02,
          0,
          0,
          0,
          64,
          low(facts.vendor),
          high(facts.vendor),
          low(facts.product),
          high(facts.product),
          low(facts.release),
          high(facts.release),
          number_of(facts.manufacturer, 1),
          number_of(facts.product_name, 2),
          number_of(facts.serial, 3),
          1};
}

std::vector<std::uint8_t> configuration(const hal::UsbDeviceFacts& facts) {
  std::vector<std::uint8_t> bytes{9, kConfiguration, 0, 0, low(facts.interfaces.size()), 1, 0, 0x80, 50};
  for (const hal::UsbInterfaceFacts& interface : facts.interfaces) {
    const std::uint8_t count = low(interface.endpoints.size());
    bytes.insert(bytes.end(), {9, 4, interface.number, 0, count, interface.class_code, interface.subclass,
                               interface.protocol, 0});
    for (const hal::UsbEndpointFacts& endpoint : interface.endpoints) {
      const bool polled = endpoint.type == hal::UsbTransferType::interrupt;
      bytes.insert(bytes.end(), {7, 5, endpoint.address, static_cast<std::uint8_t>(endpoint.type),
                                 low(endpoint.max_packet_bytes), high(endpoint.max_packet_bytes),
                                 static_cast<std::uint8_t>(polled ? 10 : 0)});
    }
  }
  bytes[2] = low(bytes.size());
  bytes[3] = high(bytes.size());
  return bytes;
}

std::optional<std::vector<std::uint8_t>> text(const hal::UsbDeviceFacts& facts, std::uint8_t index) {
  if (index == 0) return std::vector<std::uint8_t>{4, kString, 0x09, 0x04};  // English
  const std::string* words = index == 1   ? &facts.manufacturer
                             : index == 2 ? &facts.product_name
                             : index == 3 ? &facts.serial
                                          : nullptr;
  if (words == nullptr || words->empty()) return std::nullopt;
  std::vector<std::uint8_t> bytes{low(2 + 2 * words->size()), kString};
  for (const char letter : *words) bytes.insert(bytes.end(), {static_cast<std::uint8_t>(letter), 0});
  return bytes;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> usb_descriptor(const hal::UsbDeviceFacts& facts, std::uint8_t kind,
                                                        std::uint8_t index) {
  if (kind == kDevice) return device(facts);
  if (kind == kConfiguration && index == 0) return configuration(facts);
  if (kind == kString) return text(facts, index);
  return std::nullopt;
}

}  // namespace forager::kernel
