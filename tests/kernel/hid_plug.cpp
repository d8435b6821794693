#include "tests/kernel/hid_plug.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

namespace forager::kernel {
namespace {

// The kernel's structures are packed, so their fields cannot be referred to as arrays.
std::span<std::byte> bytes_of(void* field, std::size_t count) {
  return {static_cast<std::byte*>(field), count};
}

template <std::size_t N>
void copy_text(__u8 (&field)[N], const std::string& text) {
  std::copy_n(text.begin(), std::min(text.size(), N - 1), field);
}

// Fails only after the kernel has let the device go.
void send(int uhid, const uhid_event& event) { static_cast<void>(::write(uhid, &event, sizeof event)); }

}  // namespace

HidPlug::HidPlug(mocks::SimHidDevice& device)
    : device_(device), uhid_(::open("/dev/uhid", O_RDWR | O_CLOEXEC)) {
  if (uhid_ < 0) {
    ADD_FAILURE() << "/dev/uhid: " << std::strerror(errno);
    return;
  }
  device_.power(true);
  create();
  thread_ = std::thread([this] { serve(); });
}

HidPlug::~HidPlug() {
  if (uhid_ < 0) return;
  uhid_event event{};
  event.type = UHID_DESTROY;
  send(uhid_, event);
  stop_ = true;
  thread_.join();
  ::close(uhid_);
  device_.power(false);
}

void HidPlug::create() {
  const hal::HidDeviceFacts& facts = device_.facts();
  const auto descriptor = device_.report_descriptor();
  uhid_event event{};
  event.type = UHID_CREATE2;
  uhid_create2_req& create = event.u.create2;
  copy_text(create.name, facts.manufacturer + " " + facts.product_name);
  copy_text(create.phys, "usb-emulated-1/input0");
  copy_text(create.uniq, facts.serial);
  std::copy(descriptor.begin(), descriptor.end(), create.rd_data);
  create.rd_size = static_cast<__u16>(descriptor.size());
  create.bus = BUS_USB;
  create.vendor = facts.vendor;
  create.product = facts.product;
  send(uhid_, event);
}

// A device may have something to say without being asked, so it is looked at every now and then.
void HidPlug::serve() {
  pollfd kernel{uhid_, POLLIN, 0};
  while (!stop_) {
    const int waiting = ::poll(&kernel, 1, 5);
    const auto held = lock();
    if (waiting > 0) take_event();
    send_inputs();
  }
}

void HidPlug::take_event() {
  uhid_event event{};
  if (::read(uhid_, &event, sizeof event) <= 0) return;
  uhid_event reply{};
  if (event.type == UHID_START) {
    numbered_ = (event.u.start.dev_flags & UHID_DEV_NUMBERED_OUTPUT_REPORTS) != 0;
  } else if (event.type == UHID_OUTPUT) {
    take_output(bytes_of(event.u.output.data, event.u.output.size));
  } else if (event.type == UHID_SET_REPORT) {
    const auto bytes = bytes_of(event.u.set_report.data, event.u.set_report.size);
    const bool taken =
        event.u.set_report.rtype == UHID_FEATURE_REPORT ? device_.set_feature(bytes) : device_.output(bytes);
    reply.type = UHID_SET_REPORT_REPLY;
    reply.u.set_report_reply.id = event.u.set_report.id;
    reply.u.set_report_reply.err = taken ? 0 : EIO;
    send(uhid_, reply);
  } else if (event.type == UHID_GET_REPORT) {
    reply.type = UHID_GET_REPORT_REPLY;
    uhid_get_report_reply_req& answer = reply.u.get_report_reply;
    answer.id = event.u.get_report.id;
    answer.data[0] = event.u.get_report.rnum;
    const auto count = device_.get_feature(bytes_of(answer.data, UHID_DATA_MAX));
    answer.err = count ? 0 : EIO;
    answer.size = static_cast<__u16>(count.value_or(0));
    send(uhid_, reply);
  }
}

// Programs begin an unnumbered report with a zero, drivers of the kernel do not; the wire has none (usbhid).
void HidPlug::take_output(std::span<const std::byte> report) {
  std::vector<std::byte> whole(report.begin(), report.end());
  if (!numbered_ && !whole.empty() && whole[0] != std::byte{0}) whole.insert(whole.begin(), std::byte{0});
  static_cast<void>(device_.output(whole));
}

void HidPlug::send_inputs() {
  uhid_event event{};
  event.type = UHID_INPUT2;
  while (const std::size_t count = device_.input(bytes_of(event.u.input2.data, UHID_DATA_MAX))) {
    event.u.input2.size = static_cast<__u16>(count);
    send(uhid_, event);
  }
}

}  // namespace forager::kernel
