#include "boards/doctor.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/timex.h>
#include <unistd.h>

#include <cstring>

#include "boards/bench_devices.hpp"
#include "hal/journal.hpp"
#include "hal/linux/kernel.hpp"

namespace forager::boards {
namespace {

class RealHost final : public DoctorHost {
 public:
  User user() override {
    User user;
    user.root = geteuid() == 0;
    const passwd* entry = getpwuid(geteuid());
    user.name = entry != nullptr ? entry->pw_name : fmt::format("user {}", geteuid());
    std::vector<gid_t> ids(static_cast<std::size_t>(std::max(getgroups(0, nullptr), 0)));
    const int count = getgroups(static_cast<int>(ids.size()), ids.data());
    ids.resize(static_cast<std::size_t>(std::max(count, 0)));
    ids.push_back(getegid());
    for (const gid_t id : ids)
      if (const group* known = getgrgid(id); known != nullptr) user.groups.emplace_back(known->gr_name);
    return user;
  }
  std::optional<bool> clock_synchronised() override {
    timex state{};
    const int answer = adjtimex(&state);
    if (answer < 0) return std::nullopt;
    return answer != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
  }
};

}  // namespace

std::string_view to_string(CheckState state) {
  switch (state) {
    case CheckState::ok:
      return "ok";
    case CheckState::warned:
      return "warned";
    case CheckState::skipped:
      return "skipped";
    case CheckState::failed:
      break;
  }
  return "failed";
}

DoctorHost& real_doctor_host() {
  static RealHost host;
  return host;
}

void Doctor::ok(std::string_view area, std::string name, std::string text) const {
  tell({std::string(area), std::move(name), CheckState::ok, std::move(text), {}});
}
void Doctor::warn(std::string_view area, std::string name, std::string text, std::string mend) const {
  tell({std::string(area), std::move(name), CheckState::warned, std::move(text), std::move(mend)});
}
void Doctor::skip(std::string_view area, std::string name, std::string text, std::string mend) const {
  tell({std::string(area), std::move(name), CheckState::skipped, std::move(text), std::move(mend)});
}
void Doctor::fail(std::string_view area, std::string name, std::string text, std::string mend) const {
  tell({std::string(area), std::move(name), CheckState::failed, std::move(text), std::move(mend)});
}
void Doctor::fail(std::string_view area, std::string name, const hal::Error& error) const {
  std::string text =
      fmt::format("{}: {}", error.device, error.detail.empty() ? to_string(error.code) : error.detail);
  if (error.sys_errno != 0) text += fmt::format(" [{}]", std::strerror(error.sys_errno));
  if (error.code == hal::ErrorCode::unsupported && error.sys_errno == 0)
    skip(area, std::move(name), std::move(text), error.mend);
  else
    fail(area, std::move(name), std::move(text), error.mend);
}

void check_board(const Doctor& doctor, const Board& board) {
  check_reader(doctor, board);
  check_autopilot(doctor, board);
  check_lines(doctor, board);
  check_outputs(doctor, board);
  check_actuators(doctor, board);
  check_serials(doctor, board);
  check_wedges(doctor, board);
}

void run_doctor(const Board* board, const std::function<void(const Check&)>& tell) {
  hal::NullJournal journal;
  const auto machine = make_real_machine(journal);
  const Doctor doctor{hal::real_kernel(), *machine, real_doctor_host(), tell};
  check_host(doctor);
  check_backends(doctor);
  check_machine(doctor);
  if (board != nullptr) check_board(doctor, *board);
}

}  // namespace forager::boards
