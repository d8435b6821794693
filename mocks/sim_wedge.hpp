#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "mocks/report_queue.hpp"
#include "mocks/sim_hid_device.hpp"

namespace forager::mocks {

struct SimWedgeConfig {
  std::uint16_t vendor = 0x1209;  // the AdvanReader's own are not published
  std::uint16_t product = 0x0004;
  std::string serial = "WEDGE1";
  std::string path = "/dev/hidraw1";
  std::string end = "\n";  // typed after every EPC
  bool capitals = false;   // with Shift held down
};

// A tag reader that plays a boot keyboard (HID 1.11, appendix B): every letter is a report with the key down
// and one with it up. Takes the output report of the lamps; everything else is refused. Letters without a key
// on a keyboard of the United States are not typed and kept in untyped().
class SimWedge final : public SimHidDevice {
 public:
  explicit SimWedge(SimWedgeConfig config = {});

  [[nodiscard]] const hal::HidDeviceFacts& facts() const override { return facts_; }
  [[nodiscard]] std::span<const std::uint8_t> report_descriptor() const override;
  bool output(std::span<const std::byte> report) override;
  std::size_t input(std::span<std::byte> into) override { return reports_.take(into); }
  std::optional<std::size_t> get_feature(std::span<std::byte>) override { return std::nullopt; }
  bool set_feature(std::span<const std::byte>) override { return false; }
  void power(bool on) override;

  // The physical face: a tag was read.
  void read_tag(std::string_view epc_hex) { type(std::string(epc_hex) + config_.end); }
  void type(std::string_view text);
  // A report as it is, for what no keyboard should send.
  void send(std::span<const std::byte> report) { reports_.push(report); }
  [[nodiscard]] const std::string& untyped() const { return untyped_; }
  [[nodiscard]] std::uint8_t lamps() const { return lamps_; }

 private:
  SimWedgeConfig config_;
  hal::HidDeviceFacts facts_;
  ReportQueue reports_;
  std::string untyped_;
  std::uint8_t lamps_ = 0;
};

}  // namespace forager::mocks
