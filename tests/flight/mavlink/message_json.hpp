#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/registry.hpp"

// Messages as JSON, by field name: char arrays are strings, NaN is null, 64-bit integers are decimal strings
// when written (JSON readers keep 53 bits) and either when read.
namespace forager::flight::mavlink::test {

template <class T>
void read_json(const nlohmann::json& from, T& to) {
  if constexpr (std::is_floating_point_v<T>)
    to = from.is_null() ? std::numeric_limits<T>::quiet_NaN() : from.get<T>();
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    to = from.is_string() ? std::stoull(from.get<std::string>()) : from.get<T>();
  else if constexpr (std::is_same_v<T, std::int64_t>)
    to = from.is_string() ? std::stoll(from.get<std::string>()) : from.get<T>();
  else
    to = from.get<T>();
}
template <std::size_t kSize>
void read_json(const nlohmann::json& from, std::array<char, kSize>& to) {
  const auto text = from.get<std::string>();
  for (std::size_t i = 0; i < kSize; ++i) to[i] = i < text.size() ? text[i] : '\0';
}
template <class T, std::size_t kSize>
void read_json(const nlohmann::json& from, std::array<T, kSize>& to) {
  for (std::size_t i = 0; i < kSize; ++i) read_json(from.at(i), to[i]);
}

template <class T>
nlohmann::json write_json(const T& value) {
  if constexpr (std::is_floating_point_v<T>)
    return std::isnan(value) ? nlohmann::json(nullptr) : nlohmann::json(static_cast<double>(value));
  else if constexpr (sizeof(T) == 8)
    return std::to_string(value);
  else
    return value;
}
template <std::size_t kSize>
nlohmann::json write_json(const std::array<char, kSize>& value) {
  std::size_t length = 0;
  while (length < kSize && value[length] != '\0') ++length;
  return std::string(value.data(), length);
}
template <class T, std::size_t kSize>
nlohmann::json write_json(const std::array<T, kSize>& value) {
  auto list = nlohmann::json::array();
  for (const T& element : value) list.push_back(write_json(element));
  return list;
}

template <Message M>
M message_from_json(const nlohmann::json& values) {
  M message;
  for_each_field(message, [&](const FieldLayout& layout, auto& value) {
    read_json(values.at(std::string(layout.name)), value);
  });
  return message;
}

template <Message M>
nlohmann::json message_to_json(const M& message) {
  nlohmann::json values;
  for_each_field(message, [&](const FieldLayout& layout, const auto& value) {
    values[std::string(layout.name)] = write_json(value);
  });
  return values;
}

inline std::string to_hex(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::byte b : bytes) {
    text += kDigits[std::to_integer<unsigned>(b) >> 4U];
    text += kDigits[std::to_integer<unsigned>(b) & 0xFU];
  }
  return text;
}

inline std::vector<std::byte> from_hex(std::string_view text) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes.push_back(std::byte(std::stoul(std::string(text.substr(i, 2)), nullptr, 16)));
  return bytes;
}

template <Message M>
std::string payload_hex(const M& message) {
  std::array<std::byte, kLayout<M>.full_length> payload{};
  pack(message, payload.data());
  return to_hex(payload);
}

}  // namespace forager::flight::mavlink::test
