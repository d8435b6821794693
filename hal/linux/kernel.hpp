#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "hal/error.hpp"

namespace forager::hal {

// The system calls of the backends that talk to the kernel without a vendor library between them, so that the
// code that runs on the robot can be tested under a kernel of the test's own making. Answers are those of the
// calls: zero or more, or -errno.
class Kernel {
 public:
  virtual ~Kernel() = default;
  virtual int open(const std::string& path, int flags) = 0;  // O_CLOEXEC is added
  virtual int close(int fd) = 0;
  virtual long read(int fd, std::span<char> into) = 0;
  virtual long write(int fd, std::string_view text) = 0;
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;
  // flock(LOCK_EX | LOCK_NB): -EAGAIN when somebody else has it. Lasts until the close.
  virtual int lock(int fd) = 0;
  // Names in a folder, sorted, without . and ..; empty if there is no such folder.
  virtual std::vector<std::string> list(const std::string& folder) = 0;
  // Where a symbolic link leads; empty if it is none.
  virtual std::string link(const std::string& path) = 0;
};

// Linux.
[[nodiscard]] Kernel& real_kernel();

// The portable code of an errno that a device's file left behind: EACCES is permission, ENXIO and EREMOTEIO
// no_ack (so i2c-dev reports a chip that does not answer), ENODEV disconnected, EBUSY busy.
[[nodiscard]] ErrorCode code_of_device_errno(int error);

// Reads a small file (an attribute of sysfs) to its end, without the line break. Errors: by
// code_of_device_errno.
[[nodiscard]] Result<std::string> read_file(Kernel& kernel, const std::string& path);
// Writes an attribute in one call. Errors: by code_of_device_errno.
[[nodiscard]] Result<> write_file(Kernel& kernel, const std::string& path, std::string_view text);

}  // namespace forager::hal
