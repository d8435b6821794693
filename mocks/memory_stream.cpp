#include "mocks/memory_stream.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace forager::mocks {
namespace {

using hal::ErrorCode;
using hal::StreamState;

// A datagram travels as its length and its bytes.
using LengthBytes = std::array<std::byte, sizeof(std::uint32_t)>;

}  // namespace

MemoryStreamPair::MemoryStreamPair(const std::string& name, MemoryStreamKind kind, std::size_t capacity_bytes)
    : kind_(kind),
      near_(*this, capacity_bytes, name),
      far_(*this, capacity_bytes, name + " (device side)"),
      limit_(capacity_bytes) {
  far_.state_ = kind == MemoryStreamKind::bytes ? StreamState::opening : StreamState::open;
}

bool MemoryStreamPair::connected() const {
  return near_.state_ == StreamState::open && far_.state_ == StreamState::open && !near_.peer_gone_ &&
         !far_.peer_gone_;
}

hal::Result<> MemoryStreamPair::accept() {
  if (!connecting())
    return hal::fail(ErrorCode::invalid_state, near_.name_, "accept", "nobody is connecting");
  connect();
  return {};
}

void MemoryStreamPair::connect() {
  for (MemoryStream* end : {&near_, &far_}) {
    end->inbox_.clear();
    end->peer_gone_ = false;
    end->state_ = StreamState::open;
  }
  ++connections_;
}

void MemoryStreamPair::drop() {
  if (kind_ == MemoryStreamKind::datagrams) return;
  for (MemoryStream* end : {&near_, &far_})
    if (end->state_ == StreamState::open) end->peer_gone_ = true;
}

// The far end keeps listening after its client has gone; only its own close() ends that.
void MemoryStreamPair::hang_up(MemoryStream& end) {
  const bool was_open = end.state_ == StreamState::open;
  end.state_ = StreamState::closed;
  end.peer_gone_ = false;
  end.inbox_.clear();
  MemoryStream& peer = other(end);
  if (was_open && kind_ == MemoryStreamKind::bytes && peer.state_ == StreamState::open)
    peer.peer_gone_ = true;
}

hal::Result<> MemoryStream::injected() {
  if (!next_error_) return {};
  hal::Error error = std::move(*next_error_);
  next_error_.reset();
  if (error.code != ErrorCode::invalid_state) pair_->hang_up(*this);
  return hal::fail(std::move(error));
}

hal::Result<> MemoryStream::require_open(const char* operation) const {
  if (state_ == StreamState::open) return {};
  return hal::fail(ErrorCode::invalid_state, name_, operation, "the stream is not open");
}

hal::Result<> MemoryStream::do_open() {
  FORAGER_TRY(injected());
  if (state_ != StreamState::closed)
    return hal::fail(ErrorCode::invalid_state, name_, "open", "the stream is open already");
  state_ = StreamState::opening;
  if (this == &pair_->far_) listening_ = true;
  return {};
}

hal::Result<StreamState> MemoryStream::do_poll() {
  FORAGER_TRY(injected());
  if (state_ != StreamState::opening) return state_;
  if (pair_->kind_ == MemoryStreamKind::datagrams) {
    state_ = StreamState::open;
    return state_;
  }
  if (this == &pair_->far_ || pair_->cut_) return state_;
  if (pair_->refuse_ || !pair_->far_.listening_) {
    state_ = StreamState::closed;
    return hal::fail(ErrorCode::refused, name_, "connect", "nobody listens");
  }
  if (!pair_->hold_) pair_->connect();
  return state_;
}

hal::Result<std::size_t> MemoryStream::do_read(std::span<std::byte> into) {
  FORAGER_TRY(injected());
  FORAGER_TRY(require_open("read"));
  if (pair_->cut_) return std::size_t{0};
  if (inbox_.size() == 0) {
    if (!peer_gone_) return std::size_t{0};
    state_ = StreamState::closed;
    peer_gone_ = false;
    return hal::fail(ErrorCode::disconnected, name_, "read", "the peer closed the connection");
  }
  if (pair_->kind_ == MemoryStreamKind::bytes) return inbox_.pop(into);
  LengthBytes length_bytes{};
  inbox_.pop(length_bytes);
  std::uint32_t length = 0;
  std::memcpy(&length, length_bytes.data(), sizeof length);
  const std::size_t taken = inbox_.pop(into.first(std::min<std::size_t>(into.size(), length)));
  inbox_.skip(length - taken);  // as recv() does: what the caller had no room for is gone
  return taken;
}

hal::Result<std::size_t> MemoryStream::do_write(std::span<const std::byte> bytes) {
  FORAGER_TRY(injected());
  FORAGER_TRY(require_open("write"));
  if (peer_gone_) {
    if (inbox_.size() != 0) return bytes.size();  // a network notices late; what came first is read first
    pair_->hang_up(*this);
    return hal::fail(ErrorCode::disconnected, name_, "write", "the peer closed the connection");
  }
  MemoryStream& peer = pair_->other(*this);
  const std::size_t queued = peer.inbox_.size();
  const std::size_t allowed =
      std::min(pair_->limit_ > queued ? pair_->limit_ - queued : 0, peer.inbox_.room());
  if (pair_->kind_ == MemoryStreamKind::bytes)
    return peer.inbox_.push(bytes.first(std::min(bytes.size(), allowed)));
  if (pair_->cut_ || peer.state_ != StreamState::open || bytes.size() + sizeof(std::uint32_t) > allowed)
    return bytes.size();
  const auto length = static_cast<std::uint32_t>(bytes.size());
  LengthBytes length_bytes{};
  std::memcpy(length_bytes.data(), &length, sizeof length);
  peer.inbox_.push(length_bytes);
  peer.inbox_.push(bytes);
  return bytes.size();
}

void MemoryStream::do_close() {
  listening_ = false;
  pair_->hang_up(*this);
}

}  // namespace forager::mocks
