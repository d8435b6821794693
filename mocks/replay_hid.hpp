#pragma once

#include <string>

#include "hal/hid_device.hpp"
#include "mocks/recording_fields.hpp"
#include "mocks/replay.hpp"

namespace forager::mocks {

// A HID device as mocks/recording_hid.hpp noted it; the facts are those of the recorded one. A read that
// waited answers at once.
class ReplayHidDevice final : public hal::HidDevice {
 public:
  ReplayHidDevice(hal::HidDeviceFacts facts, Replay& replay)
      : HidDevice(std::move(facts)), replay_(&replay) {}

 private:
  hal::Result<std::size_t> size_of(std::string_view operation, const hal::Result<hal::Fields>& answer,
                                   std::span<std::byte> into) const {
    if (!answer) return hal::fail(answer.error());
    const auto size = answer->size() == 1 ? copied(answer->front(), into) : std::nullopt;
    if (!size) return Replay::broken(name(), operation);
    return *size;
  }
  hal::Result<std::size_t> do_read(std::span<std::byte> into, hal::Duration at_most) override {
    if (at_most > hal::Duration::zero())
      return size_of("read", replay_->call(name(), "read", {hal::field(into.size()), hal::field(at_most)}),
                     into);
    const auto report = replay_->arrived(name(), "<report");
    return report ? size_of("<report", *report, into) : hal::Result<std::size_t>(std::size_t{0});
  }
  hal::Result<> do_write(std::span<const std::byte> report) override {
    return nothing_of(replay_->call(name(), "write", {hal::field(report)}));
  }
  hal::Result<std::size_t> do_get_feature(std::span<std::byte> into) override {
    return size_of(
        "get_feature",
        replay_->call(name(), "get_feature",
                      {hal::field(std::span<const std::byte>(into.first(1))), hal::field(into.size())}),
        into);
  }
  hal::Result<> do_send_feature(std::span<const std::byte> report) override {
    return nothing_of(replay_->call(name(), "send_feature", {hal::field(report)}));
  }

  Replay* replay_;
};

}  // namespace forager::mocks
