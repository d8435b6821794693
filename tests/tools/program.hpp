#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace forager::tools {

struct ProgramOptions {
  std::string folder;                                              // working directory; empty: the test's own
  std::vector<std::pair<std::string, std::string>> environment{};  // on top of the test's own
  bool closed_stdout = false;  // stdout is a pipe that nobody reads any more
  std::chrono::milliseconds deadline = std::chrono::seconds(30);  // then it is killed
};

struct ProgramResult {
  int exit_code = -1;  // -1: it did not exit by itself
  int signal = 0;      // that ended it; 0: it exited
  bool timed_out = false;
  std::string out;
  std::string err;
};

// The real `forager` as a child process. Output is taken from pipes while waiting, so the child never blocks
// on them. The child cannot outlive the object: it is killed with it. Failing to start is exit code 127.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments, ProgramOptions options = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // Waits until stdout (or stderr) holds the text. False: it ended, or the time was over, without it.
  bool wait_for_out(std::string_view text, std::chrono::milliseconds within);
  bool wait_for_err(std::string_view text, std::chrono::milliseconds within);
  // Waits until condition(so_far()) holds, asking after every piece of output and at least every 10 ms.
  // False: it ended, or the time was over, before that.
  bool wait_until(const std::function<bool(const ProgramResult&)>& condition,
                  std::chrono::milliseconds within);
  // What it has printed up to the last wait.
  [[nodiscard]] const ProgramResult& so_far() const { return result_; }
  void send_signal(int number) const;
  [[nodiscard]] bool running() const { return pid_ > 0; }
  // Waits for the end, at most until the deadline of the options (counted from the start), then kills.
  ProgramResult finish();

 private:
  using Clock = std::chrono::steady_clock;
  void start(const std::vector<std::string>& arguments, const ProgramOptions& options);
  void take_output(std::chrono::milliseconds wait);
  bool reap(bool block);

  pid_t pid_ = -1;
  int out_pipe_ = -1;
  int err_pipe_ = -1;
  Clock::time_point deadline_;
  ProgramResult result_;
};

// Runs it to its end.
ProgramResult run_program(const std::vector<std::string>& arguments, ProgramOptions options = {});

}  // namespace forager::tools
