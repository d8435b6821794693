#pragma once

#include <string>
#include <vector>

#include "mocks/recording_stream.hpp"
#include "mocks/replay.hpp"

namespace forager::mocks {

// A byte stream as mocks/recording_stream.hpp noted it; `name` is that of the recorded one. Bytes come when
// they came, in as many pieces as the driver has room for.
class ReplayStream final : public hal::ByteStream {
 public:
  ReplayStream(std::string name, Replay& replay) : name_(std::move(name)), replay_(&replay) {}

 private:
  hal::Result<> do_open() override { return nothing_of(replay_->call(name_, "open", {})); }
  hal::Result<hal::StreamState> do_poll() override {
    auto state = replay_->held(name_, "<state");
    if (!state) return hal::fail(std::move(state).error());
    for (const auto known : {hal::StreamState::closed, hal::StreamState::opening, hal::StreamState::open})
      if (state->size() == 1 && state->front() == RecordingStream::name_of(known)) return known;
    return Replay::broken(name_, "<state");
  }
  hal::Result<std::size_t> do_read(std::span<std::byte> into) override {
    if (waiting_.empty()) {
      const auto more = replay_->arrived(name_, "<bytes");
      if (!more) return std::size_t{0};
      if (!*more) return hal::fail(more->error());
      auto bytes = (*more)->size() == 1 ? hal::bytes_in((*more)->front()) : std::nullopt;
      if (!bytes) return Replay::broken(name_, "<bytes");
      waiting_ = *std::move(bytes);
    }
    const std::size_t count = std::min(into.size(), waiting_.size());
    std::copy_n(waiting_.begin(), count, into.begin());
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  hal::Result<std::size_t> do_write(std::span<const std::byte> bytes) override {
    const auto answer = replay_->call(name_, "write", {hal::field(bytes)});
    if (!answer) return hal::fail(answer.error());
    const auto count = answer->size() == 1 ? hal::integer_in(answer->front()) : std::nullopt;
    if (!count || *count < 0 || static_cast<std::size_t>(*count) > bytes.size())
      return Replay::broken(name_, "write");
    return static_cast<std::size_t>(*count);
  }
  void do_close() override { static_cast<void>(replay_->call(name_, "close", {})); }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  std::string name_;
  Replay* replay_;
  std::vector<std::byte> waiting_;
};

}  // namespace forager::mocks
