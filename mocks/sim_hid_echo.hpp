#pragma once

#include <string>
#include <vector>

#include "mocks/report_queue.hpp"
#include "mocks/sim_hid_device.hpp"

namespace forager::mocks {

// A device to try a HID host with (1209:0002 of pid.codes, for tests), serial number SN7: vendor page, input
// and output reports of 64 bytes without a number, one feature report of 8. An output report comes back as
// an input report; the feature report is kept.
class SimHidEcho final : public SimHidDevice {
 public:
  explicit SimHidEcho(std::string path = "/dev/hidraw0", std::string serial = "SN7");

  [[nodiscard]] const hal::HidDeviceFacts& facts() const override { return facts_; }
  [[nodiscard]] std::span<const std::uint8_t> report_descriptor() const override;
  bool output(std::span<const std::byte> report) override;
  std::size_t input(std::span<std::byte> into) override { return reports_.take(into); }
  std::optional<std::size_t> get_feature(std::span<std::byte> into) override;
  bool set_feature(std::span<const std::byte> report) override;
  void power(bool on) override;

 private:
  hal::HidDeviceFacts facts_;
  ReportQueue reports_;
  std::vector<std::byte> feature_;
};

}  // namespace forager::mocks
