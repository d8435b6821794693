#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "boards/bench_board.hpp"
#include "boards/brake_board.hpp"
#include "boards/config_node.hpp"
#include "boards/esc_board.hpp"
#include "boards/modbus_board.hpp"
#include "hal/error.hpp"
#include "hal/serial.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// A host and a port.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;
};
// Whether port 0, "the kernel chooses", is an address to listen at.
enum class AnyPort : std::uint8_t { refused, allowed };
// "host:port". Errors: invalid_argument.
[[nodiscard]] hal::Result<Endpoint> endpoint_from(const std::string& text,
                                                  AnyPort any_port = AnyPort::refused);
[[nodiscard]] std::string to_string(const Endpoint& endpoint);

enum class BoardKind : std::uint8_t {
  sim,     // every device emulated in this process, on its own time line
  socket,  // reader and autopilot over sockets; camera and localisation computed from a truth feed
};

// Which backend each device has. Only this file knows addresses; a scene says what the devices must do.
struct Board {
  std::string name = "sim";
  BoardKind kind = BoardKind::sim;

  bool reader_named = false;  // the file has the table [reader]
  std::string reader_host = "127.0.0.1";
  std::uint16_t reader_rest_port = 3161;
  std::uint16_t reader_stream_port = 3177;
  std::string reader_device_id;     // empty: the only device the reader has
  std::string reader_user;          // empty: no login
  std::string reader_password_env;  // environment variable that holds the password

  Endpoint autopilot{"127.0.0.1", 14550};
  std::string autopilot_serial;  // a port, instead of the address; empty: UDP
  hal::SerialSettings autopilot_line{.baud = 57600};
  Endpoint truth{"127.0.0.1", 14571};  // where the emulated autopilot's truth feed is received

  // A program that moves outputs and is silent for longer than this is taken for hung (boards/output_guard).
  hal::Duration guard_timeout = std::chrono::milliseconds(60);

  BrakeBoard brakes;
  EscBoard esc;  // lines of the bench; a mission never uses them
  std::vector<ModbusLine> modbus;
  BenchBoard bench;  // single devices by name; a mission never uses them either
};

// The board with everything in process.
[[nodiscard]] Board sim_board();
// `sim`, or a file. Errors: those of load_config; invalid_argument for unknown keys and impossible values.
[[nodiscard]] hal::Result<Board> load_board(const std::string& name_or_path);

}  // namespace forager::boards
