#include "boards/board.hpp"

#include <fmt/format.h>

#include <charconv>

#include "boards/config_reader.hpp"

namespace forager::boards {
namespace {

constexpr Range kPort{1, 65535};

Endpoint read_endpoint(ConfigReader& table, std::string_view key, const Endpoint& fallback) {
  if (!table.has(key)) return fallback;
  auto endpoint = endpoint_from(table.text(key, ""));
  if (endpoint) return *endpoint;
  table.complain(key, endpoint.error().detail, endpoint.error().mend);
  return fallback;
}

void read_reader(ConfigReader table, Board& board) {
  board.reader_named = table.present();
  board.reader_host = table.text("host", board.reader_host);
  board.reader_rest_port =
      static_cast<std::uint16_t>(table.integer("rest_port", board.reader_rest_port, kPort));
  board.reader_stream_port =
      static_cast<std::uint16_t>(table.integer("stream_port", board.reader_stream_port, kPort));
  board.reader_device_id = table.text("device_id", "");
  board.reader_user = table.text("user", "");
  board.reader_password_env = table.text("password_env", "");
  if (board.reader_user.empty() != board.reader_password_env.empty())
    table.complain("user", "and password_env go together",
                   "Give both, or neither for a reader without login.");
}

void read_autopilot(ConfigReader table, Board& board) {
  board.autopilot = read_endpoint(table, "address", board.autopilot);
  board.autopilot_serial = table.text("serial", "");
  board.autopilot_line.baud =
      static_cast<std::uint32_t>(table.integer("baud", board.autopilot_line.baud, {1200, 12e6}));
  if (table.choice("flow", "none", {"none", "hardware"}) == "hardware")
    board.autopilot_line.flow = hal::FlowControl::hardware;
  if (table.has("serial") && table.has("address"))
    table.complain("serial", "and address exclude each other", "Give the one the autopilot is on.");
  if (!table.has("serial") && (table.has("baud") || table.has("flow")))
    table.complain("baud", "and flow belong to a serial port", "Name it: serial = \"/dev/ttyACM0\".");
}

}  // namespace

hal::Result<Endpoint> endpoint_from(const std::string& text, AnyPort any_port) {
  const std::size_t colon = text.rfind(':');
  unsigned port = 0;
  const char* end = text.data() + text.size();
  const bool parsed = colon != std::string::npos && colon > 0 &&
                      std::from_chars(text.data() + colon + 1, end, port).ptr == end &&
                      port >= (any_port == AnyPort::allowed ? 0U : 1U) && port <= 65535;
  if (!parsed)
    return hal::fail(hal::ErrorCode::invalid_argument, "address", text,
                     fmt::format("\"{}\" is not HOST:PORT", text), "Write for example 192.168.1.50:14550.");
  return Endpoint{text.substr(0, colon), static_cast<std::uint16_t>(port)};
}

std::string to_string(const Endpoint& endpoint) { return fmt::format("{}:{}", endpoint.host, endpoint.port); }

Board sim_board() { return {}; }

hal::Result<Board> load_board(const std::string& name_or_path) {
  if (name_or_path == "sim") return sim_board();
  auto root = load_config(name_or_path);
  if (!root) return hal::fail(std::move(root).error());
  ConfigIssue issue;
  ConfigReader top(&*root, "", issue);
  Board board;
  ConfigReader about = top.table("board");
  about.require("name", "a short name, such as name = \"drone-2\"");
  board.name = about.text("name", "");
  board.kind =
      about.choice("kind", "socket", {"sim", "socket"}) == "sim" ? BoardKind::sim : BoardKind::socket;
  board.guard_timeout = about.duration("guard_timeout_ms", board.guard_timeout, {20, 10000});
  read_reader(top.table("reader"), board);
  read_autopilot(top.table("autopilot"), board);
  ConfigReader world = top.table("world");
  board.truth = read_endpoint(world, "truth", board.truth);
  board.brakes = read_brake_board(top.table("brakes"));
  board.esc = read_esc_board(top.table("esc"));
  board.modbus = read_modbus_board(top);
  board.bench = read_bench_board(top);
  add_brake_servos(board.bench, board.brakes);
  check_unused(*root, issue);
  if (issue) return hal::fail(std::move(*issue));
  return board;
}

}  // namespace forager::boards
