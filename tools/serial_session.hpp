#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/serial.hpp"
#include "hal/time.hpp"
#include "tools/bench_session.hpp"

namespace forager::tools {

enum class SerialTask : std::uint8_t { list, watch, terminal, echo, loopback, baud };

struct SerialCommand {
  SerialTask task = SerialTask::list;
  std::string board{};                  // file whose names count; empty: none
  std::string device;                   // a name of it, or a path; run with settings_of() it is a path
  std::optional<std::uint32_t> baud{};  // empty: the board file's, or 115200
  std::optional<std::string> format{};  // empty: the board file's, or "8N1"
  bool hardware_flow = false;
  double for_s = 0.0;
  bool hex = false;
  bool json = false;
  std::uint64_t bytes = 4096;          // of a loopback test
  std::uint64_t seed = 1;              // of what it sends
  std::vector<std::uint32_t> rates{};  // of a baud check; empty: the usual ones
  bool arm = false;                    // terminal: bytes may be sent
};

// What the command says, on top of what the board file says of the line. Errors: invalid_argument.
[[nodiscard]] hal::Result<hal::SerialSettings> settings_of(const SerialCommand& command,
                                                           const hal::SerialSettings& line);

inline constexpr hal::Duration kSerialTick = std::chrono::milliseconds(2);

// Opens a port and waits until it is open, as its permission may come a moment after its plug. Gives what was
// in the way.
[[nodiscard]] std::optional<hal::Error> open_port(hal::SerialPort& port, BenchLoop& loop);
// A character of ASCII text, line ends and tabs included.
[[nodiscard]] bool printable(std::byte byte);

// What these do stands in tools/cmd_serial.cpp's descriptions. Each gives an exit code.
int run_serial_watch(const SerialCommand& command, const hal::SerialSettings& settings);
int run_serial_loopback(const SerialCommand& command, const hal::SerialSettings& settings);
int run_serial_baud(const SerialCommand& command, const hal::SerialSettings& settings);

}  // namespace forager::tools
