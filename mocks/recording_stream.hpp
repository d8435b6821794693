#pragma once

#include "hal/byte_stream.hpp"
#include "mocks/recording_fields.hpp"

namespace forager::mocks {

// A byte stream; borrows it.
//   open = ok
//   <state = ok open          closed, opening or open, when it has changed
//   <bytes = ok fd0900        what a read gave; nothing is no record
//   write 0102 = ok 2         offered; how many were taken
//   close = ok
class RecordingStream final : public hal::ByteStream {
 public:
  RecordingStream(hal::ByteStream& stream, hal::Recorder& recorder)
      : stream_(&stream), recorder_(&recorder) {}

  static constexpr std::string_view name_of(hal::StreamState state) {
    return state == hal::StreamState::open      ? "open"
           : state == hal::StreamState::opening ? "opening"
                                                : "closed";
  }

 private:
  hal::Result<> do_open() override { return taken(*recorder_, name(), "open", {}, stream_->open()); }
  hal::Result<hal::StreamState> do_poll() override {
    return state_.take(*recorder_, name(), "<state", stream_->poll(),
                       [](hal::StreamState state) { return hal::Fields{std::string(name_of(state))}; });
  }
  hal::Result<std::size_t> do_read(std::span<std::byte> into) override {
    auto count = stream_->read(into);
    if (count && *count == 0) return count;
    return taken(*recorder_, name(), "<bytes", {}, std::move(count), [&](std::size_t size) {
      return hal::Fields{hal::field(std::span<const std::byte>(into.first(size)))};
    });
  }
  hal::Result<std::size_t> do_write(std::span<const std::byte> bytes) override {
    return taken(*recorder_, name(), "write", {hal::field(bytes)}, stream_->write(bytes),
                 [](std::size_t size) { return hal::Fields{hal::field(size)}; });
  }
  void do_close() override {
    stream_->close();
    recorder_->take(name(), "close", {}, hal::Fields{});
  }
  [[nodiscard]] std::string_view do_name() const override { return stream_->name(); }

  hal::ByteStream* stream_;
  hal::Recorder* recorder_;
  LastAnswer state_;
};

}  // namespace forager::mocks
