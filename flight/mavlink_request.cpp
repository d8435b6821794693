#include "flight/mavlink_request.hpp"

#include <fmt/format.h>

namespace forager::flight {
namespace {

std::string_view result_name(std::uint8_t result) {
  switch (result) {
    case mavlink::result::kTemporarilyRejected:
      return "temporarily rejected";
    case mavlink::result::kDenied:
      return "denied";
    case mavlink::result::kUnsupported:
      return "unsupported";
    case mavlink::result::kFailed:
      return "failed";
    case mavlink::result::kCancelled:
      return "cancelled";
    default:
      return "answered with an unknown result";
  }
}

}  // namespace

MavlinkRequest::MavlinkRequest(const MavlinkConfig& config)
    : timeout_(config.command_timeout),
      progress_timeout_(config.command_progress_timeout),
      reason_timeout_(config.reason_timeout),
      max_tries_(config.command_tries) {
  detail_.reserve(320);
}

bool MavlinkRequest::is_mode_change() const { return command_.command == mavlink::command::kDoSetMode; }

void MavlinkRequest::begin(std::string_view what, const mavlink::CommandLong& command, hal::Instant now) {
  only_heartbeat_counts_ =
      state_ == RequestState::pending && is_mode_change() && command.command == command_.command;
  state_ = RequestState::pending;
  detail_.clear();
  what_ = what;
  command_ = command;
  tries_ = 0;
  begun_ = now;
  next_try_ = now;
  refusal_.reset();
}

void MavlinkRequest::cancel() {
  state_ = RequestState::none;
  detail_.clear();
  refusal_.reset();
}

void MavlinkRequest::refuse(std::string_view what, std::string_view why) {
  what_ = what;
  finish_refused(why);
}

void MavlinkRequest::finish_refused(std::string_view why) {
  state_ = RequestState::refused;
  refusal_.reset();
  detail_.clear();
  fmt::format_to(std::back_inserter(detail_), "{} refused: {}", what_, why);
}

const mavlink::CommandLong* MavlinkRequest::due(hal::Instant now) {
  if (state_ != RequestState::pending || refusal_ || now < next_try_) return nullptr;
  if (tries_ == max_tries_) {
    fmt::memory_buffer why;
    fmt::format_to(std::back_inserter(why), "no answer in {} tries", tries_);
    finish_refused({why.data(), why.size()});
    return nullptr;
  }
  command_.confirmation = static_cast<std::uint8_t>(tries_++);
  next_try_ = now + timeout_;
  return &command_;
}

void MavlinkRequest::take(const mavlink::CommandAck& ack, hal::Instant now) {
  if (state_ != RequestState::pending || refusal_ || tries_ == 0 || ack.command != command_.command) return;
  switch (ack.result) {
    case mavlink::result::kAccepted:
      if (!only_heartbeat_counts_) state_ = RequestState::accepted;
      break;
    case mavlink::result::kInProgress:
      next_try_ = now + progress_timeout_;
      break;
    case mavlink::result::kTemporarilyRejected:
      if (tries_ < max_tries_) break;
      [[fallthrough]];
    default:
      if (only_heartbeat_counts_) break;
      refusal_ = ack.result;
      refused_at_ = now;
  }
}

void MavlinkRequest::update(const AutopilotState& autopilot, std::optional<hal::Instant> last_warning,
                            hal::Instant now) {
  if (state_ != RequestState::pending) return;
  if (refusal_) {
    const bool explained = last_warning && *last_warning > begun_;
    if (explained)
      finish_refused(autopilot.last_text);
    else if (now - refused_at_ >= reason_timeout_)
      finish_refused(result_name(*refusal_));
    return;
  }
  const bool shown = is_mode_change() && tries_ > 0 && autopilot.last_heartbeat >= begun_ &&
                     static_cast<float>(autopilot.custom_mode) == command_.param2;
  if (shown) state_ = RequestState::accepted;
}

}  // namespace forager::flight
