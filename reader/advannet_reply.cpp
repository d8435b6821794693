#include <fmt/format.h>

#include <charconv>
#include <pugixml.hpp>

#include "reader/advannet_rest.hpp"
#include "reader/advannet_wire.hpp"

namespace forager::reader::advannet {
namespace {

constexpr std::int64_t kMaxStampMs = 100'000'000'000'000;  // year 5138; keeps sums inside 64 bits
constexpr std::size_t kMaxText = 400;                      // of a message that goes into an error line

// The first element of that name below a node, at any depth; captures and vendor clients disagree on where
// things hang, and nobody uses a name twice.
pugi::xml_node find(const pugi::xml_node& below, const char* name) {
  return below.find_node(
      [name](const pugi::xml_node& node) { return std::string_view(node.name()) == name; });
}

std::string_view text(const pugi::xml_node& node) {
  std::string_view value = node.text().get();
  while (!value.empty() && static_cast<unsigned char>(value.front()) <= ' ') value.remove_prefix(1);
  while (!value.empty() && static_cast<unsigned char>(value.back()) <= ' ') value.remove_suffix(1);
  return value;
}

std::string one_line(std::string_view value) {
  std::string line(value.substr(0, kMaxText));
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  return line;
}

template <class T>
std::optional<T> number(std::string_view value) {
  T result{};
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), result);
  if (error != std::errc() || end != value.data() + value.size()) return std::nullopt;
  return result;
}

std::optional<std::int64_t> stamp(const pugi::xml_node& node) {
  const auto value = number<std::int64_t>(text(node));
  return value && *value > 0 && *value <= kMaxStampMs ? value : std::nullopt;
}

// "02h 49m 33s", with any of the parts missing and days in front: numbers, each followed by its unit.
std::optional<hal::Duration> uptime(std::string_view value) {
  std::int64_t seconds = 0;
  bool any = false;
  const char* at = value.data();
  const char* const end = at + value.size();
  while (at != end) {
    if (*at == ' ') {
      ++at;
      continue;
    }
    std::uint32_t amount = 0;
    const auto [stop, error] = std::from_chars(at, end, amount);
    if (error != std::errc() || stop == end) return std::nullopt;
    constexpr std::string_view kUnits = "dhms";
    constexpr std::int64_t kSeconds[] = {86400, 3600, 60, 1};
    const std::size_t unit = kUnits.find(*stop);
    if (unit == std::string_view::npos || amount > 1'000'000) return std::nullopt;
    seconds += amount * kSeconds[unit];
    any = true;
    at = stop + 1;
  }
  return any ? std::optional<hal::Duration>(std::chrono::seconds(seconds)) : std::nullopt;
}

void read_devices(const pugi::xml_node& data, Reply& reply) {
  // A device is an element <device> with an <id>; it hangs in <devices>, or alone in <data>.
  const pugi::xml_node first = find(data, "device");
  for (pugi::xml_node node = first; node; node = node.next_sibling("device")) {
    const std::string_view id = text(node.child("id"));
    if (id.empty()) continue;
    reply.devices.push_back({one_line(id), one_line(text(node.child("serial"))),
                             one_line(text(node.child("family"))), one_line(text(node.child("status")))});
  }
}

void read_inputs(const pugi::xml_node& data, Reply& reply) {
  const pugi::xml_node entries = find(data, "entries");
  for (const pugi::xml_node& entry : entries.children("entry")) {
    const auto index = number<unsigned>(text(entry.child("index")));
    const std::string_view level = text(entry.child("result"));
    if (index && *index < 255 && (level == "true" || level == "false"))
      reply.inputs.push_back({*index + 1, level == "true"});
  }
}

void read_error(std::string_view message, Reply& reply) {
  reply.message = one_line(message);
  const std::size_t colon = reply.message.find(':');
  const std::string_view code = std::string_view(reply.message).substr(0, colon);
  if (colon != std::string::npos &&
      code.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789") == std::string_view::npos)
    reply.code = std::string(code);
}

hal::Failure not_understood(const hal::HttpResponse& response, std::string detail) {
  return hal::fail(hal::ErrorCode::protocol, {}, "read reply",
                   fmt::format("HTTP status {}, {}", response.status, detail),
                   "Check that this address and port are AdvanNet's REST interface (3161)");
}

}  // namespace

hal::Result<Reply> parse_reply(const hal::HttpResponse& response) {
  if (response.body.size() > kMaxFrameBytes) return not_understood(response, "the body exceeds 4 MiB");
  const bool http_ok = response.status >= 200 && response.status < 300;
  pugi::xml_document document;
  // pugixml knows no document-defined entities and parses without recursion, so hostile XML stays harmless.
  const auto parsed = document.load_buffer(response.body.data(), response.body.size(), pugi::parse_default,
                                           pugi::encoding_utf8);
  if (!parsed) return not_understood(response, fmt::format("the body is no XML: {}", parsed.description()));
  const pugi::xml_node outer = document.child("response");
  const pugi::xml_node root = outer ? outer : document;
  const pugi::xml_node data = root.child("data");
  const std::string_view status = text(root.child("status"));
  if (!data && status.empty() && !root.child("msg"))
    return not_understood(response, "the body is no AdvanNet reply");

  Reply reply;
  // Without a status, a failing HTTP status or a lone message is what an error looks like.
  reply.ok = status == "OK" || (status.empty() && http_ok && data);
  reply.ts_ms = stamp(root.child("ts"));
  if (!reply.ok) {
    read_error(text(root.child("msg")), reply);
    return reply;
  }
  if (const auto result = find(data, "result")) reply.result = one_line(text(result));
  reply.uptime = uptime(text(find(data, "uptime")));
  read_devices(data, reply);
  read_inputs(data, reply);
  return reply;
}

std::string describe_refusal(const Reply& reply) {
  return fmt::format("answered {}", reply.message.empty() ? "ERROR without a message" : reply.message);
}

}  // namespace forager::reader::advannet
