#include "hal/linux/pseudo_terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "hal/linux/file_descriptor.hpp"
#include "hal/linux/kernel.hpp"

namespace forager::hal {
namespace {

class Terminal final : public PseudoTerminal {
 public:
  Terminal(FileDescriptor fd, std::string port, std::string link)
      : fd_(std::move(fd)),
        port_(link.empty() ? std::move(port) : link),
        link_(std::move(link)),
        name_("pty " + port_) {}
  ~Terminal() override {
    std::error_code ignored;
    if (!link_.empty()) std::filesystem::remove(link_, ignored);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  [[nodiscard]] const std::string& port() const override { return port_; }

 private:
  Result<> do_open() override {
    if (state_ != StreamState::closed)
      return fail(ErrorCode::invalid_state, name_, "open", "the stream is not closed");
    state_ = StreamState::opening;
    return {};
  }
  // The kernel reports a hang-up for as long as nobody has the port open.
  Result<StreamState> do_poll() override {
    if (state_ != StreamState::opening) return state_;
    pollfd wait{fd_.get(), POLLIN, 0};
    if (::poll(&wait, 1, 0) >= 0 && (wait.revents & POLLHUP) == 0) state_ = StreamState::open;
    return state_;
  }
  Result<std::size_t> do_read(std::span<std::byte> into) override {
    if (state_ != StreamState::open) return not_open("read");
    if (into.empty()) return std::size_t{0};
    return judge("read", ::read(fd_.get(), into.data(), into.size()));
  }
  Result<std::size_t> do_write(std::span<const std::byte> bytes) override {
    if (state_ != StreamState::open) return not_open("write");
    if (bytes.empty()) return std::size_t{0};
    return judge("write", ::write(fd_.get(), bytes.data(), bytes.size()));
  }
  Result<std::size_t> judge(const char* operation, ssize_t answer) {
    if (answer > 0) return static_cast<std::size_t>(answer);
    if (answer < 0 && (errno == EAGAIN || errno == EINTR)) return std::size_t{0};
    state_ = StreamState::closed;
    return fail(ErrorCode::disconnected, name_, operation, "nobody has the port open any more");
  }
  Failure not_open(const char* operation) const {
    return fail(ErrorCode::invalid_state, name_, operation, "the stream is not open");
  }
  void do_close() override { state_ = StreamState::closed; }
  std::string_view do_name() const override { return name_; }

  FileDescriptor fd_;
  std::string port_;
  std::string link_;
  std::string name_;
  StreamState state_ = StreamState::closed;
};

Failure failure(const char* operation, int error) {
  return fail(code_of_device_errno(error), "pty", operation, "the kernel gives none", "", error);
}

// Nothing is to be echoed back before the first who opens the port has set it up; and once it was open, its
// being closed shows.
Result<> calm(const std::string& port) {
  const FileDescriptor end(::open(port.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios state{};
  if (!end.valid() || ::tcgetattr(end.get(), &state) != 0) return failure("open", errno);
  ::cfmakeraw(&state);
  if (::tcsetattr(end.get(), TCSANOW, &state) != 0) return failure("open", errno);
  return {};
}

Result<> make_link(const std::string& link, const std::string& port) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(link, error))) fs::remove(link, error);
  fs::create_symlink(port, link, error);
  if (!error) return {};
  const ErrorCode code =
      error.value() == EEXIST ? ErrorCode::invalid_argument : code_of_device_errno(error.value());
  return fail(code, "pty " + link, "make the link", error.message(), "Choose another name for the port");
}

}  // namespace

Result<std::unique_ptr<PseudoTerminal>> open_pseudo_terminal(const std::string& link) {
  FileDescriptor fd(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 64> port{};
  if (!fd.valid() || ::grantpt(fd.get()) != 0 || ::unlockpt(fd.get()) != 0 ||
      ::ptsname_r(fd.get(), port.data(), port.size()) != 0)
    return failure("open", errno);
  FORAGER_TRY(calm(port.data()));
  if (!link.empty()) FORAGER_TRY(make_link(link, port.data()));
  return std::make_unique<Terminal>(std::move(fd), port.data(), link);
}

}  // namespace forager::hal
