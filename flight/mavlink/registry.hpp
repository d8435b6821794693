#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "flight/mavlink/frame.hpp"
#include "flight/mavlink/messages.hpp"

namespace forager::flight::mavlink {

// What framing needs to know of a message.
struct MessageInfo {
  std::uint32_t id = 0;
  std::string_view name;
  std::uint8_t crc_extra = 0;
  std::uint8_t base_length = 0;
  std::uint8_t full_length = 0;
};

// Every known message, by ascending id.
[[nodiscard]] std::span<const MessageInfo> known_messages();

// nullptr for an id this codec does not know.
[[nodiscard]] const MessageInfo* find_message(std::uint32_t id);

// Calls visit(M{}) with a default message of each known type.
template <class Visitor, Message... Ms>
void for_each_message(Visitor&& visit, MessageList<Ms...> /*types*/) {
  (visit(Ms{}), ...);
}
template <class Visitor>
void for_each_message(Visitor&& visit) {
  for_each_message(visit, AllMessages{});
}

}  // namespace forager::flight::mavlink
