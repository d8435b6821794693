#include "hal/linux/serial_port.hpp"

// <termios.h> knows the fixed rates only, and cannot be included beside the kernel's own definitions.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <utility>

#include "hal/linux/device_holder.hpp"

namespace forager::hal {
namespace {

constexpr Duration kPause = std::chrono::milliseconds(20);  // between two tries while udev is at work
constexpr tcflag_t kShape = CSIZE | PARENB | PARODD | CSTOPB | CRTSCTS;

tcflag_t shape_of(const SerialSettings& line) {
  constexpr tcflag_t kSizes[] = {CS5, CS6, CS7, CS8};
  tcflag_t flags = kSizes[line.data_bits - 5];
  if (line.parity != Parity::none) flags |= PARENB;
  if (line.parity == Parity::odd) flags |= PARODD;
  if (line.stop_bits == 2) flags |= CSTOPB;
  if (line.flow == FlowControl::hardware) flags |= CRTSCTS;
  return flags;
}

SerialSettings settings_of(const termios2& state) {
  SerialSettings line;
  line.baud = state.c_ospeed;
  line.data_bits = static_cast<std::uint8_t>(5 + (state.c_cflag & CSIZE) / CS6);
  if ((state.c_cflag & PARENB) != 0) line.parity = (state.c_cflag & PARODD) != 0 ? Parity::odd : Parity::even;
  line.stop_bits = (state.c_cflag & CSTOPB) != 0 ? 2 : 1;
  if ((state.c_cflag & CRTSCTS) != 0) line.flow = FlowControl::hardware;
  return line;
}

// Raw: every byte as it comes. One byte is enough for a read (VMIN 1), so that "nothing there" is EAGAIN and
// an answer of 0 bytes means that the port hung up. DTR stays as it is at close: some boards reset on it.
void make_raw(termios2& state, const SerialSettings& line) {
  state.c_iflag = IGNBRK | IGNPAR;
  if (line.parity != Parity::none) state.c_iflag |= INPCK;
  state.c_oflag = 0;
  state.c_lflag = 0;
  state.c_cflag = shape_of(line) | CREAD | CLOCAL | BOTHER;
  state.c_ispeed = line.baud;
  state.c_ospeed = line.baud;
  state.c_cc[VMIN] = 1;
  state.c_cc[VTIME] = 0;
}

std::string_view mend_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::permission:
      return "Join the group dialout (sudo adduser $USER dialout) and log in again; "
             "for other kinds of adapters install boards/99-forager.rules into /etc/udev/rules.d";
    case ErrorCode::not_present:
      return "Check the cable and the name; see what there is: ls -l /dev/serial/by-id";
    case ErrorCode::busy:
      return "Stop that program; ModemManager lets go after: sudo systemctl stop ModemManager";
    case ErrorCode::disconnected:
      return "Plug the adapter in again, and check its cable and its power";
    default:
      return {};
  }
}

std::string_view detail_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::permission:
      return "the operating system forbids it";
    case ErrorCode::not_present:
      return "there is no such port";
    case ErrorCode::disconnected:
      return "the adapter was unplugged";
    case ErrorCode::unsupported:
      return "this is no serial port";
    default:
      return "the port failed";
  }
}

