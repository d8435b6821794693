#include "tests/kernel/user.hpp"

#include <grp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

namespace forager::kernel {
namespace {

constexpr uid_t kNobody = 65534;

bool become_nobody(const std::vector<std::string>& groups) {
  std::vector<gid_t> ids;
  for (const std::string& name : groups) {
    const group* entry = ::getgrnam(name.c_str());
    if (entry == nullptr) return false;
    ids.push_back(entry->gr_gid);
  }
  return ::setgroups(ids.size(), ids.data()) == 0 && ::setgid(kNobody) == 0 && ::setuid(kNobody) == 0;
}

}  // namespace

std::string in_a_child(const std::function<std::string()>& body) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return "no pipe";
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string text = body();
    const auto written = ::write(ends[1], text.data(), text.size());
    ::_exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
  }
  ::close(ends[1]);
  std::string answer;
  std::array<char, 512> room{};
  for (ssize_t size = 0; (size = ::read(ends[0], room.data(), room.size())) > 0;)
    answer.append(room.data(), static_cast<std::size_t>(size));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  return status == 0 ? answer : "the child died; before, it said: " + answer;
}

std::string as_nobody(const std::vector<std::string>& groups, const std::function<std::string()>& body) {
  return in_a_child([&] { return become_nobody(groups) ? body() : "cannot become nobody"; });
}

}  // namespace forager::kernel
