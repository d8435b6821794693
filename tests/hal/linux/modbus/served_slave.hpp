#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "hal/byte_stream.hpp"
#include "mocks/sim_modbus_slave.hpp"

namespace forager::hal::contract {

// An emulated slave that answers on a stream, in a thread of its own.
class ServedSlave {
 public:
  ServedSlave(std::unique_ptr<ByteStream> line, std::uint8_t unit)
      : slave_(unit, mocks::SimModbusSlave::Framing::rtu), line_(std::move(line)) {
    thread_ = std::thread([this] {
      while (!stop_) serve();
    });
  }
  ~ServedSlave() {
    stop_ = true;
    thread_.join();
  }
  ServedSlave(const ServedSlave&) = delete;
  ServedSlave& operator=(const ServedSlave&) = delete;

  template <class Change>
  auto with_device(Change change) {
    const std::scoped_lock lock(mutex_);
    return change(slave_);
  }

 private:
  void serve() {
    if (line_->poll().value_or(StreamState::closed) == StreamState::closed) static_cast<void>(line_->open());
    std::vector<std::byte> bytes(300);
    const auto got = line_->read(bytes);
    if (!got || *got == 0) {
      if (++quiet_ > 50) with_device([](auto& slave) { slave.silence(); });
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      return;
    }
    quiet_ = 0;
    const std::span question(reinterpret_cast<const std::uint8_t*>(bytes.data()), *got);
    const auto answer = with_device([&](auto& slave) { return slave.feed(question); });
    static_cast<void>(line_->write(std::as_bytes(std::span(answer))));
  }

  mocks::SimModbusSlave slave_;
  std::unique_ptr<ByteStream> line_;
  std::mutex mutex_;
  int quiet_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace forager::hal::contract
