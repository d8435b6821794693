#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>

#include "hal/recording.hpp"
#include "mocks/replay.hpp"
#include "mocks/virtual_clock.hpp"

namespace forager::mocks::test {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

inline const hal::Error kBroken{hal::ErrorCode::io, "device", "call", "injected", "mend it", 5};

// What a driver saw, as text: two equal ones saw the same, errors and their words included.
class Seen {
 public:
  void add(const hal::Result<>& answer) { text_ += (answer ? "done" : hal::describe(answer.error())) + "\n"; }
  template <class Value>
  void add(const hal::Result<Value>& answer) {
    text_ += (answer ? fmt::format("{}", *answer) : hal::describe(answer.error())) + "\n";
  }
  void add(std::string_view text) { text_ += std::string(text) + "\n"; }
  void add(std::span<const std::byte> bytes) { add(hal::field(bytes)); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// `driver` drives a device by the clock it is given; afterwards the same driver, much later, gets the
// recording.
class ReplayTest : public testing::Test {
 protected:
  Replay& replay() {
    auto records = hal::parse_recording(text_);
    EXPECT_TRUE(records) << (records ? "" : describe(records.error()));
    return replay_.emplace(*std::move(records), later_);
  }
  void expect_same() {
    EXPECT_EQ(live_.text(), replayed_.text());
    EXPECT_EQ(0U, replay_->calls_left());
    EXPECT_THAT(live_.text(), HasSubstr("injected")) << "an error is part of it";
  }
  VirtualClock clock_{hal::Instant(5s)};
  VirtualClock later_{hal::Instant(1000s)};
  std::string text_;
  hal::Recorder recorder_{clock_, [this](std::string_view line) { text_ += line; }};
  std::optional<Replay> replay_;
  Seen live_;
  Seen replayed_;
};

}  // namespace forager::mocks::test
