#include "hal/linux/kernel.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace forager::hal {
namespace {

class RealKernel final : public Kernel {
 public:
  int open(const std::string& path, int flags) override {
    const int fd = ::open(path.c_str(), flags | O_CLOEXEC);
    return fd < 0 ? -errno : fd;
  }
  int close(int fd) override { return ::close(fd) < 0 ? -errno : 0; }
  long read(int fd, std::span<char> into) override {
    const ssize_t got = ::read(fd, into.data(), into.size());
    return got < 0 ? -errno : got;
  }
  long write(int fd, std::string_view text) override {
    const ssize_t put = ::write(fd, text.data(), text.size());
    return put < 0 ? -errno : put;
  }
  int ioctl(int fd, unsigned long request, void* argument) override {
    const int answer = ::ioctl(fd, request, argument);
    return answer < 0 ? -errno : answer;
  }
  int lock(int fd) override { return ::flock(fd, LOCK_EX | LOCK_NB) < 0 ? -errno : 0; }
  std::vector<std::string> list(const std::string& folder) override {
    std::vector<std::string> names;
    DIR* directory = ::opendir(folder.c_str());
    if (directory == nullptr) return names;
    while (const dirent* entry = ::readdir(directory)) {
      const std::string name = static_cast<const char*>(entry->d_name);
      if (name != "." && name != "..") names.push_back(name);
    }
    ::closedir(directory);
    std::sort(names.begin(), names.end());
    return names;
  }
  std::string link(const std::string& path) override {
    std::array<char, 4096> target{};
    const ssize_t size = ::readlink(path.c_str(), target.data(), target.size());
    return size <= 0 ? std::string() : std::string(target.data(), static_cast<std::size_t>(size));
  }
};

Failure failure(const std::string& path, std::string_view operation, long answer) {
  const int error = static_cast<int>(-answer);
  return fail(code_of_device_errno(error), path, std::string(operation), "", "", error);
}

}  // namespace

Kernel& real_kernel() {
  static RealKernel kernel;
  return kernel;
}

ErrorCode code_of_device_errno(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
      return ErrorCode::permission;
    case ENOENT:
    case ENOTDIR:
      return ErrorCode::not_present;
    case EBUSY:
    case EAGAIN:  // i2c-dev: lost the arbitration
      return ErrorCode::busy;
    case ETIMEDOUT:
      return ErrorCode::timeout;
    case ENXIO:  // what i2c adapters answer differs: Documentation/i2c/fault-codes of the kernel
    case EREMOTEIO:
      return ErrorCode::no_ack;
    case ENODEV:
    case ESHUTDOWN:
      return ErrorCode::disconnected;
    case EOPNOTSUPP:
    case ENOTTY:
    case ENOSYS:
      return ErrorCode::unsupported;
    case EINVAL:
    case ERANGE:
      return ErrorCode::invalid_argument;
    default:
      return ErrorCode::io;
  }
}

Result<std::string> read_file(Kernel& kernel, const std::string& path) {
  const int fd = kernel.open(path, O_RDONLY);
  if (fd < 0) return failure(path, "open", fd);
  std::array<char, 256> text{};
  const long got = kernel.read(fd, text);
  kernel.close(fd);
  if (got < 0) return failure(path, "read", got);
  std::string line(text.data(), static_cast<std::size_t>(got));
  while (!line.empty() && (line.back() == '\n' || line.back() == ' ')) line.pop_back();
  return line;
}

Result<> write_file(Kernel& kernel, const std::string& path, std::string_view text) {
  const int fd = kernel.open(path, O_WRONLY);
  if (fd < 0) return failure(path, "open", fd);
  const long put = kernel.write(fd, text);
  kernel.close(fd);
  if (put < 0) return failure(path, "write", put);
  if (static_cast<std::size_t>(put) != text.size()) return failure(path, "write", -EIO);
  return {};
}

}  // namespace forager::hal
