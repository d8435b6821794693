#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "boards/board.hpp"
#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::hal {
class Kernel;
}

namespace forager::boards {

class BenchMachine;

enum class CheckState : std::uint8_t {
  ok,
  warned,   // works, but worse than it could
  skipped,  // not looked at: not built, not there and not asked for, emulated
  failed,
};
[[nodiscard]] std::string_view to_string(CheckState state);

struct Check {
  std::string area;  // "host", "backend", "machine", "board"
  std::string name;  // "clock sync", "libgpiod", "gpio stop_button"
  CheckState state = CheckState::ok;
  std::string text;  // what was found
  std::string mend;  // what to do about it; empty when nothing is
};

// What the operating system is asked for beside its files.
class DoctorHost {
 public:
  virtual ~DoctorHost() = default;
  struct User {
    std::string name;
    bool root = false;
    std::vector<std::string> groups;
  };
  [[nodiscard]] virtual User user() = 0;
  // Whether a time server keeps the clock; nothing: it cannot be asked (a container).
  [[nodiscard]] virtual std::optional<bool> clock_synchronised() = 0;
};
// Linux.
[[nodiscard]] DoctorHost& real_doctor_host();

// Where the checks look, and where they say what they saw, one after the other.
struct Doctor {
  hal::Kernel& kernel;
  BenchMachine& machine;
  DoctorHost& host;
  std::function<void(const Check&)> tell;

  void ok(std::string_view area, std::string name, std::string text) const;
  void warn(std::string_view area, std::string name, std::string text, std::string mend) const;
  void skip(std::string_view area, std::string name, std::string text, std::string mend = {}) const;
  void fail(std::string_view area, std::string name, std::string text, std::string mend) const;
  // An error as a check: "not built in" is skipped, everything else failed.
  void fail(std::string_view area, std::string name, const hal::Error& error) const;
};

// Kernel, real time, governor, clock, supply, user and rules.
void check_host(const Doctor& doctor);
// What this program was built with.
void check_backends(const Doctor& doctor);
// The chips, buses and ports that are there, whatever the board file says; drivers that are in the way.
void check_machine(const Doctor& doctor);
// Every device of the board file. Nothing moves, and no output is driven: GPIO lines and PWM channels are
// looked up, chips and actuators are asked one harmless question.
void check_board(const Doctor& doctor, const Board& board);
// Parts of check_board().
void check_lines(const Doctor& doctor, const Board& board);
void check_outputs(const Doctor& doctor, const Board& board);
void check_actuators(const Doctor& doctor, const Board& board);
void check_reader(const Doctor& doctor, const Board& board);
void check_autopilot(const Doctor& doctor, const Board& board);
void check_serials(const Doctor& doctor, const Board& board);
void check_wedges(const Doctor& doctor, const Board& board);

// On this machine.
void run_doctor(const Board* board, const std::function<void(const Check&)>& tell);

}  // namespace forager::boards
