#include "mocks/sim_reader_streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "mocks/sim_reader_xml.hpp"

namespace forager::mocks {
namespace {

using hal::StreamState;

constexpr std::string_view kBlankLines = "\r\n\r\n";
constexpr hal::Duration kJoinPatience = std::chrono::seconds(1);
constexpr std::uint64_t kFaultStream = 3177;

std::span<const std::byte> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

void append_header(std::string& out, std::size_t length, bool version_1_0, bool content_type) {
  out += version_1_0 ? "ADVANNET/1.0\r\n" : "ADVANNET/1.1\r\n";
  out += "Content-Length:";  // no blank: vendor parsers read the rest of the line as an integer
  append_number(out, length);
  out += content_type ? "\r\nContent-Type:text/xml\r\n\r\n" : "\r\n\r\n";
}

}  // namespace

SimReaderStreams::SimReaderStreams(const SimReaderConfig& config, const SimReaderFaults& faults,
                                   hal::Journal& journal)
    : config_(&config),
      faults_(&faults),
      journal_(&journal),
      random_(hal::Random::stream(config.seed, kFaultStream)) {}

void SimReaderStreams::attach(MemoryStreamPair& line) {
  attach(line.far());
  lines_.back()->pair = &line;
}

void SimReaderStreams::attach(hal::ByteStream& end) {
  lines_.push_back(std::make_unique<Line>());
  lines_.back()->end = &end;
}

void SimReaderStreams::detach(const hal::ByteStream& end) {
  std::erase_if(lines_, [&end](const auto& line) { return line->end == &end; });
}

bool SimReaderStreams::attached(const hal::ByteStream& end) const {
  return std::ranges::any_of(lines_, [&end](const auto& line) { return line->end == &end; });
}

std::size_t SimReaderStreams::clients() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(lines_, [](const auto& line) { return line->client; }));
}

void SimReaderStreams::note(hal::Instant now, const Line& line, std::string_view what) {
  journal_->note(now, config_->name, fmt::format("stream client {} {}", line.number, what));
}

void SimReaderStreams::set_power(Power power, hal::Instant now) {
  power_ = power;
  if (power == Power::on) return;
  std::erase_if(lines_, [this, now](const auto& line) {
    const bool off = power_ == Power::off;
    if (line->pair != nullptr) line->pair->cut(off);
    if (!off || line->pair == nullptr) return !hang_up(*line, now, "forgotten");
    line->client = false;
    return false;
  });
}

void SimReaderStreams::broadcast(std::string_view body) {
  frame_.clear();
  append_header(frame_, body.size(), faults_->header_1_0, true);
  frame_ += body;
  frame_ += kBlankLines;
  for (const auto& line : lines_)
    if (line->client) enqueue(*line, frame_);
}

void SimReaderStreams::enqueue(Line& line, std::string_view frame) {
  if (line.count == kMaxQueued) {
    ++frames_dropped_;
    // A frame already half on the wire cannot be taken back: the next oldest goes in its place.
    if (line.sent > 0) std::swap(line.queue[line.head], line.queue[(line.head + 1) % kMaxQueued]);
    line.head = (line.head + 1) % kMaxQueued;
    --line.count;
    if (line.sent == 0) line.prepared = false;
  }
  line.queue[(line.head + line.count) % kMaxQueued].assign(frame);
  ++line.count;
}

void SimReaderStreams::update(hal::Instant now) {
  if (power_ == Power::off) return;
  std::erase_if(lines_, [this, now](const auto& line) { return !service(*line, now); });
}

bool SimReaderStreams::service(Line& line, hal::Instant now) {
  if (line.pair != nullptr) line.pair->refuse_connects(power_ == Power::booting || faults_->refuse_connects);
  const auto state = line.end->poll();
  if (!state || *state == StreamState::closed) return hang_up(line, now, "gone");
  if (*state != StreamState::open) return true;
  const std::uint32_t connection = line.pair != nullptr ? line.pair->connections() : 0;
  if (line.client && connection != line.connection) {
    note(now, line, "gone");
    line.client = false;
  }
  if (!line.client) {
    const bool room = clients() < kMaxClients && power_ == Power::on && !faults_->refuse_connects;
    line.connection = connection;
    line.number = ++connections_;
    if (!room) return hang_up(line, now, "turned away");
    welcome(line, now);
  }
  return hear(line, now) && send(line, now);
}

