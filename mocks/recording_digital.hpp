#pragma once

#include "hal/digital_in.hpp"
#include "hal/digital_out.hpp"
#include "hal/digital_out_group.hpp"
#include "mocks/recording_fields.hpp"

namespace forager::mocks {

// Lines and what passes them; all borrow the line and the recorder.
//   <level = ok 1          when it has changed
//   <edges = ok 12040000000 1 12050000000 0      nanoseconds and levels
//   set 1 = ok             of a line; of a group one field for each line

class RecordingDigitalIn final : public hal::DigitalIn {
 public:
  RecordingDigitalIn(hal::DigitalIn& line, hal::Recorder& recorder) : line_(&line), recorder_(&recorder) {}

 private:
  hal::Result<bool> do_active() override {
    return last_.take(*recorder_, name(), "<level", line_->active(),
                      [](bool level) { return hal::Fields{hal::field(level)}; });
  }
  [[nodiscard]] std::string_view do_name() const override { return line_->name(); }
  hal::DigitalIn* line_;
  hal::Recorder* recorder_;
  LastAnswer last_;
};

class RecordingEdgeIn final : public hal::EdgeIn {
 public:
  RecordingEdgeIn(hal::EdgeIn& line, hal::Recorder& recorder) : line_(&line), recorder_(&recorder) {}

 private:
  hal::Result<bool> do_active() override {
    return last_.take(*recorder_, name(), "<level", line_->active(),
                      [](bool level) { return hal::Fields{hal::field(level)}; });
  }
  hal::Result<std::size_t> do_edges(std::span<hal::Edge> into) override {
    auto count = line_->edges(into);
    if (count && *count == 0) return count;
    return taken(*recorder_, name(), "<edges", {}, std::move(count), [&](std::size_t edges) {
      hal::Fields fields;
      for (const hal::Edge& edge : into.first(edges)) {
        fields.push_back(hal::field(edge.at.time_since_epoch()));
        fields.push_back(hal::field(edge.active));
      }
      return fields;
    });
  }
  [[nodiscard]] std::string_view do_name() const override { return line_->name(); }
  hal::EdgeIn* line_;
  hal::Recorder* recorder_;
  LastAnswer last_;
};

class RecordingDigitalOut final : public hal::DigitalOut {
 public:
  RecordingDigitalOut(hal::DigitalOut& line, hal::Recorder& recorder) : line_(&line), recorder_(&recorder) {}

 private:
  hal::Result<> do_set(bool active) override {
    return taken(*recorder_, name(), "set", {hal::field(active)}, line_->set(active));
  }
  [[nodiscard]] std::string_view do_name() const override { return line_->name(); }
  hal::DigitalOut* line_;
  hal::Recorder* recorder_;
};

class RecordingDigitalOutGroup final : public hal::DigitalOutGroup {
 public:
  RecordingDigitalOutGroup(hal::DigitalOutGroup& lines, hal::Recorder& recorder)
      : lines_(&lines), recorder_(&recorder) {}

 private:
  hal::Result<> do_set(std::span<const bool> active) override {
    hal::Fields asked;
    for (const bool level : active) asked.push_back(hal::field(level));
    return taken(*recorder_, name(), "set", std::move(asked), lines_->set(active));
  }
  [[nodiscard]] std::size_t do_size() const override { return lines_->size(); }
  [[nodiscard]] std::string_view do_name() const override { return lines_->name(); }
  hal::DigitalOutGroup* lines_;
  hal::Recorder* recorder_;
};

}  // namespace forager::mocks
