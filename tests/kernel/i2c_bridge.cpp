#include "tests/kernel/i2c_bridge.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace forager::kernel {
namespace {

// As modules/i2c_sim.c has them.
constexpr std::size_t kLongest = 1024;
struct Message {
  std::uint16_t is_read;
  std::uint16_t length;
};
struct Request {
  std::uint16_t address;
  std::uint16_t count;
  std::array<Message, 2> message;
};

int errno_of(hal::ErrorCode code) {
  switch (code) {
    case hal::ErrorCode::no_ack:
      return ENXIO;
    case hal::ErrorCode::disconnected:
      return ENODEV;
    case hal::ErrorCode::timeout:
      return ETIMEDOUT;
    case hal::ErrorCode::busy:
      return EAGAIN;
    case hal::ErrorCode::invalid_argument:
      return EINVAL;
    default:
      return EIO;
  }
}

hal::Result<> carry_out(hal::I2c& wires, const Request& request, std::span<const std::byte> sent,
                        std::span<std::byte> into) {
  const auto address = static_cast<std::uint8_t>(request.address);
  if (into.empty()) return wires.write(address, sent);
  if (sent.empty()) return wires.read(address, into);
  return wires.write_read(address, sent, into);
}

}  // namespace

I2cBridge::I2cBridge(hal::I2c& wires, std::function<void()> before)
    : wires_(wires),
      before_(std::move(before)),
      device_(::open("/dev/i2c-sim", O_RDWR | O_CLOEXEC)),
      stop_(::eventfd(0, EFD_CLOEXEC)) {
  if (device_ < 0 || stop_ < 0) {
    ADD_FAILURE() << "/dev/i2c-sim: " << std::strerror(errno);
    return;
  }
  thread_ = std::thread([this] { serve(); });
}

I2cBridge::~I2cBridge() {
  const std::uint64_t one = 1;
  if (thread_.joinable()) {
    EXPECT_EQ(static_cast<ssize_t>(sizeof one), ::write(stop_, &one, sizeof one));
    thread_.join();
  }
  ::close(device_);
  ::close(stop_);
}

void I2cBridge::serve() {
  std::array<pollfd, 2> both{pollfd{device_, POLLIN, 0}, pollfd{stop_, POLLIN, 0}};
  while (::poll(both.data(), both.size(), -1) > 0 && both[1].revents == 0)
    if (both[0].revents != 0) serve_one();
}

void I2cBridge::serve_one() {
  std::array<std::byte, sizeof(Request) + 2 * kLongest> room{};
  if (::read(device_, room.data(), room.size()) < static_cast<ssize_t>(sizeof(Request)) || hangs_) return;
  if (before_) before_();
  Request request{};
  std::memcpy(&request, room.data(), sizeof request);
  std::size_t to_send = 0;
  std::size_t to_read = 0;
  for (std::size_t i = 0; i < request.count; ++i)
    (request.message.at(i).is_read != 0 ? to_read : to_send) += request.message.at(i).length;
  std::vector<std::byte> answer(sizeof(std::int32_t) + to_read);
  const auto done = carry_out(wires_, request, std::span(room).subspan(sizeof request, to_send),
                              std::span(answer).subspan(sizeof(std::int32_t)));
  const std::int32_t code = done ? 0 : -errno_of(done.error().code);
  std::memcpy(answer.data(), &code, sizeof code);
  static_cast<void>(::write(device_, answer.data(), answer.size()));  // too late is nobody's concern
}

}  // namespace forager::kernel
