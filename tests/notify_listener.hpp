#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "hal/linux/file_descriptor.hpp"

namespace forager::test {

// What systemd would hear at NOTIFY_SOCKET; it keeps no more than the kernel queues, some ten messages.
class NotifyListener {
 public:
  explicit NotifyListener(const std::string& path) : fd_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    EXPECT_EQ(::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  std::vector<std::string> heard() {
    std::vector<std::string> all;
    std::array<char, 256> text{};
    for (ssize_t got = 0; (got = ::recv(fd_.get(), text.data(), text.size(), 0)) >= 0;)
      all.emplace_back(text.data(), static_cast<std::size_t>(got));
    return all;
  }

 private:
  hal::FileDescriptor fd_;
};

}  // namespace forager::test
