#include "mocks/scripted_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace forager::mocks {
namespace {

using hal::ErrorCode;
using hal::StreamState;

std::string hex(std::string_view bytes) {
  std::string out;
  for (const char c : bytes) fmt::format_to(std::back_inserter(out), "{:02x}", static_cast<unsigned char>(c));
  return out;
}

}  // namespace

ScriptedStream::ScriptedStream(std::string name, ScriptFailure on_failure)
    : name_(std::move(name)), on_failure_(std::move(on_failure)) {}

ScriptedStream::~ScriptedStream() {
  if (!steps_.empty()) complain(fmt::format("{} steps of the script were never reached", steps_.size()));
}

ScriptedStream& ScriptedStream::expect(std::string_view bytes) {
  if (!bytes.empty()) steps_.push_back({Kind::expect, std::string(bytes), {}});
  return *this;
}

ScriptedStream& ScriptedStream::answer(std::string_view bytes) {
  if (!bytes.empty()) steps_.push_back({Kind::answer, std::string(bytes), {}});
  return *this;
}

ScriptedStream& ScriptedStream::fail(hal::Error error) {
  steps_.push_back({Kind::fail, {}, std::move(error)});
  return *this;
}

ScriptedStream& ScriptedStream::expect_open() {
  steps_.push_back({Kind::open, {}, {}});
  return *this;
}

hal::Result<> ScriptedStream::scripted_failure() {
  if (steps_.empty() || steps_.front().kind != Kind::fail) return {};
  hal::Error error = std::move(steps_.front().error);
  steps_.pop_front();
  state_ = StreamState::closed;
  return hal::fail(std::move(error));
}

hal::Result<> ScriptedStream::do_open() {
  if (state_ != StreamState::closed)
    return hal::fail(ErrorCode::invalid_state, name_, "open", "the stream is open already");
  FORAGER_TRY(scripted_failure());
  if (!steps_.empty() && steps_.front().kind == Kind::open)
    steps_.pop_front();
  else if (opened_once_)
    complain("opened again, which the script does not say");
  opened_once_ = true;
  state_ = StreamState::opening;
  return {};
}

hal::Result<StreamState> ScriptedStream::do_poll() {
  if (state_ != StreamState::opening) return state_;
  FORAGER_TRY(scripted_failure());
  state_ = StreamState::open;
  return state_;
}

hal::Result<std::size_t> ScriptedStream::do_read(std::span<std::byte> into) {
  if (state_ != StreamState::open)
    return hal::fail(ErrorCode::invalid_state, name_, "read", "the stream is not open");
  FORAGER_TRY(scripted_failure());
  if (steps_.empty() || steps_.front().kind != Kind::answer) return std::size_t{0};
  const std::string& bytes = steps_.front().bytes;
  const std::size_t count = std::min({into.size(), bytes.size() - done_in_step_, chunk_});
  std::memcpy(into.data(), bytes.data() + done_in_step_, count);
  done_in_step_ += count;
  if (done_in_step_ == bytes.size()) {
    steps_.pop_front();
    done_in_step_ = 0;
  }
  return count;
}

hal::Result<std::size_t> ScriptedStream::do_write(std::span<const std::byte> bytes) {
  if (state_ != StreamState::open)
    return hal::fail(ErrorCode::invalid_state, name_, "write", "the stream is not open");
  FORAGER_TRY(scripted_failure());
  const std::string_view got{reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), chunk_)};
  if (steps_.empty() || steps_.front().kind != Kind::expect) {
    complain("unexpected write of " + hex(got));
    return got.size();
  }
  const std::string_view wanted = std::string_view(steps_.front().bytes).substr(done_in_step_);
  const std::size_t count = std::min(got.size(), wanted.size());
  if (got.substr(0, count) != wanted.substr(0, count)) {
    complain(fmt::format("wrote {} where the script wants {}", hex(got), hex(wanted)));
    return got.size();
  }
  done_in_step_ += count;
  if (count == wanted.size()) {
    steps_.pop_front();
    done_in_step_ = 0;
  }
  return count;
}

}  // namespace forager::mocks
