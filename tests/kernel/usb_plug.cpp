#include "tests/kernel/usb_plug.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bitset>
#include <cerrno>
#include <span>
#include <string>

#include "tests/kernel/sysfs.hpp"
#include "tests/kernel/usb_descriptors.hpp"

namespace forager::kernel {
namespace {

constexpr const char* kController = "/sys/devices/platform/vhci_hcd.0/";
constexpr int kFullSpeed = 2;  // enum usb_device_speed of the kernel

// USB/IP protocol, "message formats": every header has 48 bytes, numbers big-endian.
constexpr std::size_t kHeader = 48;
constexpr std::uint32_t kSubmit = 1;
constexpr std::uint32_t kUnlink = 2;
constexpr std::uint32_t kSubmitted = 3;
constexpr std::uint32_t kUnlinked = 4;
using Header = std::array<std::byte, kHeader>;

std::uint32_t word(const Header& header, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | std::to_integer<std::uint32_t>(header[at + i]);
  return value;
}
void put_word(Header& header, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) header[at + i] = static_cast<std::byte>(value >> (24 - 8 * i));
}

bool receive(int socket, std::span<std::byte> into) {
  return into.empty() ||
         ::recv(socket, into.data(), into.size(), MSG_WAITALL) == static_cast<ssize_t>(into.size());
}

// Standard requests (USB 2.0, table 9-4) that a device answers from its descriptors, or by being there.
constexpr std::uint8_t kGetStatus = 0;
constexpr std::uint8_t kClearFeature = 1;
constexpr std::uint8_t kGetDescriptor = 6;
constexpr std::uint8_t kSetConfiguration = 9;
constexpr std::uint8_t kSetInterface = 11;

std::optional<std::vector<std::uint8_t>> standard(mocks::SimUsbDevice& device, std::uint8_t recipient,
                                                  std::uint8_t request, std::uint16_t value,
                                                  std::uint16_t index) {
  if (request == kGetDescriptor)
    return usb_descriptor(device.facts(), static_cast<std::uint8_t>(value >> 8U),
                          static_cast<std::uint8_t>(value));
  if (request == kGetStatus) return std::vector<std::uint8_t>{0, 0};
  if (request == kClearFeature && recipient == 2) device.clear_halt(static_cast<std::uint8_t>(index));
  if (request == kClearFeature || request == kSetConfiguration || request == kSetInterface)
    return std::vector<std::uint8_t>{};
  return std::nullopt;
}

std::uint16_t packet_of(const hal::UsbDeviceFacts& facts, std::uint8_t address) {
  for (const auto& interface : facts.interfaces)
    for (const auto& endpoint : interface.endpoints)
      if (endpoint.address == address) return endpoint.max_packet_bytes;
  return 64;
}

}  // namespace

UsbPlug::UsbPlug(mocks::SimUsbDevice& device, unsigned port) : device_(device), port_(port) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    ADD_FAILURE() << "no sockets";
    return;
  }
  socket_ = ends[1];
  device_.power(true);
  // The port, the socket, the device's number at the other end (any), the speed.
  put(std::string(kController) + "attach", std::to_string(port) + " " + std::to_string(ends[0]) + " " +
                                               std::to_string(0x10002 + port) + " " +
                                               std::to_string(kFullSpeed));
  ::close(ends[0]);
  thread_ = std::thread([this] { serve(); });
}

UsbPlug::~UsbPlug() {
  if (socket_ < 0) return;
  static_cast<void>(put_error(std::string(kController) + "detach", std::to_string(port_)));
  ::shutdown(socket_, SHUT_RDWR);
  thread_.join();
  ::close(socket_);
  device_.power(false);
}

void UsbPlug::serve() {
  pollfd kernel{socket_, POLLIN, 0};
  while (true) {
    const int waiting = ::poll(&kernel, 1, 1);  // a frame of the bus, about
    const auto held = lock();
    if (waiting == 0) device_.start_of_frame();
    if (waiting > 0 && !take_request()) return;
    move_packets();
  }
}

bool UsbPlug::take_request() {
  Header header{};
  if (!receive(socket_, header)) return false;
  const std::uint32_t sequence = word(header, 4);
  if (word(header, 0) == kUnlink) {
    unlink(sequence, word(header, 20));
    return true;
  }
  if (word(header, 0) != kSubmit) return false;
  const bool in = word(header, 12) == 1;
  const std::uint32_t endpoint = word(header, 16);
  std::vector<std::byte> bytes(word(header, 24));
  if (!in && !receive(socket_, bytes)) return false;
  if (endpoint == 0)
    control(sequence, std::span(header).subspan(40, 8), std::move(bytes));
  else
    waiting_.push_back({sequence, static_cast<std::uint8_t>(endpoint | (in ? 0x80U : 0U)), std::move(bytes)});
  return true;
}

