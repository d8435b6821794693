#include "hal/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <utility>

namespace forager::hal {
namespace {

constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kMostSeconds = 4'000'000'000;  // 126 years: sums of two still fit into an Instant
constexpr std::size_t kErrorFields = 6;

// Names of the codes as they are written: what to_string() says is for people and may change.
constexpr std::array<std::string_view, 13> kCodes{
    "invalid_argument", "invalid_state",  "not_present",  "permission", "busy",
    "timeout",          "no_ack",         "disconnected", "io",         "protocol",
    "refused",          "authentication", "unsupported"};

std::string_view name_of(ErrorCode code) { return kCodes.at(static_cast<std::size_t>(code)); }

std::optional<ErrorCode> code_named(std::string_view name) {
  for (std::size_t i = 0; i < kCodes.size(); ++i)
    if (kCodes[i] == name) return static_cast<ErrorCode>(i);
  return std::nullopt;
}

bool is_plain(char c) { return c > ' ' && c < '\x7f' && c != '%' && c != '='; }

void append(std::string& line, std::string_view field) {
  line += ' ';
  if (field.empty()) line += '-';
  if (field == "-") {
    line += "%2d";
    return;
  }
  for (const char c : field) {
    if (is_plain(c)) {
      line += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    line += '%';
    line += kDigits[byte >> 4U];
    line += kDigits[byte & 15U];
  }
}

int digit(char c) {
  const std::size_t at = kDigits.find(c);
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

std::optional<std::string> unescaped(std::string_view field) {
  if (field == "-") return std::string();
  std::string text;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field[i] != '%') {
      if (!is_plain(field[i])) return std::nullopt;
      text += field[i];
      continue;
    }
    if (i + 2 >= field.size() || digit(field[i + 1]) < 0 || digit(field[i + 2]) < 0) return std::nullopt;
    text += static_cast<char>(16 * digit(field[i + 1]) + digit(field[i + 2]));
    i += 2;
  }
  return text;
}

Failure broken(std::string detail) {
  return fail(ErrorCode::protocol, "recording", "parse", std::move(detail));
}

std::optional<Instant> instant_in(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  if (negative) text.remove_prefix(1);
  const std::size_t dot = text.find('.');
  if (dot == std::string_view::npos || dot == 0 || text.size() != dot + 10) return std::nullopt;
  const auto seconds = integer_in(text.substr(0, dot));
  const auto nanos = integer_in(text.substr(dot + 1));
  if (!seconds || !nanos || *seconds < 0 || *nanos < 0 || *seconds > kMostSeconds) return std::nullopt;
  const std::int64_t ns = *seconds * kSecond + *nanos;
  return Instant(Duration(negative ? -ns : ns));
}

Result<std::vector<std::string_view>> split(std::string_view line) {
  std::vector<std::string_view> parts;
  for (std::size_t space = 0; space != std::string_view::npos;) {
    space = line.find(' ');
    parts.push_back(line.substr(0, space));
    if (parts.back().empty()) return broken("two spaces in a row, or one at an end");
    if (space != std::string_view::npos) line.remove_prefix(space + 1);
  }
  return parts;
}

Result<Fields> fields_of(std::span<const std::string_view> parts) {
  Fields fields;
  for (const std::string_view part : parts) {
    auto field = unescaped(part);
    if (!field) return broken(fmt::format("\"{}\" is no field", part.substr(0, 40)));
    fields.push_back(*std::move(field));
  }
  return fields;
}

Fields fields_of(const Error& error) {
  return {std::string(name_of(error.code)),
          error.device,
          error.operation,
          error.detail,
          error.mend,
          field(error.sys_errno)};
}

Result<Error> error_in(const Fields& fields) {
  if (fields.size() != kErrorFields) return broken("an error has six fields");
  const auto code = code_named(fields[0]);
  const auto number = integer_in(fields[5]);
  if (!code || !number || *number < 0 || *number > 4095) return broken("an error with another code or errno");
  return Error{*code, fields[1], fields[2], fields[3], fields[4], static_cast<int>(*number)};
}

template <class Number>
std::optional<Number> parsed(std::string_view text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return value;
}

}  // namespace

std::string to_line(const Record& record) {
  const std::int64_t ns = record.at.time_since_epoch().count();
  const std::uint64_t magnitude =
      ns < 0 ? 0 - static_cast<std::uint64_t>(ns) : static_cast<std::uint64_t>(ns);
  std::string line = fmt::format("{}{}.{:09}", ns < 0 ? "-" : "", magnitude / kSecond, magnitude % kSecond);
  append(line, record.device);
  append(line, record.operation);
  for (const std::string& one : record.asked) append(line, one);
  line += record.answer ? " = ok" : " = error";
  for (const std::string& one : record.answer ? *record.answer : fields_of(record.answer.error()))
    append(line, one);
  return line;
}

Result<Record> parse_record(std::string_view line) {
  const auto parts = split(line);
  if (!parts) return fail(parts.error());
  const auto equals = std::find(parts->begin(), parts->end(), "=");
  if (equals - parts->begin() < 3 || parts->end() - equals < 2)
    return broken("a record is: time, device, operation, what was asked, =, ok or error, the answer");
  Record record;
  const auto at = instant_in(parts->front());
  if (!at)
    return broken(
        fmt::format("\"{}\" is no time in seconds with nine decimals", parts->front().substr(0, 40)));
  record.at = *at;
  auto asked = fields_of(std::span(parts->begin() + 1, equals));
  if (!asked) return fail(std::move(asked).error());
  record.device = std::move((*asked)[0]);
  record.operation = std::move((*asked)[1]);
  record.asked.assign(std::make_move_iterator(asked->begin() + 2), std::make_move_iterator(asked->end()));
  auto answer = fields_of(std::span(equals + 2, parts->end()));
  if (!answer) return fail(std::move(answer).error());
  if (equals[1] == "ok") {
    record.answer = *std::move(answer);
    return record;
  }
  if (equals[1] != "error") return broken("an answer is ok or error");
  auto error = error_in(*answer);
  if (!error) return fail(std::move(error).error());
  record.answer = fail(*std::move(error));
  return record;
}

Result<std::vector<Record>> parse_recording(std::string_view text) {
  std::vector<Record> records;
  bool headed = false;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    const bool cut_off = end == std::string_view::npos;
    text.remove_prefix(cut_off ? text.size() : end + 1);
    if (line.empty() || line.front() == '#') continue;
    if (!headed) {
      if (line != kRecordingHead)
        return broken(fmt::format("line {}: this is no recording: it does not begin with \"{}\"", number,
                                  kRecordingHead));
      headed = true;
      continue;
    }
    auto record = parse_record(line);
    if (!record && cut_off) break;
    if (!record) return broken(fmt::format("line {}: {}", number, record.error().detail));
    records.push_back(*std::move(record));
  }
  if (!headed) return broken("it is empty");
  return records;
}

