#include "mocks/sim_reader_xml.hpp"

#include <array>
#include <utility>

namespace forager::mocks {
namespace {

constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
    {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}}};

// An opening tag with a name; closing tags, comments, processing instructions and "<>" are none.
bool starts_tag(std::string_view text) {
  constexpr std::string_view kNoName = "/!?> \t\r\n";
  return text.size() > 1 && kNoName.find(text[1]) == std::string_view::npos;
}

// Position of the closing tag that belongs to an element already open, elements of the same name inside
// counted.
std::size_t closing_tag(std::string_view text, std::string_view name) {
  int depth = 1;
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    const bool closing = at + 1 < text.size() && text[at + 1] == '/';
    const std::string_view tail = text.substr(at + (closing ? 2 : 1));
    if (tail.substr(0, name.size()) != name || tail.size() == name.size()) continue;
    const char after = tail[name.size()];
    if (after != '>' && after != '/' && after != ' ') continue;
    const std::size_t end = tail.find('>');
    if (end == std::string_view::npos) return end;
    if (!closing && tail[end - 1] != '/') ++depth;
    if (closing && --depth == 0) return at;
  }
  return std::string_view::npos;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::optional<XmlElement> next_element(std::string_view& rest) {
  std::size_t at = rest.find('<');
  while (at != std::string_view::npos && !starts_tag(rest.substr(at))) at = rest.find('<', at + 1);
  const std::size_t end = at == std::string_view::npos ? at : rest.find('>', at);
  if (end == std::string_view::npos) {
    rest = {};
    return std::nullopt;
  }
  const std::string_view tag = rest.substr(at + 1, end - at - 1);
  const bool empty = tag.ends_with('/');
  const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
  rest.remove_prefix(end + 1);
  if (empty) return XmlElement{name, {}};
  const std::size_t close = closing_tag(rest, name);
  if (close == std::string_view::npos) {
    rest = {};
    return std::nullopt;
  }
  const XmlElement element{name, rest.substr(0, close)};
  rest.remove_prefix(rest.find('>', close) + 1);
  return element;
}

std::optional<std::string_view> find_element(std::string_view text, std::string_view name, int depth) {
  while (const auto element = next_element(text)) {
    if (element->name == name) return element->inner;
    if (depth <= 1 || element->inner.find('<') == std::string_view::npos) continue;
    if (const auto deeper = find_element(element->inner, name, depth - 1)) return deeper;
  }
  return std::nullopt;
}

std::string xml_unescaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    std::size_t step = 1;
    char c = text.front();
    for (const auto& [entity, plain] : kEntities)
      if (text.starts_with(entity)) {
        c = plain;
        step = entity.size();
      }
    out += c;
    text.remove_prefix(step);
  }
  return out;
}

void append_xml_escaped(std::string& out, std::string_view text) {
  for (const char c : text) {
    // XML 1.0 has no way to write control characters.
    std::string_view piece =
        static_cast<unsigned char>(c) < 0x20 ? std::string_view("?") : std::string_view(&c, 1);
    for (const auto& [entity, plain] : kEntities)
      if (c == plain) piece = entity;
    out += piece;
  }
}

void append_element(std::string& out, std::string_view name, std::string_view text) {
  out += '<';
  out += name;
  out += '>';
  append_xml_escaped(out, text);
  out += "</";
  out += name;
  out += '>';
}

std::string result_element(std::string_view text) {
  std::string out;
  append_element(out, "result", text);
  return out;
}

}  // namespace forager::mocks
