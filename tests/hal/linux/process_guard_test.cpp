#include "hal/linux/process_guard.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

namespace forager::hal {
namespace {

using namespace std::chrono_literals;

constexpr Duration kNever = 1h;  // a time-out no loaded machine reaches

// A process that lives under a guard. What the guard does in the end is one letter in a pipe: 'd' the process
// died, 's' it was silent.
class GuardedProcess {
 public:
  // `life` runs in the process; what it writes into the pipe comes before the guard's letter.
  GuardedProcess(Duration timeout, const std::function<void(ProcessGuard&, int pipe)>& life) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    pid_ = ::fork();
    if (pid_ == 0) {
      ::close(ends[0]);
      const int pipe = ends[1];
      const auto guard = ProcessGuard::start(timeout, [pipe](GuardCause cause) {
        static_cast<void>(!::write(pipe,
                                   cause == GuardCause::died    ? "d"
                                   : cause == GuardCause::asked ? "k"
                                                                : "s",
                                   1));
      });
      if (guard) life(**guard, pipe);
      ::_exit(guard ? 0 : 1);  // no destructor: the guard is not stood down
    }
    ::close(ends[1]);
    read_end_ = ends[0];
  }
  ~GuardedProcess() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(read_end_);
  }
  GuardedProcess(const GuardedProcess&) = delete;
  GuardedProcess& operator=(const GuardedProcess&) = delete;

  void send(int signal) const { ::kill(pid_, signal); }
  // The next `size` bytes of the pipe; less at its end, that is when process and guard are both gone.
  [[nodiscard]] std::string read(std::size_t size) const {
    std::string text;
    while (text.size() < size) {
      pollfd end{read_end_, POLLIN, 0};
      char byte = 0;
      if (::poll(&end, 1, 20000) != 1 || ::read(read_end_, &byte, 1) != 1) break;
      text += byte;
    }
    return text;
  }
  // The signal that ended it; 0: none.
  [[nodiscard]] int wait_for_end() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

 private:
  pid_t pid_ = -1;
  int read_end_ = -1;
};

void say(int pipe, char letter) { static_cast<void>(!::write(pipe, &letter, 1)); }

void wait_for_a_signal() {
  while (true) ::pause();
}

TEST(ProcessGuard, ActsWhenTheProcessIsKilled) {
  GuardedProcess process(kNever, [](ProcessGuard& guard, int pipe) {
    if (guard.arm()) say(pipe, 'a');
    wait_for_a_signal();
  });
  ASSERT_EQ(process.read(1), "a");
  process.send(SIGKILL);
  EXPECT_EQ(process.read(9), "d");
}

TEST(ProcessGuard, ActsWhenTheProcessEndsWithoutStandingItDown) {
  GuardedProcess process(kNever, [](ProcessGuard& guard, int) { static_cast<void>(guard.arm()); });
  EXPECT_EQ(process.read(9), "d");
}

// A process that hangs could wake up and go on: it has to be dead before anything is touched.
TEST(ProcessGuard, KillsAProcessThatHangsAndThenActs) {
  GuardedProcess process(50ms, [](ProcessGuard& guard, int) {
    static_cast<void>(guard.arm());
    ::raise(SIGSTOP);
  });
  EXPECT_EQ(process.read(9), "s");
  EXPECT_EQ(process.wait_for_end(), SIGKILL);
}

TEST(ProcessGuard, BeforeItIsArmedNothingHasMovedAndNothingIsDone) {
  GuardedProcess silent(50ms, [](ProcessGuard& guard, int pipe) {
    static_cast<void>(guard.feed());
    std::this_thread::sleep_for(200ms);
    say(pipe, 'l');
  });
  EXPECT_EQ(silent.read(9), "l");
  GuardedProcess killed(kNever, [](ProcessGuard&, int pipe) {
    say(pipe, 'a');
    wait_for_a_signal();
  });
  ASSERT_EQ(killed.read(1), "a");
  killed.send(SIGKILL);
  EXPECT_EQ(killed.read(9), "");
}

TEST(ProcessGuard, StoodDownItGoesHome) {
  GuardedProcess process(50ms, [](ProcessGuard& guard, int pipe) {
    static_cast<void>(guard.arm());
    guard.stand_down();
    std::this_thread::sleep_for(200ms);
    say(pipe, ::kill(guard.pid(), 0) != 0 ? 'g' : '!');
  });
  EXPECT_EQ(process.read(9), "g");
}

// The terminal's Ctrl-C and the service manager's SIGTERM go to every process of a group.
TEST(ProcessGuard, AskedToItActsWhileTheProcessLivesAndOnlyWhatWasArmed) {
  for (const bool armed : {true, false}) {
    GuardedProcess process(kNever, [armed](ProcessGuard& guard, int pipe) {
      if (armed) static_cast<void>(guard.arm());
      guard.hand_over();  // waits until it is done
      say(pipe, 'e');
    });
    EXPECT_EQ(process.read(9), armed ? "ke" : "e");
  }
}

TEST(ProcessGuard, SignalsThatEndProgramsDoNotEndIt) {
  GuardedProcess process(kNever, [](ProcessGuard& guard, int pipe) {
    const bool armed = guard.arm().has_value();
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGTSTP}) ::kill(guard.pid(), number);
    say(pipe, armed ? 'a' : '!');
    wait_for_a_signal();
  });
  ASSERT_EQ(process.read(1), "a");
  process.send(SIGKILL);
  EXPECT_EQ(process.read(9), "d");
}

TEST(ProcessGuard, TheProcessLearnsThatItsGuardIsGone) {
  GuardedProcess process(kNever, [](ProcessGuard& guard, int pipe) {
    static_cast<void>(guard.arm());
    ::kill(guard.pid(), SIGKILL);
    ::waitpid(guard.pid(), nullptr, 0);
    const auto fed = guard.feed();
    say(pipe, !fed && fed.error().code == ErrorCode::disconnected ? 'g' : '!');
  });
  EXPECT_EQ(process.read(9), "g");
}

TEST(ProcessGuard, RefusesATimeoutThatIsNone) {
  const auto guard = ProcessGuard::start(0ms, [](GuardCause) {});
  ASSERT_FALSE(guard);
  EXPECT_EQ(guard.error().code, ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace forager::hal
