#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <memory>

#include "hal/error.hpp"
#include "hal/linux/file_descriptor.hpp"
#include "hal/time.hpp"

namespace forager::hal {

// Why the watched process is no longer trusted.
enum class GuardCause : std::uint8_t {
  died,    // killed, crashed, or ended without standing the guard down
  silent,  // it hung: no feed() for the time-out; it has been killed
  asked,   // it lives, and could not make things safe by itself
};

// A second process that watches the one that moves things, and acts when that one no longer can.
//
//   watching --arm()--> armed --silence, death--> acts, ends
//   watching --death--> ends: nothing had moved yet
//   armed --hand_over()--> acts, ends
//   any --stand_down(), destructor--> ends
//
// The guard is a fork of the caller with a session of its own: Ctrl-C, SIGTERM and SIGHUP do not reach it. It
// sees a death by the end of a socket, at once and on every kernel; a hang by its own clock. A hung process
// is killed before anything is touched: it could wake up and go on, and it still holds its GPIO lines. Real
// time priority and locked memory are taken where the system allows it.
//
// What it cannot outlive: the machine, a kill of the whole control group (systemd's ExecStopPost is for
// that), and a SIGKILL of its own; that one feed() reports.
class ProcessGuard {
 public:
  // Runs in the guard. It may open whatever it needs: nothing but stdin, stdout and stderr is shared.
  using Act = std::function<void(GuardCause cause)>;

  // Forks, and waits until the guard watches. To be called before threads are started and devices are opened.
  // `timeout`: silence for longer than this, once armed, is a hang. Errors: invalid_argument (timeout not
  // positive), io (no more processes, or it did not come up).
  [[nodiscard]] static Result<std::unique_ptr<ProcessGuard>> start(Duration timeout, const Act& act);
  ~ProcessGuard();  // stands down
  ProcessGuard(const ProcessGuard&) = delete;
  ProcessGuard& operator=(const ProcessGuard&) = delete;

  // From here on silence and death count. Feeds, too. Errors: as feed().
  [[nodiscard]] Result<> arm() { return tell('a'); }
  // Says that the caller lives; one system call. Errors: disconnected (the guard is gone: nobody would make
  // things safe now).
  [[nodiscard]] Result<> feed() { return tell('f'); }
  // The caller has made everything safe by itself. Waits for the guard's end, which is a matter of
  // microseconds, for at most a second.
  void stand_down() noexcept;

  // The caller could not make everything safe: the guard is to do it, as if the caller had died. What the
  // caller holds it must have let go before. Waits for the guard's end, for at most ten seconds.
  void hand_over() noexcept;

  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  ProcessGuard(FileDescriptor link, pid_t pid) : link_(std::move(link)), pid_(pid) {}
  [[nodiscard]] Result<> tell(char word);
  void part(char word, int wait_ms) noexcept;

  FileDescriptor link_;
  pid_t pid_;
};

}  // namespace forager::hal