class Port final : public SerialPort {
 public:
  Port(SerialPortConfig config, const Clock& clock, Kernel& kernel)
      : config_(std::move(config)),
        clock_(&clock),
        kernel_(&kernel),
        name_("serial " + config_.device),
        line_(config_.line) {}
  ~Port() override { let_go(); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  [[nodiscard]] SerialSettings line() const override { return line_; }

 private:
  Result<> do_open() override {
    if (state_ != StreamState::closed)
      return fail(ErrorCode::invalid_state, name_, "open", "the stream is not closed");
    if (config_.device.empty())
      return fail(ErrorCode::invalid_argument, name_, "open", "the name of a port is needed");
    FORAGER_TRY(check(config_.line, name_));
    settled_ = Deadline(clock_->now(), config_.settle);
    return attempt();
  }

  Result<StreamState> do_poll() override {
    if (state_ == StreamState::opening && pause_.expired(clock_->now())) FORAGER_TRY(attempt());
    return state_;
  }

  Result<> attempt();
  Result<> prepare();
  Result<> take_for_us_alone();
  Result<> set_line();
  Failure failure(const char* operation, long answer);
  Failure busy();

  Result<std::size_t> do_read(std::span<std::byte> into) override {
    if (state_ != StreamState::open) return not_open("read");
    if (into.empty()) return std::size_t{0};
    const long got = kernel_->read(fd_, {reinterpret_cast<char*>(into.data()), into.size()});
    if (got > 0) return static_cast<std::size_t>(got);
    if (got == -EAGAIN || got == -EINTR) return std::size_t{0};
    return failure("read", got == 0 ? -EIO : got);
  }

  Result<std::size_t> do_write(std::span<const std::byte> bytes) override {
    if (state_ != StreamState::open) return not_open("write");
    if (bytes.empty()) return std::size_t{0};
    const long put = kernel_->write(fd_, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    if (put >= 0) return static_cast<std::size_t>(put);
    if (put == -EAGAIN || put == -EINTR) return std::size_t{0};
    return failure("write", put);
  }

  Failure not_open(const char* operation) const {
    return fail(ErrorCode::invalid_state, name_, operation, "the stream is not open");
  }

  void do_close() override { let_go(); }
  void let_go() {
    if (fd_ >= 0) {
      if (config_.line.flow == FlowControl::hardware) (void)ioctl_with(TCFLSH, TCOFLUSH);
      (void)kernel_->ioctl(fd_, TIOCNXCL, nullptr);  // outlives us where somebody else has the port open, too
      kernel_->close(std::exchange(fd_, -1));
    }
    state_ = StreamState::closed;
    line_ = config_.line;
  }
  // The argument itself is the number.
  int ioctl_with(unsigned long request, std::intptr_t number) {
    return kernel_->ioctl(fd_, request, std::bit_cast<void*>(number));
  }

  std::string_view do_name() const override { return name_; }

  SerialPortConfig config_;
  const Clock* clock_;
  Kernel* kernel_;
  std::string name_;
  SerialSettings line_;
  int fd_ = -1;
  StreamState state_ = StreamState::closed;
  Deadline settled_;
  Deadline pause_;
};

Result<> Port::attempt() {
  const int fd = kernel_->open(config_.device, O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (fd == -EBUSY) return busy();
  if (fd == -EACCES && !settled_.expired(clock_->now())) {
    state_ = StreamState::opening;
    pause_ = Deadline(clock_->now(), kPause);
    return {};
  }
  if (fd < 0) return failure("open", fd);
  fd_ = fd;
  auto prepared = prepare();
  if (!prepared) let_go();
  return prepared;
}

Result<> Port::prepare() {
  FORAGER_TRY(take_for_us_alone());
  FORAGER_TRY(set_line());
  if (const int answer = ioctl_with(TCFLSH, TCIOFLUSH); answer < 0) return failure("open", answer);
  state_ = StreamState::open;
  return {};
}

Result<> Port::take_for_us_alone() {
  if (const int answer = kernel_->lock(fd_); answer < 0) {
    if (answer != -EAGAIN) return failure("lock", answer);
    kernel_->close(std::exchange(fd_, -1));  // or it would be found as a holder, too
    return busy();
  }
  const int answer = kernel_->ioctl(fd_, TIOCEXCL, nullptr);
  return answer < 0 ? Result<>(failure("open", answer)) : Result<>();
}

Result<> Port::set_line() {
  termios2 state{};
  if (const int answer = kernel_->ioctl(fd_, TCGETS2, &state); answer < 0) return failure("open", answer);
  make_raw(state, config_.line);
  int answer = kernel_->ioctl(fd_, TCSETS2, &state);
  // The kernel takes what the driver can do of it and reports no difference: it has to be looked at.
  if (answer == 0) answer = kernel_->ioctl(fd_, TCGETS2, &state);
  if (answer < 0) return failure("set the line", answer);
  line_ = settings_of(state);
  const double off = std::abs(static_cast<double>(line_.baud) / config_.line.baud - 1.0);
  if (off <= config_.baud_tolerance && (state.c_cflag & kShape) == shape_of(config_.line)) return {};
  const bool rate = off > config_.baud_tolerance;
  return fail(ErrorCode::unsupported, name_, "set the line",
              fmt::format("asked for {}, the adapter gives {}", to_string(config_.line), to_string(line_)),
              rate ? "Choose a rate that this adapter has, at both ends"
                   : "Choose parity, bits and flow control that this adapter has, at both ends");
}

// Closes. While opening, EIO and its like mean that nothing is behind the name (/dev/ttyS1 of most machines);
// later, that what was there is gone.
Failure Port::failure(const char* operation, long answer) {
  const bool was_open = state_ == StreamState::open;
  let_go();
  const int error = static_cast<int>(-answer);
  ErrorCode code = code_of_device_errno(error);
  if (error == EIO || error == ENXIO || error == ENODEV || error == EPIPE)
    code = was_open ? ErrorCode::disconnected : ErrorCode::not_present;
  return fail(code, name_, operation, std::string(detail_of(code)), std::string(mend_of(code)), error);
}

Failure Port::busy() {
  state_ = StreamState::closed;
  const std::string holder = holder_of(*kernel_, config_.device);
  return fail(ErrorCode::busy, name_, "open",
              holder.empty() ? "somebody holds the port" : holder + " holds the port",
              std::string(mend_of(ErrorCode::busy)), EBUSY);
}

}  // namespace

std::unique_ptr<SerialPort> open_serial_port(SerialPortConfig config, const Clock& clock, Kernel& kernel) {
  return std::make_unique<Port>(std::move(config), clock, kernel);
}

}  // namespace forager::hal
