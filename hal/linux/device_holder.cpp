#include "hal/linux/device_holder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace forager::hal {
namespace {

constexpr int kMostLinks = 8;

bool is_number(const std::string& name) {
  return std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::string real_device(Kernel& kernel, std::string path) {
  for (int i = 0; i < kMostLinks; ++i) {
    const std::string target = kernel.link(path);
    if (target.empty()) break;
    path = (std::filesystem::path(path).parent_path() / target).lexically_normal().string();
  }
  return path;
}

std::string holder_of(Kernel& kernel, const std::string& path) {
  const std::string device = real_device(kernel, path);
  for (const std::string& process : kernel.list("/proc")) {
    if (!is_number(process)) continue;
    for (const std::string& fd : kernel.list(fmt::format("/proc/{}/fd", process))) {
      if (kernel.link(fmt::format("/proc/{}/fd/{}", process, fd)) != device) continue;
      const auto name = read_file(kernel, fmt::format("/proc/{}/comm", process));
      return fmt::format("process {} ({})", process, name.value_or("?"));
    }
  }
  return {};
}

}  // namespace forager::hal
