#include "tools/live_view.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

// A longer line would wrap, and the cursor's way back up be miscounted.
std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

bool LiveView::possible() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDOUT_FILENO) != 0 && (terminal == nullptr || std::string_view(terminal) != "dumb");
}

void LiveView::wipe() {
  if (shown_ > 0) fmt::print("\x1b[{}A\r\x1b[J", shown_);
  shown_ = 0;
}

void LiveView::show(const std::vector<std::string>& lines) {
  if (live_) wipe();
  const std::size_t width = live_ ? terminal_width() : std::string::npos;
  for (const std::string& line : lines) fmt::print("{}\n", one_line(line).substr(0, width));
  std::fflush(stdout);
  if (!live_) return;
  shown_ = lines.size();
  block_ = lines;
}

void LiveView::say(const std::string& line) {
  const bool again = live_ && shown_ > 0;
  if (again) wipe();
  fmt::print("{}\n", one_line(line));
  std::fflush(stdout);
  if (again) show(block_);
}

}  // namespace forager::tools
