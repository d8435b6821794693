#include "tests/kernel/kernel_module.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace forager::kernel {

KernelModule::KernelModule(const std::string& file) : name_(file.substr(0, file.find('.'))) {
  std::replace(name_.begin(), name_.end(), '-', '_');
  const std::string path = std::string(std::getenv("FORAGER_KERNEL_GUEST")) + "/" + file;
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0 || ::syscall(SYS_finit_module, fd, "", 0) != 0)
    ADD_FAILURE() << path << ": " << std::strerror(errno);
  if (fd >= 0) ::close(fd);
}

KernelModule::~KernelModule() {
  if (::syscall(SYS_delete_module, name_.c_str(), O_NONBLOCK) != 0)
    ADD_FAILURE() << name_ << ": " << std::strerror(errno);
}

}  // namespace forager::kernel
