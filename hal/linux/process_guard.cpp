#include "hal/linux/process_guard.hpp"

#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <exception>
#include <optional>

namespace forager::hal {
namespace {

using namespace std::chrono_literals;

constexpr char kReady = 'r';
constexpr char kArm = 'a';
constexpr char kBye = 'b';
constexpr char kHandOver = 'h';
constexpr Duration kDying = 200ms;   // for a killed process to let go of what it holds
constexpr Duration kSettling = 10s;  // of a guard on a machine that is out of breath
constexpr int kPriority = 60;        // above the threads that make pulses

Duration monotonic() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

// Whether there is something to read, or the end, within the time.
bool readable(int fd, std::optional<Duration> within) {
  pollfd link{fd, POLLIN, 0};
  // Rounded up: a time-out that ends a fraction early would find the deadline still ahead, and spin.
  const int ms = within ? static_cast<int>(std::max<std::int64_t>(0, (*within + 999'999ns) / 1ms)) : -1;
  int answer = 0;
  while ((answer = ::poll(&link, 1, ms)) < 0 && errno == EINTR) {
  }
  return answer > 0;
}

// The guard's own life, in the forked process.
class Watch {
 public:
  Watch(int link, pid_t watched, Duration timeout) : link_(link), watched_(watched), timeout_(timeout) {}

  // Nothing: it may go home.
  std::optional<GuardCause> run() {
    Duration heard = monotonic();
    while (true) {
      const Duration left = heard + timeout_ - monotonic();
      if (!readable(link_, armed_ ? std::optional(left) : std::nullopt)) {
        if (heard + timeout_ > monotonic()) continue;
        kill_watched();
        return GuardCause::silent;
      }
      char word = 0;
      const ssize_t got = ::recv(link_, &word, 1, 0);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return armed_ ? std::optional(GuardCause::died) : std::nullopt;
      if (word == kBye) return std::nullopt;
      if (word == kHandOver) return armed_ ? std::optional(GuardCause::asked) : std::nullopt;
      armed_ = armed_ || word == kArm;
      heard = monotonic();
    }
  }

 private:
  // While it is our parent its number cannot have been given to another process.
  void kill_watched() const {
    if (::getppid() == watched_) ::kill(watched_, SIGKILL);
    std::array<char, 16> rest{};
    for (const Duration end = monotonic() + kDying; monotonic() < end;)  // until its end of the link closes
      if (readable(link_, end - monotonic()) && ::recv(link_, rest.data(), rest.size(), 0) <= 0) return;
  }

  int link_;
  pid_t watched_;
  Duration timeout_;
  bool armed_ = false;
};

// What would end or delay a guard is kept away from it; what the system does not allow is done without.
void settle_in() {
  ::setsid();
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT, SIGTSTP}) std::signal(number, SIG_IGN);
  ::prctl(PR_SET_NAME, "forager-guard");
  ::mlockall(MCL_CURRENT | MCL_FUTURE);
  const sched_param priority{kPriority};
  ::sched_setscheduler(0, SCHED_FIFO, &priority);
}

[[noreturn]] void be_the_guard(int link, pid_t watched, Duration timeout, const ProcessGuard::Act& act) {
  settle_in();
  static_cast<void>(::send(link, &kReady, 1, MSG_NOSIGNAL));
  try {
    if (const auto cause = Watch(link, watched, timeout).run()) act(*cause);
  } catch (const std::exception&) {
    ::_exit(1);
  }
  ::_exit(0);  // what is in the buffers of stdout is the caller's
}

}  // namespace

Result<std::unique_ptr<ProcessGuard>> ProcessGuard::start(Duration timeout, const Act& act) {
  constexpr const char* kDevice = "guard process";
  if (timeout <= Duration::zero())
    return fail(ErrorCode::invalid_argument, kDevice, "start", "its time-out is not positive");
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return fail(ErrorCode::io, kDevice, "start", "there is no more socket for it", "", errno);
  FileDescriptor ours(ends[0]);
  FileDescriptor its(ends[1]);
  const pid_t self = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) return fail(ErrorCode::io, kDevice, "start", "there is no more process for it", "", errno);
  if (child == 0) {
    ours.reset();
    be_the_guard(its.get(), self, timeout, act);
  }
  its.reset();
  // Until it has settled in, a signal to the whole group could end it.
  std::unique_ptr<ProcessGuard> guard(new ProcessGuard(std::move(ours), child));
  char word = 0;
  if (!readable(guard->link_.get(), kSettling) || ::recv(guard->link_.get(), &word, 1, 0) != 1)
    return fail(ErrorCode::io, kDevice, "start", "it did not come up");
  return guard;
}

ProcessGuard::~ProcessGuard() { stand_down(); }

Result<> ProcessGuard::tell(char word) {
  // A guard that does not read is as bad as none, and no reason to wait for it.
  if (::send(link_.get(), &word, 1, MSG_NOSIGNAL | MSG_DONTWAIT) == 1) return {};
  return fail(ErrorCode::disconnected, "guard process", "feed",
              "it is gone: nobody would lock the brakes if this program died",
              "See who killed it: journalctl -k", errno);
}

void ProcessGuard::stand_down() noexcept { part(kBye, 1000); }

void ProcessGuard::hand_over() noexcept { part(kHandOver, 10'000); }

void ProcessGuard::part(char word, int wait_ms) noexcept {
  if (!link_.valid()) return;
  static_cast<void>(::send(link_.get(), &word, 1, MSG_NOSIGNAL | MSG_DONTWAIT));
  // Its end of the link closes when it goes.
  pollfd end{link_.get(), POLLIN, 0};
  ::poll(&end, 1, wait_ms);
  link_.reset();
  ::waitpid(pid_, nullptr, end.revents != 0 ? 0 : WNOHANG);
}

}  // namespace forager::hal
