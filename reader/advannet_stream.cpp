#include "reader/advannet_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>

namespace forager::reader {
namespace {

constexpr std::size_t kInitialBuffer = 64UL * 1024;
constexpr std::size_t kLeastRoom = 4096;
constexpr std::size_t kMaxLine = 1024;       // a longer line is no header
constexpr std::size_t kMaxHeaderLines = 16;  // real frames have three

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<std::uint64_t> decimal(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

AdvanNetStream::AdvanNetStream(std::size_t max_body_bytes)
    : buffer_(kInitialBuffer), max_body_(max_body_bytes) {}

std::span<std::byte> AdvanNetStream::room() {
  if (begin_ == end_) begin_ = end_ = 0;
  const std::size_t wanted =
      state_ == State::body ? std::max(kLeastRoom, static_cast<std::size_t>(*length_)) : kLeastRoom;
  if (buffer_.size() - end_ < kLeastRoom || buffer_.size() - begin_ < wanted) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    // Doubling, and only as far as bytes really arrive: a length in a header alone must not cost memory.
    if (buffer_.size() - end_ < kLeastRoom) buffer_.resize(buffer_.size() * 2);
  }
  return std::span(buffer_).subspan(end_);
}

void AdvanNetStream::commit(std::size_t count) {
  end_ = std::min(end_ + count, buffer_.size());
  counters_.bytes += count;
}

void AdvanNetStream::reset() {
  counters_.garbage_bytes += header_bytes_ + pending_bytes();
  begin_ = end_ = 0;
  state_ = State::seek;
  in_long_line_ = false;
  header_bytes_ = 0;
}

hal::Result<std::optional<std::string_view>> AdvanNetStream::next() {
  while (true) {
    if (state_ == State::broken)
      return hal::fail(hal::ErrorCode::protocol, "event stream", "read frame",
                       fmt::format("length {} is above the cap of {} bytes", *length_, max_body_),
                       "check that the port is AdvanNet's event stream (3177)");
    if (state_ == State::body) {
      const auto length = static_cast<std::size_t>(*length_);
      if (pending_bytes() < length) return std::nullopt;
      const std::string_view body = pending().substr(0, length);
      begin_ += length;
      counters_.frame_bytes += header_bytes_ + length;
      header_bytes_ = 0;
      state_ = State::seek;
      if (length == 0) {
        ++counters_.keepalives;
        continue;
      }
      ++counters_.frames;
      return body;
    }
    const std::optional<Line> line = take_line();
    if (!line) return std::nullopt;
    if (state_ == State::seek)
      seek_line(*line);
    else
      header_line(*line);
  }
}

std::string_view AdvanNetStream::pending() const {
  // std::byte may be looked at as char
  return {reinterpret_cast<const char*>(buffer_.data()) + begin_, end_ - begin_};
}

// The next whole line, consumed. A line that outgrows every header is dropped piecewise as garbage.
std::optional<AdvanNetStream::Line> AdvanNetStream::take_line() {
  while (true) {
    const std::string_view all = pending();
    const std::size_t at = all.substr(0, kMaxLine).find('\n');
    if (at == std::string_view::npos && all.size() < kMaxLine) return std::nullopt;
    const bool whole = at != std::string_view::npos;
    const std::size_t size = whole ? at + 1 : kMaxLine;
    if (!whole || in_long_line_) {
      if (state_ == State::header) give_up_header();
      begin_ += size;
      counters_.garbage_bytes += size;
      if (!in_long_line_) ++counters_.garbage_lines;
      in_long_line_ = !whole;
      continue;
    }
    begin_ += size;
    std::string_view text = all.substr(0, at);
    while (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return Line{text, size};
  }
}

void AdvanNetStream::seek_line(const Line& line) {
  if (line.text.starts_with(advannet::kFrameMagic)) {
    start_header(line);
  } else if (trim(line.text).empty()) {
    counters_.blank_bytes += line.size;
  } else {
    ++counters_.garbage_lines;
    counters_.garbage_bytes += line.size;
  }
}

void AdvanNetStream::start_header(const Line& line) {
  state_ = State::header;
  header_bytes_ = line.size;
  header_lines_ = 1;
  length_.reset();
  length_bad_ = false;
}

void AdvanNetStream::give_up_header() {
  ++counters_.bad_headers;
  counters_.garbage_bytes += header_bytes_;
  header_bytes_ = 0;
  state_ = State::seek;
}

void AdvanNetStream::header_line(const Line& line) {
  if (line.text.starts_with(advannet::kFrameMagic)) {
    give_up_header();  // the frame before was cut off; this one may be whole
    start_header(line);
    return;
  }
  header_bytes_ += line.size;
  if (trim(line.text).empty()) {
    if (!length_ || length_bad_)
      give_up_header();
    else
      state_ = *length_ > max_body_ ? State::broken : State::body;
    return;
  }
  if (++header_lines_ > kMaxHeaderLines) {
    give_up_header();
    return;
  }
  const std::size_t colon = line.text.find(':');
  if (colon == std::string_view::npos) return;
  if (!equal_ignoring_case(trim(line.text.substr(0, colon)), advannet::kContentLength)) return;
  const auto value = decimal(trim(line.text.substr(colon + 1)));
  // Two lengths that differ leave nothing to believe.
  if (!value || (length_ && *length_ != *value)) length_bad_ = true;
  length_ = value;
}

}  // namespace forager::reader
