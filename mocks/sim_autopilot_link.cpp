#include "mocks/sim_autopilot_link.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace forager::mocks {
namespace {
constexpr hal::Duration kReopen = std::chrono::milliseconds(100);
constexpr std::string_view kName = "sim-autopilot";
}  // namespace

SimAutopilotLink::SimAutopilotLink(hal::ByteStream& stream, const SimAutopilotConfig& config,
                                   const SimAutopilotFaults& faults)
    : stream_(&stream),
      faults_(&faults),
      packer_(config.system, config.component, config.mavlink1),
      random_(hal::Random::stream(config.seed, 0x6C696E6B)) {}

void SimAutopilotLink::service(hal::Instant now) {
  const auto state = stream_->poll();
  open_ = state && *state == hal::StreamState::open;
  if (!open_ && (!state || *state == hal::StreamState::closed) && (!tried_ || now - *tried_ >= kReopen)) {
    tried_ = now;
    // A refusal is no news: the other side comes when it comes.
    if (stream_->open()) {
      const auto after = stream_->poll();
      open_ = after && *after == hal::StreamState::open;
    }
  }
  if (!open_) {
    waiting_size_ = 0;
    return;
  }
  if (waiting_size_ == 0) return;
  const auto sent = stream_->write(std::span<const std::byte>(waiting_).first(waiting_size_));
  if (!sent) return;
  std::memmove(waiting_.data(), waiting_.data() + *sent, waiting_size_ - *sent);
  waiting_size_ -= *sent;
}

void SimAutopilotLink::send(const peer::MessageKind& kind, const MavlinkPayload& payload, hal::Instant now) {
  const auto frame = packer_.pack(kind, payload);
  if (frame.empty() || !open_ || silent_) return;
  const FrameFaults& faults = faults_->tx;
  if (faults.drop > 0.0 && random_.chance(faults.drop)) return;
  if (faults.corrupt > 0.0 && random_.chance(faults.corrupt)) {
    std::array<std::byte, 280> spoilt{};
    std::ranges::copy(frame, spoilt.begin());
    spoilt[random_.below(frame.size())] ^= static_cast<std::byte>(1U << random_.below(8));
    write(std::span<const std::byte>(spoilt).first(frame.size()), now);
    return;
  }
  write(frame, now);
  if (faults.duplicate > 0.0 && random_.chance(faults.duplicate)) write(frame, now);
}

void SimAutopilotLink::write(std::span<const std::byte> frame, hal::Instant now) {
  std::size_t taken = 0;
  if (waiting_size_ == 0) {
    const auto sent = stream_->write(frame);
    if (!sent) {
      open_ = false;
      return;
    }
    taken = *sent;
  }
  const auto rest = frame.subspan(taken);
  if (rest.size() > waiting_.size() - waiting_size_) return;
  std::ranges::copy(rest, waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_size_));
  waiting_size_ += rest.size();
  ++frames_sent_;
  if (journal_ != nullptr) journal_->wire(now, kName, "tx", frame);
}

bool SimAutopilotLink::fill(hal::Instant now) {
  if (heard_begin_ == heard_end_) {
    const auto count = stream_->read(heard_);
    if (!count) open_ = false;
    if (!count || *count == 0) return false;
    heard_begin_ = 0;
    heard_end_ = *count;
    const auto bytes = std::span(heard_).first(*count);
    if (silent_) {
      heard_begin_ = heard_end_;
      return true;
    }
    if (faults_->rx.corrupt > 0.0 && random_.chance(faults_->rx.corrupt))
      bytes[random_.below(*count)] ^= static_cast<std::byte>(1U << random_.below(8));
    if (journal_ != nullptr) journal_->wire(now, kName, "rx", bytes);
  }
  heard_begin_ +=
      parser_.push(std::span<const std::byte>(heard_).subspan(heard_begin_, heard_end_ - heard_begin_));
  return true;
}

const MavlinkPeerFrame* SimAutopilotLink::receive(hal::Instant now) {
  if (again_ != nullptr) return std::exchange(again_, nullptr);
  while (open_) {
    const MavlinkPeerFrame* frame = parser_.next();
    if (frame == nullptr) {
      if (!fill(now)) return nullptr;
      continue;
    }
    const FrameFaults& faults = faults_->rx;
    if (faults.drop > 0.0 && random_.chance(faults.drop)) continue;
    if (faults.duplicate > 0.0 && random_.chance(faults.duplicate)) again_ = frame;
    ++frames_heard_;
    return frame;
  }
  return nullptr;
}

}  // namespace forager::mocks
