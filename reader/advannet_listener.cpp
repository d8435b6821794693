#include "reader/advannet_listener.hpp"

#include <fmt/format.h>

#include <bit>
#include <utility>

namespace forager::reader {
namespace {

constexpr std::string_view kSource = "reader";
constexpr std::size_t kMaxBytesPerUpdate = 1UL << 20U;  // keeps one update short whatever the peer sends

}  // namespace

AdvanNetListener::AdvanNetListener(hal::ByteStream& events, hal::Journal& journal,
                                   const AdvanNetConfig& config)
    : events_(&events),
      journal_(&journal),
      config_(config),
      backoff_(config.backoff_first, config.backoff_cap) {}

void AdvanNetListener::start(hal::Instant now) {
  now_ = now;
  if (link_.phase != LinkPhase::closed && link_.phase != LinkPhase::failed) return;
  backoff_.reset();
  wait_ = hal::Deadline(now, hal::Duration::zero());
  link_.phase = LinkPhase::lost;  // no news yet: the first update() connects
  link_.since = now;
}

void AdvanNetListener::update(hal::Instant now) {
  now_ = now;
  reads_.clear();
  if (link_.phase == LinkPhase::lost && wait_.expired(now)) {
    wait_ = hal::Deadline(now, config_.request_timeout);
    enter(LinkPhase::opening, {});
    if (const auto opened = events_->open(); !opened) return lose(hal::describe(opened.error()));
  }
  if (link_.phase == LinkPhase::opening) connect();
  if (link_.phase == LinkPhase::open) take_in();
  if (link_.phase == LinkPhase::open && now - heard_ > config_.stream_timeout)
    lose(fmt::format("{}: {} for {:.1f} s, not even a keep-alive", events_->name(),
                     link_.last_heard > heard_ ? "only noise" : "nothing", hal::to_seconds(now - heard_)));
}

void AdvanNetListener::halt() noexcept {
  events_->close();
  link_.phase = LinkPhase::closed;
  link_.since = now_;
}

void AdvanNetListener::enter(LinkPhase phase, std::string reason) {
  if (phase == link_.phase && reason == link_.reason) return;
  if (phase != link_.phase) link_.since = now_;
  link_.phase = phase;
  link_.reason = std::move(reason);
  journal_->note(
      now_, kSource,
      fmt::format("link {}{}{}", to_string(phase), link_.reason.empty() ? "" : ": ", link_.reason));
}

void AdvanNetListener::lose(std::string reason) {
  if (link_.phase == LinkPhase::open) ++link_.losses;
  events_->close();
  wait_ = hal::Deadline(now_, backoff_.next());
  enter(LinkPhase::lost, std::move(reason));
}

void AdvanNetListener::connect() {
  const auto state = events_->poll();
  if (!state) return lose(hal::describe(state.error()));
  if (*state != hal::StreamState::open) {
    if (wait_.expired(now_))
      lose(hal::describe({hal::ErrorCode::timeout, std::string(events_->name()), "connect event stream",
                          "no connection in time", "Check the network and the reader's TCP service"}));
    return;
  }
  stream_.reset();
  heard_ = now_;
  if (was_open_) ++counters_.reconnects;
  was_open_ = true;
  link_.speaks = false;
  enter(LinkPhase::open, {});
}

void AdvanNetListener::take_in() {
  for (std::size_t taken = 0; link_.phase == LinkPhase::open && taken < kMaxBytesPerUpdate;) {
    const auto count = events_->read(stream_.room());
    if (!count) return lose(hal::describe(count.error()));
    if (*count == 0) return;
    taken += *count;
    stream_.commit(*count);
    link_.last_heard = now_;
    const auto frames = [this] { return stream_.counters().frames + stream_.counters().keepalives; };
    const std::uint64_t before = frames();
    take_frames();
    if (frames() == before) continue;
    heard_ = now_;
    link_.speaks = true;
    backoff_.reset();
  }
}

void AdvanNetListener::take_frames() {
  while (true) {
    const auto body = stream_.next();
    if (!body) return lose(hal::describe(body.error()));
    if (!*body) return;
    const auto decoded = decode_advannet_message(**body, message_);
    if (decoded) {
      take_message();
      continue;
    }
    ++counters_.malformed;
    if (decoded.error().code == hal::ErrorCode::unsupported) {
      events_->close();
      return enter(LinkPhase::failed, hal::describe(decoded.error()));
    }
    if (std::has_single_bit(counters_.malformed))  // the 1st, 2nd, 4th, 8th, ...
      journal_->note(now_, kSource, hal::describe(decoded.error()));
  }
}

void AdvanNetListener::take_message() {
  counters_.bad_items += message_.bad_items;
  for (TagRead& read : message_.reads) {
    read.arrived = read.heard = now_;
    reads_.push_back(read);
  }
  counters_.reads += message_.reads.size();
  if (message_.kind == AdvanNetMessage::Kind::inventory) ++counters_.inventories;
  if (message_.kind == AdvanNetMessage::Kind::unknown) ++counters_.unknown;
  if (!message_.type.empty() && message_.type != "GPI")
    journal_->note(now_, kSource, fmt::format("event {}: {}", message_.type, message_.text));
}

}  // namespace forager::reader
