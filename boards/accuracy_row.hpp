#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace forager::boards {

// One way to compute something: what it costs and how far it is from the exact answer. Errors are measured
// when the row is made; its time by the outermost loop, which has the clock and runs the rows of one name in
// turn, so that whatever else the machine does meets them alike.
struct AccuracyRow {
  std::string name;            // the question: "detection, 70 degrees". Rows of one name are comparable
  std::string variant;         // the way: "f32, cut 1e-9, grid"
  double time_ns = 0.0;        // for one item; filled in from `work`
  double max_abs_error = 0.0;  // largest |answer - reference|, in the unit the name or the reference says
  double max_rel_error = 0.0;  // largest |answer - reference| / |reference|, where the reference is not tiny
  std::string reference;       // what the errors are against, never another approximation
  std::uint64_t asked = 0;     // answers counted; 0: failures were not
  std::uint64_t failures = 0;  // of them no number (left out of the errors) or worse than the topic allows
  std::function<void()> work = {};  // does `items` items; empty: nothing to time
  double items = 1.0;
};

struct AccuracyOptions {
  std::uint64_t seed = 1;
  double effort = 1.0;  // 1: what the published table shows; less: fewer samples, for tests
};

// Rows of every topic, in a fixed order. To add one: boards/accuracy_<topic>.cpp with
// std::vector<AccuracyRow> accuracy_<topic>(const AccuracyOptions&), declared here and named in
// boards/accuracy_row.cpp.
[[nodiscard]] std::vector<AccuracyRow> accuracy_rows(const AccuracyOptions& options);

[[nodiscard]] std::vector<AccuracyRow> accuracy_air(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyRow> accuracy_detection(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyRow> accuracy_guard(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyRow> accuracy_planner(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyRow> accuracy_relative_pose(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyRow> accuracy_sweep(const AccuracyOptions& options);

}  // namespace forager::boards
