#include "mocks/text_journal.hpp"

#include <fmt/format.h>

#include <cstring>
#include <iterator>

namespace forager::mocks {
namespace {

constexpr std::uint64_t kFnvOffset = 0xCBF29CE484222325ULL;
constexpr std::uint64_t kFnvPrime = 0x100000001B3ULL;

std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * kFnvPrime;
  return hash ^ (hash >> 29);
}

// Eight bytes a step: a mission puts tens of megabytes of wire through here. Little-endian by construction,
// so that the value is the same on every machine.
std::uint64_t digest(std::uint64_t hash, const char* bytes, std::size_t size) {
  hash = mix(hash, size);
  for (; size >= 8; bytes += 8, size -= 8) {
    std::uint64_t word = 0;
    for (int k = 7; k >= 0; --k) word = (word << 8) | static_cast<unsigned char>(bytes[k]);
    hash = mix(hash, word);
  }
  std::uint64_t rest = 0;
  for (; size > 0; --size) rest = (rest << 8) | static_cast<unsigned char>(bytes[size - 1]);
  return mix(hash, rest);
}

}  // namespace

TextJournal::TextJournal(TextJournalConfig config) : config_(std::move(config)), hash_(kFnvOffset) {}

void TextJournal::clear() {
  text_.clear();
  lines_ = 0;
  hash_ = kFnvOffset;
}

std::size_t TextJournal::count(std::string_view part) const {
  std::size_t found = 0;
  for (std::size_t at = text_.find(part); at != std::string::npos; at = text_.find(part, at)) {
    ++found;
    at = text_.find('\n', at);
  }
  return found;
}

void TextJournal::begin(hal::Instant now, std::string_view source) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t ns = now.time_since_epoch().count();
  const std::uint64_t magnitude =
      ns < 0 ? 0 - static_cast<std::uint64_t>(ns) : static_cast<std::uint64_t>(ns);
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{}{}.{:09} {} ", ns < 0 ? "-" : "", magnitude / kSecond,
                 magnitude % kSecond, source);
}

void TextJournal::finish() {
  line_.push_back('\n');
  hash_ = digest(hash_, line_.data(), line_.size());
  ++lines_;
  if (config_.keep) text_ += line_;
  if (config_.sink) config_.sink(line_);
}

void TextJournal::do_note(hal::Instant now, std::string_view source, std::string_view text) {
  begin(now, source);
  line_ += text;
  finish();
}

void TextJournal::do_wire(hal::Instant now, std::string_view source, std::string_view direction,
                          std::span<const std::byte> bytes) {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  begin(now, source);
  line_ += direction;
  line_ += ' ';
  if (bytes.size() > config_.max_hex_bytes) {
    fmt::format_to(std::back_inserter(line_), "{} bytes #{:016x}", bytes.size(),
                   digest(kFnvOffset, reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  } else {
    for (const std::byte byte : bytes) {
      line_ += kDigits[std::to_integer<std::size_t>(byte >> 4)];
      line_ += kDigits[std::to_integer<std::size_t>(byte & std::byte{15})];
    }
  }
  finish();
}

}  // namespace forager::mocks
