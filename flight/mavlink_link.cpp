#include "flight/mavlink_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "autopilot";

}  // namespace

MavlinkLink::MavlinkLink(hal::ByteStream& stream, hal::Journal& journal, const MavlinkConfig& config,
                         std::optional<mavlink::Signing> signing)
    : stream_(&stream),
      journal_(&journal),
      journal_wire_(config.journal_wire),
      sysid_(config.sysid),
      compid_(config.compid),
      reopen_first_(config.reopen_first),
      reopen_most_(config.reopen_most),
      reopen_after_silence_(config.reopen_after_silence),
      signing_(std::move(signing)),
      sender_{config.sysid, config.compid, 0},
      pause_(config.reopen_first) {}

void MavlinkLink::service(hal::Instant now) {
  if (state_ == hal::StreamState::closed) {
    if (next_open_ && now < *next_open_) return;
    if (const auto started = stream_->open(); !started) return failed(started.error(), now);
    state_ = hal::StreamState::opening;
  }
  const auto polled = stream_->poll();
  if (!polled) return failed(polled.error(), now);
  if (*polled == hal::StreamState::open && state_ != hal::StreamState::open) opened(now);
  state_ = *polled;
  if (!is_open()) return;
  flush(now);
  if (is_open() && reopen_after_silence_ > hal::Duration::zero() &&
      now - last_byte_ > reopen_after_silence_) {
    stream_->close();
    failed({hal::ErrorCode::timeout, std::string(stream_->name()), "listen", "nothing was heard", "", 0},
           now);
  }
}

void MavlinkLink::opened(hal::Instant now) {
  ++stats_.opens;
  parser_.reset();
  waiting_size_ = 0;
  last_byte_ = now;
  journal_->note(now, kSource, fmt::format("link {} open", stream_->name()));
}

void MavlinkLink::failed(const hal::Error& error, hal::Instant now) {
  state_ = hal::StreamState::closed;
  waiting_size_ = 0;
  next_open_ = now + pause_;
  journal_->note(now, kSource,
                 fmt::format("link failed, again in {} ms: {}",
                             std::chrono::duration_cast<std::chrono::milliseconds>(pause_).count(),
                             hal::describe(error)));
  pause_ = std::min(2 * pause_, reopen_most_);
}

std::size_t MavlinkLink::read(std::span<std::byte> into, hal::Instant now) {
  if (!is_open()) return 0;
  const auto count = stream_->read(into);
  if (!count) {
    failed(count.error(), now);
    return 0;
  }
  if (*count > 0) {
    last_byte_ = now;
    pause_ = reopen_first_;  // it works again: the next failure is a new one
    if (journal_wire_) journal_->wire(now, kSource, "rx", into.first(*count));
  }
  return *count;
}

bool MavlinkLink::admit(const mavlink::Frame& frame, hal::Instant now) {
  if (frame.sysid == sysid_ && frame.compid == compid_) return false;  // an echo of ourselves
  if (signing_) {
    const auto verdict = signing_->verify(frame, now);
    if (!verdict || !mavlink::is_acceptable(*verdict)) {
      ++stats_.frames_unauthentic;
      return false;
    }
  }
  sequences_.count(frame);
  return true;
}

void MavlinkLink::transmit(mavlink::FrameBuffer& buffer, hal::Instant now) {
  if (!is_open() || (signing_ && !signing_->sign(buffer, now))) {
    ++stats_.frames_dropped;
    return;
  }
  flush(now);
  if (!is_open()) {
    ++stats_.frames_dropped;
    return;
  }
  const auto frame = buffer.bytes();
  std::size_t taken = 0;
  if (waiting_size_ == 0) {
    const auto written = stream_->write(frame);
    if (!written) {
      ++stats_.frames_dropped;
      return failed(written.error(), now);
    }
    taken = *written;
  }
  const auto rest = frame.subspan(taken);
  if (rest.size() > waiting_.size() - waiting_size_) {
    ++stats_.frames_dropped;  // whole: the stream has taken nothing of it, as something else still waits
    return;
  }
  std::memcpy(waiting_.data() + waiting_size_, rest.data(), rest.size());
  waiting_size_ += rest.size();
  ++stats_.frames_sent;
  if (journal_wire_) journal_->wire(now, kSource, "tx", frame);
}

void MavlinkLink::flush(hal::Instant now) {
  if (waiting_size_ == 0) return;
  const auto written = stream_->write(std::span(waiting_).first(waiting_size_));
  if (!written) return failed(written.error(), now);
  waiting_size_ -= *written;
  std::memmove(waiting_.data(), waiting_.data() + *written, waiting_size_);
}

}  // namespace forager::flight
