#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <span>
#include <utility>
#include <vector>

namespace forager::mocks {

// Input reports of an emulated HID device that the host has not fetched yet.
class ReportQueue {
 public:
  void push(std::span<const std::byte> report) { reports_.emplace_back(report.begin(), report.end()); }
  void clear() { reports_.clear(); }

  // The oldest, as much of it as `into` holds; its size, 0 if there is none.
  std::size_t take(std::span<std::byte> into) {
    if (reports_.empty()) return 0;
    const std::vector<std::byte> report = std::move(reports_.front());
    reports_.pop_front();
    const std::size_t count = std::min(into.size(), report.size());
    std::copy_n(report.begin(), count, into.begin());
    return count;
  }

 private:
  std::deque<std::vector<std::byte>> reports_;
};

}  // namespace forager::mocks
