#include "flight/mavlink/registry.hpp"

#include <algorithm>
#include <array>

namespace forager::flight::mavlink {
namespace {

template <Message... Ms>
consteval auto make_infos(MessageList<Ms...> /*types*/) {
  std::array<MessageInfo, sizeof...(Ms)> infos{MessageInfo{
      Ms::kId, Ms::kName, kLayout<Ms>.crc_extra, static_cast<std::uint8_t>(kLayout<Ms>.base_length),
      static_cast<std::uint8_t>(kLayout<Ms>.full_length)}...};
  std::ranges::sort(infos, {}, &MessageInfo::id);
  return infos;
}
constexpr auto kInfos = make_infos(AllMessages{});
static_assert(kInfos.size() < 255);
static_assert(std::ranges::adjacent_find(kInfos, {}, &MessageInfo::id) == kInfos.end(), "ids are unique");

// Nearly every id on a real link is small; those are found with one load.
constexpr std::size_t kDirect = 512;
consteval auto make_direct() {
  std::array<std::uint8_t, kDirect> direct{};
  for (std::size_t i = 0; i < kInfos.size(); ++i)
    if (kInfos[i].id < kDirect) direct[kInfos[i].id] = static_cast<std::uint8_t>(i + 1);
  return direct;
}
constexpr auto kDirectIndex = make_direct();

}  // namespace

std::span<const MessageInfo> known_messages() { return kInfos; }

const MessageInfo* find_message(std::uint32_t id) {
  if (id < kDirect) {
    const std::uint8_t index = kDirectIndex[id];
    return index == 0 ? nullptr : &kInfos[index - 1U];
  }
  const auto found = std::ranges::lower_bound(kInfos, id, {}, &MessageInfo::id);
  return found != kInfos.end() && found->id == id ? &*found : nullptr;
}

}  // namespace forager::flight::mavlink
