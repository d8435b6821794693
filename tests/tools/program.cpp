#include "tests/tools/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include "tests/places.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

struct Pipe {
  int read_end = -1;
  int write_end = -1;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  return {ends[0], ends[1]};
}

// Reads what is there. False at the end of the stream.
bool drain(int descriptor, std::string& into) {
  std::array<char, 65536> buffer{};
  const ssize_t got = read(descriptor, buffer.data(), buffer.size());
  if (got > 0) into.append(buffer.data(), static_cast<std::size_t>(got));
  return got > 0 || (got < 0 && (errno == EINTR || errno == EAGAIN));
}

void close_end(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments, ProgramOptions options)
    : deadline_(Clock::now() + options.deadline) {
  start(arguments, options);
}

Program::~Program() {
  if (running()) {
    kill(pid_, SIGKILL);
    reap(true);
  }
  close_end(out_pipe_);
  close_end(err_pipe_);
}

void Program::start(const std::vector<std::string>& arguments, const ProgramOptions& options) {
  Pipe out = make_pipe();
  Pipe err = make_pipe();
  std::vector<char*> argv{const_cast<char*>(test::program())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("no fork");
  if (pid_ == 0) {
    // A test program may have these ignored or blocked; the child must have what a shell gives it.
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(number, SIG_DFL);
    dup2(out.write_end, STDOUT_FILENO);
    dup2(err.write_end, STDERR_FILENO);
    close(out.read_end);
    for (const auto& [name, value] : options.environment) setenv(name.c_str(), value.c_str(), 1);
    if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(127);
    execv(test::program(), argv.data());
    _exit(127);
  }
  close_end(out.write_end);
  close_end(err.write_end);
  if (options.closed_stdout) close_end(out.read_end);
  out_pipe_ = out.read_end;
  err_pipe_ = err.read_end;
}

void Program::take_output(std::chrono::milliseconds wait) {
  std::array<pollfd, 2> ends{{{out_pipe_, POLLIN, 0}, {err_pipe_, POLLIN, 0}}};
  if (poll(ends.data(), ends.size(), static_cast<int>(wait.count())) <= 0) return;
  if (ends[0].revents != 0 && !drain(out_pipe_, result_.out)) close_end(out_pipe_);
  if (ends[1].revents != 0 && !drain(err_pipe_, result_.err)) close_end(err_pipe_);
}

bool Program::reap(bool block) {
  int status = 0;
  if (waitpid(pid_, &status, block ? 0 : WNOHANG) != pid_) return false;
  pid_ = -1;
  if (WIFEXITED(status)) result_.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result_.signal = WTERMSIG(status);
  return true;
}

bool Program::wait_until(const std::function<bool(const ProgramResult&)>& condition,
                         std::chrono::milliseconds within) {
  const auto until = Clock::now() + within;
  while (!condition(result_)) {
    if ((out_pipe_ < 0 && err_pipe_ < 0) || Clock::now() >= until) return false;
    take_output(10ms);
  }
  return true;
}

bool Program::wait_for_out(std::string_view text, std::chrono::milliseconds within) {
  return wait_until([text](const ProgramResult& it) { return it.out.find(text) != std::string::npos; },
                    within);
}

bool Program::wait_for_err(std::string_view text, std::chrono::milliseconds within) {
  return wait_until([text](const ProgramResult& it) { return it.err.find(text) != std::string::npos; },
                    within);
}

void Program::send_signal(int number) const {
  if (running()) kill(pid_, number);
}

ProgramResult Program::finish() {
  while (running()) {
    const bool open = out_pipe_ >= 0 || err_pipe_ >= 0;
    if (open)
      take_output(20ms);
    else
      usleep(2000);
    if (!open && reap(false)) break;
    if (Clock::now() < deadline_) continue;
    result_.timed_out = true;
    kill(pid_, SIGKILL);
    reap(true);
  }
  return result_;
}

ProgramResult run_program(const std::vector<std::string>& arguments, ProgramOptions options) {
  return Program(arguments, std::move(options)).finish();
}

}  // namespace forager::tools
