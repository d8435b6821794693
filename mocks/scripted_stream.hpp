#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "hal/byte_stream.hpp"
#include "mocks/scripted_failure.hpp"

namespace forager::mocks {

// A peer that follows a script: the driver's bytes must come exactly as listed, answers are given in between.
// Anything else is reported, and so is a script with steps left at destruction.
class ScriptedStream final : public hal::ByteStream {
 public:
  explicit ScriptedStream(std::string name, ScriptFailure on_failure = abort_on_script_failure());
  ~ScriptedStream() override;
  ScriptedStream(const ScriptedStream&) = delete;
  ScriptedStream& operator=(const ScriptedStream&) = delete;

  // The next bytes written; the driver may spread them over several writes.
  ScriptedStream& expect(std::string_view bytes);
  // Bytes to read, once everything before was written.
  ScriptedStream& answer(std::string_view bytes);
  // The next call fails with this error, and the stream is closed.
  ScriptedStream& fail(hal::Error error);
  // The next open() is one the script wants (a reconnect). The first open needs no such step.
  ScriptedStream& expect_open();
  // At most this many bytes are taken or given per call from now on.
  void limit_chunk(std::size_t bytes) { chunk_ = bytes; }

  [[nodiscard]] bool done() const { return steps_.empty(); }

 private:
  enum class Kind : std::uint8_t { expect, answer, fail, open };
  struct Step {
    Kind kind;
    std::string bytes;
    hal::Error error;
  };

  hal::Result<> do_open() override;
  hal::Result<hal::StreamState> do_poll() override;
  hal::Result<std::size_t> do_read(std::span<std::byte> into) override;
  hal::Result<std::size_t> do_write(std::span<const std::byte> bytes) override;
  void do_close() override { state_ = hal::StreamState::closed; }
  std::string_view do_name() const override { return name_; }
  hal::Result<> scripted_failure();
  void complain(const std::string& why) { on_failure_(name_ + ": " + why); }

  std::string name_;
  ScriptFailure on_failure_;
  std::deque<Step> steps_;
  std::size_t done_in_step_ = 0;  // bytes of the front step already exchanged
  std::size_t chunk_ = SIZE_MAX;
  hal::StreamState state_ = hal::StreamState::closed;
  bool opened_once_ = false;
};

}  // namespace forager::mocks
