#include "mocks/sim_hid_echo.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace forager::mocks {
namespace {

constexpr std::size_t kReport = 64;
constexpr std::size_t kFeature = 8;
constexpr std::array<std::uint8_t, 33> kDescriptor{
    0x06, 0x00, 0xFF,                              // usage page: vendor 0xFF00
    0x09, 0x01, 0xA1, 0x01,                        // usage 1, collection: application
    0x15, 0x00, 0x26, 0xFF,     0x00, 0x75, 0x08,  // logical 0 to 255, 8 bits
    0x09, 0x01, 0x95, kReport,  0x81, 0x02,        // 64 of them: input
    0x09, 0x02, 0x95, kReport,  0x91, 0x02,        // 64 of them: output
    0x09, 0x03, 0x95, kFeature, 0xB1, 0x02,        // 8 of them: feature
    0xC0};

}  // namespace

SimHidEcho::SimHidEcho(std::string path, std::string serial)
    : facts_{.vendor = 0x1209,
             .product = 0x0002,
             .serial = std::move(serial),
             .manufacturer = "forager",
             .product_name = "Report echo",
             .path = std::move(path),
             .usage_page = 0xFF00,
             .usage = 1,
             .interface_number = 0,
             .driver = "hid-generic"} {
  power(true);
}

std::span<const std::uint8_t> SimHidEcho::report_descriptor() const { return kDescriptor; }

void SimHidEcho::power(bool) {
  reports_.clear();
  feature_.assign(kFeature, std::byte{0});
}

bool SimHidEcho::output(std::span<const std::byte> report) {
  if (report.size() != kReport + 1 || report[0] != std::byte{0}) return false;
  reports_.push(report.subspan(1));
  return true;
}

std::optional<std::size_t> SimHidEcho::get_feature(std::span<std::byte> into) {
  if (into.size() < kFeature + 1 || into[0] != std::byte{0}) return std::nullopt;
  std::copy(feature_.begin(), feature_.end(), into.begin() + 1);
  return kFeature + 1;
}

bool SimHidEcho::set_feature(std::span<const std::byte> report) {
  if (report.size() != kFeature + 1 || report[0] != std::byte{0}) return false;
  feature_.assign(report.begin() + 1, report.end());
  return true;
}

}  // namespace forager::mocks
