#pragma once

#include <string>

namespace forager::kernel {

// A module that tests/kernel/build.sh built, in the kernel for as long as the object lives.
class KernelModule {
 public:
  // The file's name: "hid-mcp2221.ko".
  explicit KernelModule(const std::string& file);
  ~KernelModule();
  KernelModule(const KernelModule&) = delete;
  KernelModule& operator=(const KernelModule&) = delete;

 private:
  std::string name_;
};

}  // namespace forager::kernel
