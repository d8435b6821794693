#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "hal/linux/pseudo_terminal.hpp"

namespace forager::hal::contract {

// What a line does to the next answer.
enum class LineFault : std::uint8_t { none, drop, drop_a_byte, flip_a_bit, delay };

// A cable between two serial ports, with somebody's fingers in it: a master opens near(), a slave far().
class LinePump {
 public:
  LinePump() {
    static_cast<void>(near_->open());
    static_cast<void>(far_->open());
    pump_ = std::thread([this] {
      while (!stop_) pump();
    });
  }
  ~LinePump() {
    stop_ = true;
    pump_.join();
  }
  LinePump(const LinePump&) = delete;
  LinePump& operator=(const LinePump&) = delete;

  [[nodiscard]] const std::string& near() const { return near_->port(); }
  [[nodiscard]] const std::string& far() const { return far_->port(); }
  // Of the next answer only, or of every one until told otherwise.
  void spoil(LineFault fault, bool every = false) {
    const std::scoped_lock lock(mutex_);
    fault_ = fault;
    every_ = every;
  }
  std::chrono::milliseconds delay{60};

 private:
  using Bytes = std::vector<std::byte>;

  static std::optional<Bytes> read(PseudoTerminal& from) {
    if (from.poll().value() == StreamState::closed) static_cast<void>(from.open());
    if (from.poll().value() != StreamState::open) return std::nullopt;
    Bytes bytes(512);
    const auto got = from.read(bytes);
    if (!got || *got == 0) return std::nullopt;
    bytes.resize(*got);
    return bytes;
  }
  static void write(PseudoTerminal& to, const Bytes& bytes) {
    if (to.poll().value() == StreamState::open) static_cast<void>(to.write(bytes));
  }

  // An answer comes in one piece or in several: it is over when nothing more came for a moment.
  void pump() {
    if (const auto question = read(*near_)) write(*far_, *question);
    if (auto answer = read(*far_)) {
      for (int quiet = 0; quiet < 3; ++quiet) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (const auto more = read(*far_)) {
          answer->insert(answer->end(), more->begin(), more->end());
          quiet = -1;
        }
      }
      write(*near_, spoilt(*std::move(answer)));
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  Bytes spoilt(Bytes bytes) {
    LineFault fault = LineFault::none;
    {
      const std::scoped_lock lock(mutex_);
      fault = every_ ? fault_ : std::exchange(fault_, LineFault::none);
    }
    if (fault == LineFault::drop) bytes.clear();
    if (fault == LineFault::drop_a_byte) bytes.erase(bytes.begin() + 1);
    if (fault == LineFault::flip_a_bit) bytes[bytes.size() / 2] ^= std::byte{0x10};
    if (fault == LineFault::delay) std::this_thread::sleep_for(delay);
    return bytes;
  }

  std::unique_ptr<PseudoTerminal> near_ = open_pseudo_terminal().value();
  std::unique_ptr<PseudoTerminal> far_ = open_pseudo_terminal().value();
  std::mutex mutex_;
  LineFault fault_ = LineFault::none;
  bool every_ = false;
  std::atomic<bool> stop_ = false;
  std::thread pump_;
};

}  // namespace forager::hal::contract
