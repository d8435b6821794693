#include "reader/advannet_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace forager::reader {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kSource = "reader";
constexpr std::size_t kMaxBytesPerUpdate = 1UL << 20U;  // keeps one update short whatever the peer sends
constexpr hal::Duration kSettle = 10s;                  // stale reads are normal this long after a start
constexpr hal::Duration kMaxAhead = 1s;                 // of arrival, for a read's time to be believed
constexpr hal::Duration kMaxBehind = 60s;  // stream time-out, reader queue and disorder stay below
constexpr std::size_t kExpectedReads = 1024;

hal::Failure wrong(std::string field, std::string detail) {
  return hal::fail(hal::ErrorCode::invalid_argument, {}, "[reader] " + std::move(field), std::move(detail),
                   "Set a time in the board file");
}

std::string cause(const hal::Error& error) {
  return error.detail.empty() ? std::string(to_string(error.code)) : error.detail;
}

}  // namespace

hal::Result<> validate(const AdvanNetConfig& config) {
  if (config.request_timeout <= 0ns) return wrong("request_timeout", "is not positive");
  if (config.stream_timeout <= advannet::kKeepAlivePeriod)
    return wrong("stream_timeout", "is not above the keep-alive period of 5 s: a quiet reader would be lost");
  if (config.status_period <= 0ns) return wrong("status_period", "is not positive");
  if (config.backoff_first <= 0ns || config.backoff_cap < config.backoff_first)
    return wrong("backoff", "is not positive, or its cap is below its start");
  if (config.request_tries < 1) return wrong("request_tries", "is below 1");
  return {};
}

AdvanNetReader::AdvanNetReader(hal::HttpClient& rest, hal::ByteStream& events, hal::Journal& journal,
                               ReadPlan plan, AdvanNetConfig config)
    : rest_(rest),
      events_(events),
      journal_(journal),
      plan_(std::move(plan)),
      config_(std::move(config)),
      settings_(advannet::settings_of(plan_)),
      backoff_(config_.backoff_first, config_.backoff_cap) {
  reads_.reserve(kExpectedReads);
  message_.reads.reserve(kExpectedReads);
  inputs_.reserve(16);
}

void AdvanNetReader::start(hal::Instant now) {
  now_ = now;
  if (!idle() && step_ != Step::ending) return;
  drop_connections();
  backoff_.reset();
  settings_in_place_ = false;
  for (const auto& valid : {validate(plan_), validate(config_)}) {
    if (valid) continue;
    step_ = Step::failed;
    set_phase(LinkPhase::failed, hal::describe(valid.error()));
    return;
  }
  set_phase(LinkPhase::opening, {});
  go(Step::discover);
}

void AdvanNetReader::update(hal::Instant now) {
  now_ = now;
  reads_.clear();
  inputs_.clear();
  poll_rest();
  if (step_ == Step::waiting && wait_.expired(now_)) go(Step::discover);
  if (step_ == Step::stream) connect_stream();
  take_in();
  watch();
  send_due();
}

void AdvanNetReader::stop(hal::Instant now) {
  now_ = now;
  shut_down("stopped on request", Step::closed);
  send_due();
}

void AdvanNetReader::halt() noexcept {
  try {
    shut_down("halted", Step::closed);
    send_due();
  } catch (...) {
    step_ = Step::closed;  // out of memory: the reader goes on, and may_radiate() says so
  }
}

void AdvanNetReader::set_phase(LinkPhase phase, std::string reason) {
  if (phase == link_.phase && reason == link_.reason) return;
  if (phase != link_.phase) link_.since = now_;
  link_.phase = phase;
  link_.reason = std::move(reason);
  journal_.note(now_, kSource,
                fmt::format("link {}{}{}", to_string(phase), link_.reason.empty() ? "" : ": ", link_.reason));
}

// Whatever was open did not last: wait, then look again what is there.
void AdvanNetReader::lose(std::string reason) {
  if (link_.phase == LinkPhase::open) ++link_.losses;
  drop_connections();
  step_ = Step::waiting;
  wait_ = hal::Deadline(now_, backoff_.next());
  set_phase(LinkPhase::lost, std::move(reason));
}

void AdvanNetReader::fail_link(std::string reason) {
  if (may_radiate_) {
    shut_down(std::move(reason), Step::failed);
    return;
  }
  drop_connections();
  step_ = Step::failed;
  set_phase(LinkPhase::failed, std::move(reason));
}

void AdvanNetReader::shut_down(std::string reason, Step afterwards) {
  for (const auto& gpo : gpos_) gpo->want_inactive();
  if (idle() || step_ == Step::ending) return;
  rest_.cancel();
  call_ = repeat_ = Call::none;
  after_ending_ = afterwards;
  set_phase(afterwards == Step::failed ? LinkPhase::failed : LinkPhase::closed, std::move(reason));
  stop_owed_ = true;
  if (device_.id.empty()) {
    end();  // never found, so never started
  } else {
    step_ = Step::ending;
  }
}

void AdvanNetReader::end() {
  drop_connections();
  step_ = after_ending_;
}

void AdvanNetReader::drop_connections() {
  rest_.cancel();
  call_ = repeat_ = Call::none;
  tries_ = 0;
  events_.close();
  stream_live_ = false;
}

