#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace forager::mocks {

// Just enough XML for what clients send to an AdvanReader: elements in elements, no attributes of interest,
// no CDATA. Everything is a view into the text given.
struct XmlElement {
  std::string_view name;
  std::string_view inner;  // between the tags; empty for <name/>
};

// Takes the next element off `rest` (comments, declarations and loose text are skipped); nullopt at the end
// or where the text stops making sense.
[[nodiscard]] std::optional<XmlElement> next_element(std::string_view& rest);
// The first element of this name in the text, depth first, at most `depth` levels down.
[[nodiscard]] std::optional<std::string_view> find_element(std::string_view text, std::string_view name,
                                                           int depth = 8);
[[nodiscard]] std::string_view trimmed(std::string_view text);

// The five predefined entities.
[[nodiscard]] std::string xml_unescaped(std::string_view text);
void append_xml_escaped(std::string& out, std::string_view text);

// std::to_chars onto the end of a string: the fast path of read events.
template <std::integral Number>
void append_number(std::string& out, Number number) {
  char digits[24];
  const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
  out.append(digits, static_cast<std::size_t>(end - digits));
}

// "<name>text</name>", text escaped.
void append_element(std::string& out, std::string_view name, std::string_view text);
// "<result>text</result>"
[[nodiscard]] std::string result_element(std::string_view text);

}  // namespace forager::mocks
