#include "hal/linux/software_pwm.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "hal/linux/pulse_engine.hpp"
#include "hal/linux/steady_clock.hpp"

namespace forager::hal {
namespace {

constexpr const char* kDevice = "software pwm";
constexpr const char* kMend =
    "give the user \"rtprio 60\" and \"memlock unlimited\" in /etc/security/limits.conf, or the service "
    "LimitRTPRIO=60 and LimitMEMLOCK=infinity";

class ThreadedPwm final : public SoftwarePwm {
 public:
  ThreadedPwm(std::vector<SoftwarePwmLine> lines, const SoftwarePwmConfig& config)
      : lines_(std::move(lines)),
        engine_(kDevice, borrowed(lines_), config.period, config.stale_after),
        clock_(make_steady_clock()) {}
  ~ThreadedPwm() override {
    stop_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();  // within a period; the engine then makes every line inactive
  }
  ThreadedPwm(const ThreadedPwm&) = delete;
  ThreadedPwm& operator=(const ThreadedPwm&) = delete;

  Result<> start(int priority) {
    facts_.memory_locked = ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    const int not_locked = facts_.memory_locked ? 0 : errno;
    feed();
    try {
      thread_ = std::thread([this] { run(); });
    } catch (const std::system_error& error) {
      return fail(ErrorCode::io, kDevice, "open", "there is no more thread for it", "", error.code().value());
    }
    const sched_param wanted{priority};
    const int refused = ::pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &wanted);
    facts_.real_time = refused == 0;
    facts_.text = fmt::format(
        "{}, {}{}",
        refused == 0 ? fmt::format("SCHED_FIFO {}", priority)
                     : fmt::format("no real-time priority ({})", std::strerror(refused)),
        not_locked == 0 ? "memory locked" : fmt::format("memory not locked ({})", std::strerror(not_locked)),
        refused == 0 && not_locked == 0 ? "" : fmt::format(": {}", kMend));
    return {};
  }

  PwmChannel& channel(std::size_t index) override { return engine_.channel(index); }
  void feed() override { engine_.feed(clock_->now()); }
  const Jitter& pulse_jitter() const override { return engine_.pulse_jitter(); }
  const Jitter& start_jitter() const override { return engine_.start_jitter(); }
  std::uint64_t missed_periods() const override { return engine_.missed_periods(); }
  const RealTimeFacts& facts() const override { return facts_; }

 private:
  static std::vector<PulseEngine::Line> borrowed(const std::vector<SoftwarePwmLine>& lines) {
    std::vector<PulseEngine::Line> out;
    out.reserve(lines.size());
    for (const SoftwarePwmLine& line : lines) out.push_back({line.line.get(), line.stale_pulse});
    return out;
  }
  void run() {
    ::prctl(PR_SET_NAME, "forager-pwm");
    ::prctl(PR_SET_TIMERSLACK, 1UL);  // without real-time priority the kernel would add 50 us to every sleep
    while (!stop_.load(std::memory_order_relaxed)) engine_.step(*clock_);
  }
  Result<> do_set_period(Duration period) override { return engine_.set_period(period); }
  [[nodiscard]] Duration do_period() const override { return engine_.period(); }
  [[nodiscard]] std::string_view do_name() const override { return engine_.name(); }

  std::vector<SoftwarePwmLine> lines_;  // before the engine, which borrows them
  PulseEngine engine_;
  std::unique_ptr<Clock> clock_;
  RealTimeFacts facts_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all of them
};

Result<> check(const std::vector<SoftwarePwmLine>& lines, const SoftwarePwmConfig& config) {
  const auto refuse = [](std::string why) {
    return fail(ErrorCode::invalid_argument, kDevice, "open", std::move(why));
  };
  if (lines.empty() || lines.size() > PulseEngine::kMost)
    return refuse(fmt::format("{} lines; 1 to {} are possible", lines.size(), PulseEngine::kMost));
  if (config.period < std::chrono::milliseconds(1)) return refuse("a period of less than 1 ms");
  if (config.priority < 1 || config.priority > 99) return refuse("a priority outside 1 to 99");
  for (const SoftwarePwmLine& line : lines)
    if (line.line == nullptr ||
        (line.stale_pulse && (*line.stale_pulse < Duration::zero() || *line.stale_pulse > config.period)))
      return refuse("a line that is none, or a stale pulse that does not fit into the period");
  return {};
}

}  // namespace

Result<std::unique_ptr<SoftwarePwm>> open_software_pwm(std::vector<SoftwarePwmLine> lines,
                                                       const SoftwarePwmConfig& config) {
  FORAGER_TRY(check(lines, config));
  auto pwm = std::make_unique<ThreadedPwm>(std::move(lines), config);
  FORAGER_TRY(pwm->start(config.priority));
  return pwm;
}

}  // namespace forager::hal
