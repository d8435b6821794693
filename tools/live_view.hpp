#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace forager::tools {

// What a bench command shows while it runs: at a terminal a block of lines that is written over itself,
// elsewhere plain lines, one below the other. On stdout; every line is out before the next call.
class LiveView {
 public:
  // Whether stdout is a terminal that can be written over (not one that says TERM=dumb).
  static bool possible();

  explicit LiveView(bool live) : live_(live) {}
  ~LiveView() { close(); }
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  [[nodiscard]] bool live() const { return live_; }
  // Replaces the block. Control characters in the lines become blanks.
  void show(const std::vector<std::string>& lines);
  // A line that stays, above the block.
  void say(const std::string& line);
  // Leaves the block standing; what follows goes below it.
  void close() { shown_ = 0; }

 private:
  void wipe();

  bool live_;
  std::size_t shown_ = 0;  // lines of the block on the screen
  std::vector<std::string> block_;
};

}  // namespace forager::tools
