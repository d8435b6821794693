#include "tests/kernel/sysfs.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace forager::kernel {

int put_error(const std::string& path, std::string_view text) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (fd < 0) return errno;
  const auto written = ::write(fd, text.data(), text.size());
  const int error = written == static_cast<ssize_t>(text.size()) ? 0 : errno;
  ::close(fd);
  return error;
}

bool put(const std::string& path, std::string_view text) {
  const int error = put_error(path, text);
  if (error != 0) ADD_FAILURE() << path << ": \"" << text << "\": " << std::strerror(error);
  return error == 0;
}

std::string get(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    ADD_FAILURE() << path << " cannot be read";
    return {};
  }
  std::string text{std::istreambuf_iterator<char>(file), {}};
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace forager::kernel