void AdvanNetReader::connect_stream() {
  const auto state = events_.poll();
  if (!state) {
    lose(hal::describe({state.error().code, std::string(events_.name()), "connect event stream",
                        cause(state.error()),
                        "Check the reader's TCP service and that fewer than 4 clients are connected"}));
    return;
  }
  if (*state != hal::StreamState::open) {
    if (wait_.expired(now_))
      lose(hal::describe({hal::ErrorCode::timeout, std::string(events_.name()), "connect event stream",
                          "no connection in time", "Check the network and the reader's TCP service"}));
    return;
  }
  stream_.reset();
  stream_live_ = true;
  noise_ = false;
  stream_heard_ = now_;
  if (writing_all_)
    go(Step::start);
  else
    open_link();
}

void AdvanNetReader::open_link() {
  step_ = Step::open;
  settings_in_place_ = true;
  stream_heard_ = now_;
  last_check_ = now_;
  check_now_ = false;
  if (was_open_) ++counters_.reconnects;
  was_open_ = true;
  link_.speaks = false;
  set_phase(LinkPhase::open, {});
}

// While the start is under way the bytes stay where they are: which of them are stale shows in its reply.
void AdvanNetReader::take_in() {
  if (step_ != Step::open && step_ != Step::ending) return;
  for (std::size_t taken = 0; stream_live_ && taken < kMaxBytesPerUpdate;) {
    const auto count = events_.read(stream_.room());
    if (!count) {
      stream_live_ = false;
      if (step_ == Step::open)
        lose(hal::describe({count.error().code, std::string(events_.name()), "read event stream",
                            cause(count.error()), "Connecting again"}));
      return;
    }
    if (*count == 0) return;
    taken += *count;
    stream_.commit(*count);
    link_.last_heard = now_;
    const std::uint64_t before = frames();
    take_frames();
    noise_ = frames() == before;  // or part of a frame
    if (noise_) continue;
    stream_heard_ = now_;
    link_.speaks = true;
    backoff_.reset();
  }
}

std::uint64_t AdvanNetReader::frames() const {
  return stream_.counters().frames + stream_.counters().keepalives;
}

void AdvanNetReader::take_frames() {
  while (stream_live_) {
    const auto body = stream_.next();
    if (!body) {
      stream_live_ = false;
      if (step_ == Step::open) lose(hal::describe(body.error()));
      return;
    }
    if (!*body) return;
    const auto decoded = decode_advannet_message(**body, message_);
    if (decoded) {
      take_message();
      continue;
    }
    ++counters_.malformed;
    if (decoded.error().code == hal::ErrorCode::unsupported) {
      stream_live_ = false;
      if (step_ == Step::open) fail_link(hal::describe(decoded.error()));
      return;
    }
    // The 1st, 2nd, 4th, 8th, ...: a reader that sends nothing else must not fill the journal.
    if (std::has_single_bit(counters_.malformed))
      journal_.note(
          now_, kSource,
          fmt::format("{} (message {} of the kind)", hal::describe(decoded.error()), counters_.malformed));
  }
}

void AdvanNetReader::take_message() {
  counters_.bad_items += message_.bad_items;
  for (TagRead& read : message_.reads)
    if (accept(read)) reads_.push_back(read);
  inputs_.insert(inputs_.end(), message_.inputs.begin(), message_.inputs.end());
  if (message_.kind == AdvanNetMessage::Kind::inventory) ++counters_.inventories;
  if (message_.kind == AdvanNetMessage::Kind::unknown) ++counters_.unknown;
  if (message_.type.empty() || message_.type == "GPI") return;
  journal_.note(now_, kSource, fmt::format("event {}: {}", message_.type, message_.text));
  // The reader says that it does not read any more; whether that still holds, it can say itself.
  if (message_.type == "DEVICE_STOP" || message_.type == "ADVANNET_DEVICE_STOPPED" ||
      message_.type == "ADVANNET_DEVICE_DISCONNECTED")
    check_now_ = true;
}

bool AdvanNetReader::accept(TagRead& read) {
  read.arrived = now_;
  if (start_ms_ && read.reader_ms < *start_ms_) {
    ++counters_.stale;
    if (now_ - started_ > kSettle) check_now_ = true;  // or the clock was set back
    return false;
  }
  read.heard = clock_.to_instant(read.reader_ms, now_);
  if (read.heard > now_ + clock_.uncertainty(now_) + kMaxAhead || read.heard < now_ - kMaxBehind) {
    ++counters_.clock_doubts;
    check_now_ = true;
    read.heard = now_;
  }
  read.heard = std::min(read.heard, now_);
  if (read.reader_ms < newest_ms_)
    ++counters_.out_of_order;
  else
    newest_ms_ = read.reader_ms;
  ++counters_.reads;
  return true;
}

void AdvanNetReader::watch() {
  if (step_ != Step::open || now_ - stream_heard_ < config_.stream_timeout) return;
  lose(hal::describe({hal::ErrorCode::timeout, std::string(events_.name()), "read event stream",
                      fmt::format("{} for {:.1f} s, not even a keep-alive", noise_ ? "only noise" : "nothing",
                                  hal::to_seconds(now_ - stream_heard_)),
                      "Check the reader's power and the network; connecting again"}));
}

}  // namespace forager::reader
