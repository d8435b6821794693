#pragma once

#include "hal/hid_device.hpp"
#include "mocks/recording_fields.hpp"

namespace forager::mocks {

// A HID device; borrows it.
//   <report = ok 0102...             an input report that a look found
//   read 64 100000000 = ok 0102...   room and how long it was waited, nanoseconds; the report
//   write 0001... = ok
//   get_feature 05 64 = ok 05...     the report's number, room; what came
//   send_feature 0501 = ok
class RecordingHidDevice final : public hal::HidDevice {
 public:
  RecordingHidDevice(hal::HidDevice& device, hal::Recorder& recorder)
      : HidDevice(device.facts()), device_(&device), recorder_(&recorder) {}

 private:
  hal::Result<std::size_t> do_read(std::span<std::byte> into, hal::Duration at_most) override {
    const auto report = [&](std::size_t size) {
      return hal::Fields{hal::field(std::span<const std::byte>(into.first(size)))};
    };
    if (at_most > hal::Duration::zero())
      return taken(*recorder_, name(), "read", {hal::field(into.size()), hal::field(at_most)},
                   device_->read(into, at_most), report);
    auto size = device_->poll(into);
    if (size && *size == 0) return size;
    return taken(*recorder_, name(), "<report", {}, std::move(size), report);
  }
  hal::Result<> do_write(std::span<const std::byte> report) override {
    return taken(*recorder_, name(), "write", {hal::field(report)}, device_->write(report));
  }
  hal::Result<std::size_t> do_get_feature(std::span<std::byte> into) override {
    hal::Fields asked{hal::field(std::span<const std::byte>(into.first(1))), hal::field(into.size())};
    return taken(*recorder_, name(), "get_feature", std::move(asked), device_->get_feature(into),
                 [&](std::size_t size) {
                   return hal::Fields{hal::field(std::span<const std::byte>(into.first(size)))};
                 });
  }
  hal::Result<> do_send_feature(std::span<const std::byte> report) override {
    return taken(*recorder_, name(), "send_feature", {hal::field(report)}, device_->send_feature(report));
  }

  hal::HidDevice* device_;
  hal::Recorder* recorder_;
};

}  // namespace forager::mocks
