// Character data of XML: entities to UTF-8 and back.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "reader/advannet_xml.hpp"

namespace forager::reader::advannet {
namespace {

void append_utf8(std::uint32_t code, std::string& out) {
  const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(static_cast<unsigned char>(byte)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0U | (code >> 6U));
    put(0x80U | (code & 0x3FU));
  } else if (code < 0x10000) {
    put(0xE0U | (code >> 12U));
    put(0x80U | ((code >> 6U) & 0x3FU));
    put(0x80U | (code & 0x3FU));
  } else {
    put(0xF0U | (code >> 18U));
    put(0x80U | ((code >> 12U) & 0x3FU));
    put(0x80U | ((code >> 6U) & 0x3FU));
    put(0x80U | (code & 0x3FU));
  }
}

// Replaces one entity at the start of `raw` (which starts with '&'). Returns how many bytes of raw it took;
// 0: not one we know.
std::size_t append_entity(std::string_view raw, std::string& out) {
  const std::size_t end = raw.substr(0, 12).find(';');
  if (end == std::string_view::npos) return 0;
  std::string_view name = raw.substr(1, end - 1);
  constexpr std::array<std::pair<std::string_view, char>, 5> kKnown{
      {{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}}};
  for (const auto& [known, character] : kKnown) {
    if (name != known) continue;
    out += character;
    return end + 1;
  }
  if (!name.starts_with('#')) return 0;
  name.remove_prefix(1);
  const int base = name.starts_with('x') ? 16 : 10;
  if (base == 16) name.remove_prefix(1);
  std::uint32_t code = 0;
  const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), code, base);
  if (name.empty() || error != std::errc() || stop != name.data() + name.size()) return 0;
  if (code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return 0;
  append_utf8(code < 0x20 ? ' ' : code, out);
  return end + 1;
}

}  // namespace

void decode_text(std::string_view raw, std::size_t limit, std::string& out) {
  out.clear();
  while (!raw.empty() && out.size() < limit) {
    const std::size_t taken = raw.front() == '&' ? append_entity(raw, out) : 0;
    if (taken == 0) out += static_cast<unsigned char>(raw.front()) < 0x20 ? ' ' : raw.front();
    raw.remove_prefix(std::max<std::size_t>(1, taken));
  }
}

std::string escape_text(std::string_view raw) {
  std::string out;
  out.reserve(raw.size());
  for (const char c : raw) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&apos;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace forager::reader::advannet