std::string field(std::span<const std::byte> bytes) {
  std::string text;
  text.reserve(2 * bytes.size());
  for (const std::byte byte : bytes) {
    text += kDigits[std::to_integer<std::size_t>(byte >> 4)];
    text += kDigits[std::to_integer<std::size_t>(byte & std::byte{15})];
  }
  return text;
}

std::string field(Duration time) { return field(time.count()); }

std::optional<std::vector<std::byte>> bytes_in(std::string_view field) {
  if (field.size() % 2 != 0) return std::nullopt;
  std::vector<std::byte> bytes;
  bytes.reserve(field.size() / 2);
  for (std::size_t i = 0; i < field.size(); i += 2) {
    const int high = digit(field[i]);
    const int low = digit(field[i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    bytes.push_back(static_cast<std::byte>(16 * high + low));
  }
  return bytes;
}

std::optional<std::int64_t> integer_in(std::string_view field) { return parsed<std::int64_t>(field); }
std::optional<double> number_in(std::string_view field) { return parsed<double>(field); }

Recorder::Recorder(const Clock& clock, std::function<void(std::string_view line)> sink)
    : clock_(&clock), sink_(std::move(sink)) {
  sink_(std::string(kRecordingHead) + "\n");
  take("recorder", "start", {}, Fields{});
}

void Recorder::take(std::string_view device, std::string_view operation, Fields asked,
                    Result<Fields> answer) {
  sink_(to_line({clock_->now(), std::string(device), std::string(operation), std::move(asked),
                 std::move(answer)}) +
        "\n");
  ++records_;
}

}  // namespace forager::hal
