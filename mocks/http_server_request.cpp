#include "mocks/http_server_request.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace forager::mocks {
namespace {

bool is_token_char(char c) {
  constexpr std::string_view kOthers = "!#$%&'*+-.^_`|~";
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
         kOthers.find(c) != std::string_view::npos;
}
bool is_token(std::string_view text) { return !text.empty() && std::ranges::all_of(text, is_token_char); }

bool is_hex(char c) { return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'F') || (c >= 'a' && c <= 'f'); }

// Visible ASCII, every percent sign followed by two hexadecimal digits.
bool is_target(std::string_view text) {
  if (text.empty() || text.front() != '/') return false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] <= ' ' || text[at] > '~') return false;
    if (text[at] == '%' && !(at + 2 < text.size() && is_hex(text[at + 1]) && is_hex(text[at + 2])))
      return false;
  }
  return true;
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// The next line without its end (CR LF, or LF alone as RFC 9112 section 2.2 allows).
std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

// Length of everything up to and including the blank line; npos if it has not come yet.
std::size_t header_length(std::string_view bytes) {
  std::size_t at = 0;
  while (true) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos) return end;
    if (end == at || (end == at + 1 && bytes[at] == '\r')) return end + 1;
    at = end + 1;
  }
}

struct Head {
  HttpServerRequest request;
  std::optional<std::size_t> content_length;
  bool expects_continue = false;
};
using HeadParse = std::variant<Head, HttpRejected>;

std::optional<HttpRejected> parse_request_line(std::string_view line, Head& head) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || last == first) return HttpRejected{400};
  std::string_view target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  if (!is_token(line.substr(0, first))) return HttpRejected{400};
  if (version.substr(0, 5) != "HTTP/") return HttpRejected{400};
  if (version != "HTTP/1.0" && version != "HTTP/1.1") return HttpRejected{505};
  if (target.starts_with("http://")) {  // absolute form, as a proxy would be asked
    target.remove_prefix(std::min(target.find('/', 7), target.size()));
    if (target.empty()) target = "/";
  }
  if (!is_target(target)) return HttpRejected{400};
  head.request.method = line.substr(0, first);
  head.request.target = target;
  head.request.keep_alive = version == "HTTP/1.1";
  return std::nullopt;
}

std::optional<HttpRejected> parse_header(std::string_view line, const HttpServerLimits& limits, Head& head) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) return HttpRejected{400};
  const std::string_view name = line.substr(0, colon);
  const std::string_view value = without_blanks(line.substr(colon + 1));
  if (same_ignoring_case(name, "Content-Length")) {
    std::size_t length = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), length);
    if (error == std::errc::result_out_of_range) return HttpRejected{413};
    if (error != std::errc() || end != value.data() + value.size()) return HttpRejected{400};
    if (head.content_length && *head.content_length != length) return HttpRejected{400};
    if (length > limits.body_bytes) return HttpRejected{413};
    head.content_length = length;
  } else if (same_ignoring_case(name, "Transfer-Encoding")) {
    return HttpRejected{501};
  } else if (same_ignoring_case(name, "Connection")) {
    if (same_ignoring_case(value, "close")) head.request.keep_alive = false;
    if (same_ignoring_case(value, "keep-alive")) head.request.keep_alive = true;
  } else if (same_ignoring_case(name, "Authorization")) {
    head.request.authorization = value;
  } else if (same_ignoring_case(name, "Expect")) {
    head.expects_continue = same_ignoring_case(value, "100-continue");
  }
  return std::nullopt;
}

HeadParse parse_head(std::string_view text, const HttpServerLimits& limits) {
  Head head;
  if (const auto rejected = parse_request_line(take_line(text), head)) return *rejected;
  while (true) {
    const std::string_view line = take_line(text);
    if (line.empty()) return head;
    if (const auto rejected = parse_header(line, limits, head)) return *rejected;
  }
}

}  // namespace

bool same_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

HttpParse take_http_request(std::string& bytes, const HttpServerLimits& limits) {
  bytes.erase(0, std::min(bytes.find_first_not_of("\r\n"), bytes.size()));
  const std::size_t header = header_length(bytes);
  if (header == std::string::npos)
    return bytes.size() > limits.header_bytes ? HttpParse(HttpRejected{431}) : HttpParse(HttpNeedsMore{});
  if (header > limits.header_bytes) return HttpRejected{431};
  HeadParse parsed = parse_head(std::string_view(bytes).substr(0, header), limits);
  if (const auto* rejected = std::get_if<HttpRejected>(&parsed)) return *rejected;
  Head& head = std::get<Head>(parsed);
  const std::size_t length = head.content_length.value_or(0);
  if (bytes.size() - header < length) return HttpNeedsMore{head.expects_continue};
  head.request.body = bytes.substr(header, length);
  bytes.erase(0, header + length);
  return std::move(head.request);
}

}  // namespace forager::mocks