void UsbPlug::unlink(std::uint32_t sequence, std::uint32_t victim) {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const Transfer& transfer) { return transfer.sequence == victim; });
  Header header{};
  put_word(header, 0, kUnlinked);
  put_word(header, 4, sequence);
  if (found != waiting_.end()) {
    put_word(header, 20, static_cast<std::uint32_t>(-ECONNRESET));
    waiting_.erase(found);
  }
  static_cast<void>(::send(socket_, header.data(), header.size(), MSG_NOSIGNAL));
}

void UsbPlug::control(std::uint32_t sequence, std::span<const std::byte> setup,
                      std::vector<std::byte> bytes) {
  const auto at = [&](std::size_t i) { return std::to_integer<std::uint8_t>(setup[i]); };
  const auto pair = [&](std::size_t i) { return static_cast<std::uint16_t>(at(i) | at(i + 1) << 8U); };
  const bool in = (at(0) & 0x80U) != 0;
  const auto kind = static_cast<hal::UsbRequestKind>(at(0) >> 5U & 3U);
  const std::uint8_t recipient = at(0) & 0x1FU;
  if (kind == hal::UsbRequestKind::standard) {
    const auto reply = standard(device_, recipient, at(1), pair(2), pair(4));
    if (!reply) return answer(sequence, -EPIPE, 0, {});
    const std::size_t count = std::min(reply->size(), bytes.size());
    std::transform(reply->begin(), reply->begin() + static_cast<std::ptrdiff_t>(count), bytes.begin(),
                   [](std::uint8_t byte) { return std::byte{byte}; });
    return answer(sequence, 0, count, std::span(bytes).first(count));
  }
  const hal::UsbRequest request{kind, static_cast<hal::UsbRecipient>(recipient), at(1), pair(2), pair(4)};
  if (in) {
    const auto count = device_.control_in(request, bytes);
    return answer(sequence, count ? 0 : -EPIPE, count.value_or(0), std::span(bytes).first(count.value_or(0)));
  }
  const bool taken = device_.control_out(request, bytes);
  answer(sequence, taken ? 0 : -EPIPE, taken ? bytes.size() : 0, {});
}

void UsbPlug::move_packets() {
  for (bool moved = true; moved;) {
    moved = false;
    std::bitset<256> waits;  // transfers of one endpoint keep their order
    for (auto transfer = waiting_.begin(); transfer != waiting_.end();) {
      if (waits.test(transfer->endpoint) || !move(*transfer)) {
        waits.set(transfer->endpoint);
        ++transfer;
        continue;
      }
      moved = true;
      transfer = waiting_.erase(transfer);
    }
  }
}

// Whether it ended, and was answered.
bool UsbPlug::move(Transfer& transfer) {
  const std::size_t most = packet_of(device_.facts(), transfer.endpoint);
  const bool in = (transfer.endpoint & 0x80U) != 0;
  while (true) {
    const auto room = std::span(transfer.bytes).subspan(transfer.done);
    const auto packet = room.first(std::min(room.size(), most));
    const mocks::SimUsbPacket got =
        in ? device_.packet_in(transfer.endpoint, packet)
           : mocks::SimUsbPacket{device_.packet_out(transfer.endpoint, packet), packet.size()};
    if (got.answer == mocks::SimUsbAnswer::nak) return false;
    if (got.answer == mocks::SimUsbAnswer::stall) {
      answer(transfer.sequence, -EPIPE, transfer.done, {});
      return true;
    }
    transfer.done += got.bytes;
    if (transfer.done < transfer.bytes.size() && (got.bytes == most || !in)) continue;
    answer(
        transfer.sequence, 0, transfer.done,
        in ? std::span<const std::byte>(transfer.bytes).first(transfer.done) : std::span<const std::byte>{});
    return true;
  }
}

void UsbPlug::answer(std::uint32_t sequence, std::int32_t status, std::size_t count,
                     std::span<const std::byte> received) {
  Header header{};
  put_word(header, 0, kSubmitted);
  put_word(header, 4, sequence);
  put_word(header, 20, static_cast<std::uint32_t>(status));
  put_word(header, 24, static_cast<std::uint32_t>(count));
  std::vector<std::byte> message(header.begin(), header.end());
  message.insert(message.end(), received.begin(), received.end());
  static_cast<void>(::send(socket_, message.data(), message.size(), MSG_NOSIGNAL));
}

}  // namespace forager::kernel
