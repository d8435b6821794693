#pragma once

#include <deque>
#include <string>

#include "hal/digital_in.hpp"
#include "hal/digital_out.hpp"
#include "hal/digital_out_group.hpp"
#include "mocks/recording_fields.hpp"
#include "mocks/replay.hpp"

namespace forager::mocks {

// Lines as mocks/recording_digital.hpp noted them; `name` is that of the recorded line.

class ReplayEdgeIn final : public hal::EdgeIn {
 public:
  ReplayEdgeIn(std::string name, Replay& replay) : name_(std::move(name)), replay_(&replay) {}

 private:
  hal::Result<bool> do_active() override {
    auto level = replay_->held(name_, "<level");
    if (!level) return hal::fail(std::move(level).error());
    if (level->size() != 1) return Replay::broken(name_, "<level");
    return level->front() == "1";
  }
  hal::Result<std::size_t> do_edges(std::span<hal::Edge> into) override {
    if (const auto more = replay_->arrived(name_, "<edges")) {
      if (!*more) return hal::fail(more->error());
      for (std::size_t i = 0; i + 1 < (*more)->size(); i += 2) {
        const auto at = hal::integer_in((**more)[i]);
        if (!at) return Replay::broken(name_, "<edges");
        waiting_.push_back({replay_->moved(hal::Instant(hal::Duration(*at))), (**more)[i + 1] == "1"});
      }
    }
    const std::size_t count = std::min(into.size(), waiting_.size());
    std::copy_n(waiting_.begin(), count, into.begin());
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  std::string name_;
  Replay* replay_;
  std::deque<hal::Edge> waiting_;
};
// A line without edges.
using ReplayDigitalIn = ReplayEdgeIn;

class ReplayDigitalOut final : public hal::DigitalOut {
 public:
  ReplayDigitalOut(std::string name, Replay& replay) : name_(std::move(name)), replay_(&replay) {}

 private:
  hal::Result<> do_set(bool active) override {
    return nothing_of(replay_->call(name_, "set", {hal::field(active)}));
  }
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  std::string name_;
  Replay* replay_;
};

class ReplayDigitalOutGroup final : public hal::DigitalOutGroup {
 public:
  ReplayDigitalOutGroup(std::string name, std::size_t size, Replay& replay)
      : name_(std::move(name)), size_(size), replay_(&replay) {}

 private:
  hal::Result<> do_set(std::span<const bool> active) override {
    hal::Fields asked;
    for (const bool level : active) asked.push_back(hal::field(level));
    return nothing_of(replay_->call(name_, "set", asked));
  }
  [[nodiscard]] std::size_t do_size() const override { return size_; }
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  std::string name_;
  std::size_t size_;
  Replay* replay_;
};

}  // namespace forager::mocks
