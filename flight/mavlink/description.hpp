#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "flight/mavlink/crc.hpp"

// How a message describes itself: a plain struct with kId, kName and fields(), the list of its members in the
// order of the XML definition. Everything about the wire - order, offsets, lengths, CRC_EXTRA - is computed
// from that list at compile time by the rules of MAVLink serialization; nothing is written down twice.
namespace forager::flight::mavlink {

template <class Struct, class Value, bool kExtension>
struct Field {
  std::string_view name;
  Value Struct::*member;
};

template <class Struct, class Value>
constexpr Field<Struct, Value, false> field(std::string_view name, Value Struct::*member) {
  return {name, member};
}

// A field added after the message was first published: sent by MAVLink 2 only, in no CRC_EXTRA.
template <class Struct, class Value>
constexpr Field<Struct, Value, true> extension(std::string_view name, Value Struct::*member) {
  return {name, member};
}

template <class M>
concept Message = requires {
  { M::kId } -> std::convertible_to<std::uint32_t>;
  { M::kName } -> std::convertible_to<std::string_view>;
  M::fields();
};

namespace detail {

template <class T>
struct Element {
  using type = T;
  static constexpr std::size_t kCount = 0;
};
template <class T, std::size_t kSize>
struct Element<std::array<T, kSize>> {
  using type = T;
  static constexpr std::size_t kCount = kSize;
};

template <class T>
consteval std::string_view wire_type() {
  if constexpr (std::same_as<T, char>) return "char";
  if constexpr (std::same_as<T, std::uint8_t>) return "uint8_t";
  if constexpr (std::same_as<T, std::int8_t>) return "int8_t";
  if constexpr (std::same_as<T, std::uint16_t>) return "uint16_t";
  if constexpr (std::same_as<T, std::int16_t>) return "int16_t";
  if constexpr (std::same_as<T, std::uint32_t>) return "uint32_t";
  if constexpr (std::same_as<T, std::int32_t>) return "int32_t";
  if constexpr (std::same_as<T, std::uint64_t>) return "uint64_t";
  if constexpr (std::same_as<T, std::int64_t>) return "int64_t";
  if constexpr (std::same_as<T, float>) return "float";
  if constexpr (std::same_as<T, double>) return "double";
}

}  // namespace detail

// One field as it lies in the untrimmed payload.
struct FieldLayout {
  std::string_view name;
  std::string_view type;  // wire type of one element: "uint16_t"
  std::size_t element_size = 0;
  std::size_t count = 0;  // elements of an array, 0 for a scalar
  bool is_extension = false;
  std::size_t offset = 0;

  [[nodiscard]] constexpr std::size_t size() const { return element_size * (count == 0 ? 1 : count); }
};

template <Message M>
inline constexpr std::size_t kFieldCount = std::tuple_size_v<decltype(M::fields())>;

template <Message M>
struct Layout {
  std::array<FieldLayout, kFieldCount<M>> fields{};      // in XML order
  std::array<std::size_t, kFieldCount<M>> wire_order{};  // indices into fields
  std::size_t base_length = 0;                           // MAVLink 1 payload
  std::size_t full_length = 0;                           // untrimmed MAVLink 2 payload, all known extensions
  std::uint8_t crc_extra = 0;
};

namespace detail {

template <class Struct, class Value, bool kExtension>
consteval FieldLayout describe(const Field<Struct, Value, kExtension>& field) {
  using T = typename Element<Value>::type;
  return {field.name, wire_type<T>(), sizeof(T), Element<Value>::kCount, kExtension, 0};
}

// Base fields by element size, large to small, equal sizes as in the XML; extensions after them as they come.
template <Message M>
consteval void lay_out(Layout<M>& layout) {
  std::size_t placed = 0;
  const auto place = [&](std::size_t index) {
    layout.fields[index].offset = layout.full_length;
    layout.full_length += layout.fields[index].size();
    layout.wire_order[placed++] = index;
  };
  for (const std::size_t size : {8U, 4U, 2U, 1U})
    for (std::size_t i = 0; i < layout.fields.size(); ++i)
      if (!layout.fields[i].is_extension && layout.fields[i].element_size == size) place(i);
  layout.base_length = layout.full_length;
  for (std::size_t i = 0; i < layout.fields.size(); ++i)
    if (layout.fields[i].is_extension) place(i);
}

template <Message M>
consteval std::uint8_t crc_extra(const Layout<M>& layout) {
  std::uint16_t crc = crc_add(crc_add(kCrcStart, M::kName), " ");
  for (const std::size_t index : layout.wire_order) {
    const FieldLayout& field = layout.fields[index];
    if (field.is_extension) continue;
    crc = crc_add(crc_add(crc, field.type), " ");
    crc = crc_add(crc_add(crc, field.name), " ");
    if (field.count != 0) crc = crc_add(crc, static_cast<std::uint8_t>(field.count));
  }
  return static_cast<std::uint8_t>((crc & 0xFFU) ^ (crc >> 8U));
}

template <Message M>
consteval Layout<M> make_layout() {
  Layout<M> layout;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    constexpr auto kFields = M::fields();
    ((layout.fields[I] = describe(std::get<I>(kFields))), ...);
  }
  (std::make_index_sequence<kFieldCount<M>>{});
  lay_out(layout);
  layout.crc_extra = crc_extra(layout);
  return layout;
}

}  // namespace detail

template <Message M>
inline constexpr Layout<M> kLayout = detail::make_layout<M>();

// Calls visit(const FieldLayout&, value) for each field in XML order.
template <Message M, class Visitor>
constexpr void for_each_field(M& message, Visitor&& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    constexpr auto kFields = std::remove_const_t<M>::fields();
    (visit(kLayout<std::remove_const_t<M>>.fields[I], message.*(std::get<I>(kFields).member)), ...);
  }
  (std::make_index_sequence<kFieldCount<std::remove_const_t<M>>>{});
}

}  // namespace forager::flight::mavlink
