#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "hal/byte_stream.hpp"

// Small helpers for tests that talk through byte streams.
namespace forager::hal::contract {

// Real sockets take their time; a rig in memory answers at the first try.
template <class Condition>
[[nodiscard]] bool eventually(Condition condition) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return true;
}

inline std::vector<std::byte> bytes_of(std::string_view text) {
  std::vector<std::byte> out(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) out[i] = static_cast<std::byte>(text[i]);
  return out;
}

inline std::string text_of(std::span<const std::byte> bytes) {
  std::string out;
  for (const std::byte byte : bytes) out += static_cast<char>(byte);
  return out;
}

// Everything that arrives until `size` bytes are there, or 5 s pass, or the stream fails.
inline std::string read_text(ByteStream& stream, std::size_t size) {
  std::string got;
  std::vector<std::byte> room(2048);
  (void)eventually([&] {
    const auto count = stream.read(room);
    if (!count) {
      got.append("<").append(describe(count.error())).append(">");
      return true;
    }
    got += text_of(std::span(room).first(*count));
    return got.size() >= size;
  });
  return got;
}

}  // namespace forager::hal::contract
