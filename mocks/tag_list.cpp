#include "mocks/tag_list.hpp"

#include <cstring>
#include <optional>

namespace forager::mocks {
namespace {

// Only what append_hex() writes again letter by letter.
std::optional<Epc96> epc96_from(std::string_view hex) {
  Epc96 epc{};
  if (hex.size() != 2 * epc.size()) return std::nullopt;
  for (std::size_t i = 0; i < hex.size(); ++i) {
    const char c = hex[i];
    unsigned digit = 0;
    if (c >= '0' && c <= '9')
      digit = static_cast<unsigned>(c - '0');
    else if (c >= 'a' && c <= 'f')
      digit = static_cast<unsigned>(c - 'a') + 10U;
    else
      return std::nullopt;
    epc[i / 2] = static_cast<std::uint8_t>((unsigned{epc[i / 2]} << 4U) | digit);
  }
  return epc;
}

}  // namespace

std::size_t HashOfEpc96::operator()(const Epc96& epc) const {
  std::uint64_t front = 0;
  std::uint64_t back = 0;
  std::memcpy(&front, epc.data(), 8);
  std::memcpy(&back, epc.data() + 4, 8);
  std::uint64_t x = front ^ (back * 0x9E3779B97F4A7C15ULL);
  x = (x ^ (x >> 32U)) * 0xD6E8FEB86659FD93ULL;
  return static_cast<std::size_t>(x ^ (x >> 32U));
}

void append_hex(std::string& out, const Epc96& epc) {
  constexpr char kDigits[] = "0123456789abcdef";
  for (const std::uint8_t byte : epc) {
    out += kDigits[byte >> 4U];
    out += kDigits[byte & 0x0FU];
  }
}

void TagList::reserve(std::size_t tags) {
  x_.reserve(tags);
  y_.reserve(tags);
  z_.reserve(tags);
  epc_.reserve(tags);
  wanted_.reserve(tags);
}

void TagList::push_back(const Tag& tag) {
  const auto epc = epc96_from(tag.epc_hex);
  if (!epc) odd_.emplace(size(), tag.epc_hex);
  add(epc.value_or(Epc96{}), tag.position, tag.wanted);
}

void TagList::add(const Epc96& epc, hal::Vec3 position, bool wanted) {
  x_.push_back(position.x);
  y_.push_back(position.y);
  z_.push_back(position.z);
  epc_.push_back(epc);
  wanted_.push_back(wanted ? 1 : 0);
}

void append(TagList& tags, const TagList& more) {
  const std::size_t before = tags.size();
  const auto take = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  take(tags.x_, more.x_);
  take(tags.y_, more.y_);
  take(tags.z_, more.z_);
  take(tags.epc_, more.epc_);
  take(tags.wanted_, more.wanted_);
  for (const auto& [tag, epc] : more.odd_) tags.odd_.emplace(before + tag, epc);
}

void TagList::append_epc_hex(std::size_t tag, std::string& out) const {
  if (const Epc96* const epc = epc96(tag))
    append_hex(out, *epc);
  else
    out += odd_.at(tag);
}

std::string TagList::epc_hex(std::size_t tag) const {
  std::string text;
  append_epc_hex(tag, text);
  return text;
}

}  // namespace forager::mocks
