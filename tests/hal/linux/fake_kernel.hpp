#pragma once

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/linux/kernel.hpp"

// A kernel in memory under the real backends: it refuses what Linux refuses, with the same errno.
namespace forager::hal::fake {

// A file of the fake kernel. Defaults refuse.
class Node {
 public:
  virtual ~Node() = default;
  virtual int open(int) { return 0; }
  virtual long read(std::string&) { return -EINVAL; }
  virtual long write(std::string_view) { return -EINVAL; }
  virtual int ioctl(unsigned long, void*) { return -ENOTTY; }
  virtual int lock() { return 0; }
  virtual void close() {}
};

class FakeKernel final : public Kernel {
 public:
  std::map<std::string, std::shared_ptr<Node>> files;
  std::map<std::string, std::string> links;
  std::vector<std::string> writes;  // "path=text", in order, of those that were taken
  std::optional<int> fail_next;     // errno of the next read, write or ioctl

  int open(const std::string& path, int flags) override {
    const auto found = files.find(path);
    if (found == files.end()) return -ENOENT;
    if (const int answer = found->second->open(flags); answer < 0) return answer;
    open_[++last_fd_] = {path, found->second};
    return last_fd_;
  }
  int close(int fd) override {
    const auto found = open_.find(fd);
    if (found == open_.end()) return -EBADF;
    found->second.second->close();
    open_.erase(found);
    return 0;
  }
  int lock(int fd) override { return open_.at(fd).second->lock(); }
  long read(int fd, std::span<char> into) override {
    if (fail_next) return -*std::exchange(fail_next, std::nullopt);
    std::string text;
    const long answer = open_.at(fd).second->read(text);
    if (answer < 0) return answer;
    const std::size_t size = std::min(text.size(), into.size());
    std::memcpy(into.data(), text.data(), size);
    return static_cast<long>(size);
  }
  long write(int fd, std::string_view text) override {
    if (fail_next) return -*std::exchange(fail_next, std::nullopt);
    const auto& [path, node] = open_.at(fd);
    if (const long answer = node->write(text); answer < 0) return answer;
    writes.push_back(path + "=" + std::string(text));
    return static_cast<long>(text.size());
  }
  int ioctl(int fd, unsigned long request, void* argument) override {
    if (fail_next) return -*std::exchange(fail_next, std::nullopt);
    return open_.at(fd).second->ioctl(request, argument);
  }
  std::vector<std::string> list(const std::string& folder) override {
    std::vector<std::string> names;
    for (const auto& [path, node] : files) {
      if (path.compare(0, folder.size() + 1, folder + "/") != 0) continue;
      const std::string name =
          path.substr(folder.size() + 1, path.find('/', folder.size() + 1) - folder.size() - 1);
      if (names.empty() || names.back() != name) names.push_back(name);
    }
    return names;
  }
  std::string link(const std::string& path) override {
    const auto found = links.find(path);
    return found == links.end() ? std::string() : found->second;
  }
  [[nodiscard]] std::size_t open_files() const { return open_.size(); }

 private:
  std::map<int, std::pair<std::string, std::shared_ptr<Node>>> open_;
  int last_fd_ = 100;
};

}  // namespace forager::hal::fake
