#include "reader/advannet_xml.hpp"

#include <algorithm>
#include <cstring>

namespace forager::reader::advannet {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

constexpr std::array<bool, 256> make_name_table(bool first) {
  std::array<bool, 256> table{};
  for (std::size_t c = 0; c < 256; ++c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' || c >= 0x80;
    const bool inner = (c >= '0' && c <= '9') || c == '-' || c == '.';
    table[c] = letter || (!first && inner);
  }
  return table;
}
constexpr auto kNameStart = make_name_table(true);
constexpr auto kNameChar = make_name_table(false);

bool starts_name(char c) { return kNameStart[static_cast<unsigned char>(c)]; }
bool in_name(char c) { return kNameChar[static_cast<unsigned char>(c)]; }

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

XmlScanner::XmlScanner(std::string_view document)
    : at_(document.data()), end_(document.data() + document.size()) {
  if (document.starts_with("\xEF\xBB\xBF")) at_ += 3;
  if (!document.empty() && std::memchr(document.data(), 0, document.size()) != nullptr)
    fail("holds a NUL byte");
}

XmlScanner::Token XmlScanner::fail(std::string_view problem) {
  problem_ = problem;
  at_ = end_;
  return Token::error;
}

XmlScanner::Token XmlScanner::next() {
  if (!problem_.empty()) return Token::error;
  if (empty_element_) {
    empty_element_ = false;
    return close_top();
  }
  while (true) {
    const char* const from = at_;
    skip_blanks();
    if (at_ == end_) {
      if (depth_ != 0) return fail("ends inside an element");
      return root_seen_ ? Token::end : fail("holds no element");
    }
    if (*at_ != '<') {
      if (depth_ == 0) return fail("has text outside the root element");
      const auto* const stop =
          static_cast<const char*>(std::memchr(at_, '<', static_cast<std::size_t>(end_ - at_)));
      if (stop == nullptr) return fail("ends inside text");
      text_ = trim({from, static_cast<std::size_t>(stop - from)});
      at_ = stop;
      return Token::text;
    }
    ++at_;
    const Token token = markup();
    if (token != Token::end) return token;  // end here means: a comment or instruction was skipped
  }
}

XmlScanner::Token XmlScanner::markup() {
  if (at_ == end_) return fail("ends inside a tag");
  if (starts_name(*at_)) return open_tag();
  if (*at_ == '/') {
    ++at_;
    return close_tag();
  }
  const std::string_view rest(at_, static_cast<std::size_t>(end_ - at_));
  if (rest.starts_with("?")) {
    ++at_;
    if (at_ == end_ || !starts_name(*at_)) return fail("has a nameless processing instruction");
    return skip_past("?>", "ends inside a processing instruction") ? Token::end : Token::error;
  }
  if (rest.starts_with("!--")) {
    at_ += 3;
    return skip_past("-->", "ends inside a comment") ? Token::end : Token::error;
  }
  if (rest.starts_with("![CDATA[")) {
    at_ += 8;
    return cdata();
  }
  if (rest.starts_with("!DOCTYPE")) return fail("brings a document type, which no reader sends");
  return fail("has a '<' that starts no tag");
}

XmlScanner::Token XmlScanner::open_tag() {
  if (depth_ == 0 && root_seen_) return fail("has a second root element");
  if (depth_ == kMaxDepth) return fail("nests too deeply");
  name_ = take_name();
  if (at_ != end_ && *at_ == '>')
    ++at_;
  else if (!skip_attributes(empty_element_))
    return Token::error;
  root_seen_ = true;
  stack_[depth_++] = name_;
  return Token::open;
}

XmlScanner::Token XmlScanner::close_tag() {
  if (depth_ != 0) {  // nearly always exactly the name that is open
    const std::string_view open = stack_[depth_ - 1];
    if (static_cast<std::size_t>(end_ - at_) > open.size() && at_[open.size()] == '>' &&
        std::memcmp(at_, open.data(), open.size()) == 0) {
      at_ += open.size() + 1;
      return close_top();
    }
  }
  const std::string_view name = take_name();
  skip_blanks();
  if (at_ == end_ || *at_ != '>') return fail("has a broken end tag");
  ++at_;
  if (depth_ == 0 || name != stack_[depth_ - 1]) return fail("closes an element that is not open");
  return close_top();
}

XmlScanner::Token XmlScanner::close_top() {
  name_ = stack_[--depth_];
  return Token::close;
}

XmlScanner::Token XmlScanner::cdata() {
  if (depth_ == 0) return fail("has text outside the root element");
  const char* const from = at_;
  if (!skip_past("]]>", "ends inside CDATA")) return Token::error;
  text_ = trim({from, static_cast<std::size_t>(at_ - 3 - from)});
  return Token::text;
}

bool XmlScanner::skip_past(std::string_view end, std::string_view problem) {
  const auto* const found = std::search(at_, end_, end.begin(), end.end());
  if (found == end_) {
    fail(problem);
    return false;
  }
  at_ = found + end.size();
  return true;
}

bool XmlScanner::skip_attributes(bool& empty_element) {
  const auto broken = [this] {
    fail("has a broken start tag");
    return false;
  };
  while (true) {
    const char* const before = at_;
    skip_blanks();
    if (at_ == end_) return broken();
    if (*at_ == '>') {
      ++at_;
      return true;
    }
    if (*at_ == '/') {
      ++at_;
      if (at_ == end_ || *at_ != '>') return broken();
      ++at_;
      empty_element = true;
      return true;
    }
    if (at_ == before || !starts_name(*at_)) return broken();  // attributes stand apart
    take_name();
    skip_blanks();
    if (at_ == end_ || *at_ != '=') return broken();
    ++at_;
    skip_blanks();
    if (at_ == end_ || (*at_ != '"' && *at_ != '\'')) return broken();
    const char quote = *at_++;
    at_ = std::find(at_, end_, quote);
    if (at_ == end_) return broken();
    ++at_;
  }
}

void XmlScanner::skip_blanks() {
  while (at_ != end_ && is_blank(*at_)) ++at_;
}

std::string_view XmlScanner::take_name() {
  const char* const from = at_;
  while (at_ != end_ && in_name(*at_)) ++at_;
  return {from, static_cast<std::size_t>(at_ - from)};
}

// <name>text</name> with the start tag already taken: by far the most frequent shape.
bool XmlScanner::take_leaf(std::string_view& text) {
  if (empty_element_ || depth_ == 0) return false;
  const std::string_view open = stack_[depth_ - 1];
  const char* stop = at_;
  if (stop != end_ && *stop != '<')
    stop = static_cast<const char*>(std::memchr(at_, '<', static_cast<std::size_t>(end_ - at_)));
  if (stop == nullptr || static_cast<std::size_t>(end_ - stop) < open.size() + 3) return false;
  if (stop[1] != '/' || stop[open.size() + 2] != '>' || std::memcmp(stop + 2, open.data(), open.size()) != 0)
    return false;
  text = {at_, static_cast<std::size_t>(stop - at_)};
  at_ = stop + open.size() + 3;
  --depth_;
  return true;
}

bool XmlScanner::skip_leaf() {
  std::string_view text;
  return take_leaf(text);
}

std::string_view XmlScanner::leaf_text() {
  std::string_view only;
  if (take_leaf(only)) return trim(only);
  const std::size_t inside = depth_;
  std::string_view first;
  bool have = false;
  while (true) {
    const Token token = next();
    if (token == Token::error || token == Token::end) return {};
    if (token == Token::text && !have && depth_ == inside) {
      first = text_;
      have = true;
    }
    if (token == Token::close && depth_ < inside) return first;
  }
}

}  // namespace forager::reader::advannet