void SimReaderStreams::welcome(Line& line, hal::Instant now) {
  line.client = true;
  line.head = line.count = line.sent = 0;
  line.prepared = line.joined = false;
  line.silent_until = line.join_until = now;
  line.next_keep_alive = now + kKeepAlivePeriod;
  note(now, line, "connected");
}

// Ends the connection from our side; the end goes back to listening if it can.
bool SimReaderStreams::hang_up(Line& line, hal::Instant now, std::string_view why) {
  if (line.client || why == "turned away") note(now, line, why);
  line.client = false;
  line.end->close();
  return line.end->open().has_value();
}

// Clients may send acknowledgements; they are read and ignored.
bool SimReaderStreams::hear(Line& line, hal::Instant now) {
  std::array<std::byte, 256> heard{};
  while (true) {
    const auto count = line.end->read(heard);
    if (!count) return hang_up(line, now, "gone");
    if (*count < heard.size()) return true;
  }
}

// Draws the faults of the frame now at the front.
void SimReaderStreams::prepare(Line& line, hal::Instant now) {
  const auto happens = [this](double chance) { return chance > 0.0 && random_.chance(chance); };
  line.prepared = true;
  std::string& frame = line.queue[line.head];
  if (happens(faults_->garbage_lines)) {
    std::string garbage;
    for (std::uint64_t lines = 1 + random_.below(3); lines > 0; --lines)
      fmt::format_to(std::back_inserter(garbage), "?{:016x} <item>\r\n", random_.next());
    frame.insert(0, garbage);
  }
  line.split = happens(faults_->split_frame);
  line.close_after = happens(faults_->close_abruptly) ? 1 + random_.below(frame.size() - 1) : 0;
  // The frame that another one waited for goes out with it, whatever its own fate would be.
  if (!std::exchange(line.joined, false) && happens(faults_->join_frame)) {
    line.join_until = now + kJoinPatience;
    line.joined = true;
  }
  if (happens(faults_->pause)) {
    line.silent_until = now + faults_->pause_length;
    note(now, line, "gets nothing for a while");
  }
}

bool SimReaderStreams::send(Line& line, hal::Instant now) {
  if (now < line.silent_until) return true;
  if (now >= line.next_keep_alive) {
    frame_.clear();
    append_header(frame_, 0, faults_->header_1_0, !faults_->bare_keep_alive);
    frame_ += kBlankLines;
    enqueue(line, frame_);
    line.next_keep_alive += kKeepAlivePeriod;
    if (line.next_keep_alive <= now) line.next_keep_alive = now + kKeepAlivePeriod;
  }
  while (line.count > 0) {
    if (!line.prepared) prepare(line, now);
    if (now < line.silent_until || (now < line.join_until && line.count < 2)) return true;
    line.join_until = now;
    const std::string_view frame = line.queue[line.head];
    std::string_view piece = frame.substr(line.sent);
    if (line.split) piece = piece.substr(0, 1 + random_.below(piece.size()));
    if (line.close_after > 0)
      piece = piece.substr(0, line.close_after - std::min(line.sent, line.close_after));
    const auto taken = line.end->write(as_bytes(piece));
    if (!taken) return hang_up(line, now, "gone");
    if (config_->journal_wire && *taken > 0)
      journal_->wire(now, config_->name, "tx", as_bytes(piece.substr(0, *taken)));
    line.sent += *taken;
    if (line.close_after > 0 && line.sent >= line.close_after)
      return hang_up(line, now, "closed in mid-frame");
    if (line.sent < frame.size()) return true;
    line.head = (line.head + 1) % kMaxQueued;
    --line.count;
    line.sent = 0;
    line.prepared = false;
  }
  return true;
}

}  // namespace forager::mocks
