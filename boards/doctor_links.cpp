// The devices at the other end of a network or a serial line: whether they answer, and if not, why.
#include <fmt/format.h>

#include <array>

#include "boards/autopilot_line.hpp"
#include "boards/bench_devices.hpp"
#include "boards/doctor.hpp"
#include "boards/reader_bench.hpp"
#include "boards/serial_bench.hpp"
#include "flight/mavlink/parser.hpp"
#include "flight/mavlink_autopilot.hpp"
#include "hal/journal.hpp"
#include "hal/linux/curl_http_client.hpp"
#include "hal/linux/serial_port.hpp"
#include "hal/linux/tcp_stream.hpp"
#include "reader/advannet_rest.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kArea = "board";
constexpr hal::Duration kNetwork = 2s;
constexpr hal::Duration kHeartbeat = 3s;  // an autopilot sends one a second
constexpr hal::Duration kListen = 1500ms;
constexpr hal::Duration kPause = 5ms;
constexpr std::size_t kEnough = 600;  // bytes: two of MAVLink's longest frames

// Calls step() until it answers true or the time is over.
template <class Step>
bool within(hal::Clock& clock, hal::Duration time, Step&& step) {
  for (const hal::Instant end = clock.now() + time; clock.now() < end;) {
    if (step()) return true;
    clock.sleep_until(clock.now() + kPause);
  }
  return false;
}

std::string_view unreachable_mend() {
  return "Check the reader's power and network cable, reader.host of the board file, and ping it";
}

void check_rest(const Doctor& doctor, const Board& board) {
  const auto login = reader_login(board);
  if (!login) return doctor.fail(kArea, "reader", login.error());
  std::optional<hal::HttpCredentials> credentials;
  if (*login) credentials = hal::HttpCredentials{(*login)->user, (*login)->password};
  const auto client = hal::make_curl_http_client(reader_url(board), std::move(credentials));
  hal::Clock& clock = doctor.machine.clock();
  hal::HttpRequest request = reader::advannet::get_devices();
  request.timeout = kNetwork;
  if (const auto started = client->start(request, clock.now()); !started)
    return doctor.fail(kArea, "reader", started.error());
  hal::Result<std::optional<hal::HttpResponse>> answer;
  within(clock, kNetwork + 500ms, [&] {
    answer = client->poll(clock.now());
    return !answer || answer->has_value();
  });
  if (!answer) {
    hal::Error error = answer.error();
    if (error.code == hal::ErrorCode::timeout || error.code == hal::ErrorCode::refused ||
        error.code == hal::ErrorCode::disconnected || error.code == hal::ErrorCode::not_present) {
      error.detail = "unreachable: " + error.detail;
      error.mend = unreachable_mend();
    }
    return doctor.fail(kArea, "reader", error);
  }
  if (!answer->has_value())
    return doctor.fail(kArea, "reader", reader_url(board) + ": unreachable: no answer",
                       std::string(unreachable_mend()));
  const auto reply = reader::advannet::parse_reply(**answer);
  if (!reply)
    return doctor.fail(
        kArea, "reader",
        reader_url(board) + ": something answers, but it is no AdvanNet: " + reply.error().detail,
        "Check reader.host and reader.rest_port of the board file");
  if (reply->devices.empty())
    return doctor.fail(kArea, "reader", reader_url(board) + ": AdvanNet answers, but has no reader attached",
                       "Look at its web page, and start it again");
  const reader::advannet::Device& device = reply->devices.front();
  doctor.ok(kArea, "reader",
            fmt::format("{}: {} {}{}", reader_url(board), device.family, device.id,
                        device.status.empty() ? "" : ", " + device.status));
}

void check_stream(const Doctor& doctor, const Board& board) {
  hal::Clock& clock = doctor.machine.clock();
  const auto stream = hal::open_tcp_stream(board.reader_host, board.reader_stream_port);
  hal::Result<> failed = stream->open();
  const bool open = failed && within(clock, kNetwork, [&] {
                      const auto state = stream->poll();
                      if (!state) failed = hal::fail(state.error());
                      return !state || *state == hal::StreamState::open;
                    });
  if (!failed) {
    hal::Error error = failed.error();
    error.detail = "unreachable: " + error.detail;
    error.mend = unreachable_mend();
    return doctor.fail(kArea, "reader stream", error);
  }
  if (!open)
    return doctor.fail(
        kArea, "reader stream",
        fmt::format("{}: unreachable: no answer within {} s", stream->name(), hal::to_seconds(kNetwork)),
        std::string(unreachable_mend()));
  doctor.ok(kArea, "reader stream", fmt::format("{} is open", stream->name()));
}

// What came in on a line, and whether it makes sense.
struct Heard {
  std::size_t bytes = 0;
  std::size_t printable = 0;
  std::uint64_t frames = 0;
};

hal::Result<Heard> listen(const Doctor& doctor, hal::ByteStream& port, SerialPeer peer) {
  Heard heard;
  hal::Result<> failed;
  flight::mavlink::Parser parser;
  within(doctor.machine.clock(), kListen, [&] {
    const auto state = port.poll();
    if (!state) failed = hal::fail(state.error());
    if (!state || *state != hal::StreamState::open) return !state;
    if (peer == SerialPeer::silent) return true;
    std::array<std::byte, 512> bytes;
    const auto got = port.read(bytes);
    if (!got) {
      failed = hal::fail(got.error());
      return true;
    }
    heard.bytes += *got;
    for (std::size_t i = 0; i < *got; ++i) {
      const auto c = std::to_integer<unsigned>(bytes[i]);
      if ((c >= 0x20 && c < 0x7F) || c == '\r' || c == '\n' || c == '\t') ++heard.printable;
    }
    parser.feed(std::span(bytes).first(*got), [&heard](const flight::mavlink::Frame&) { ++heard.frames; });
    return heard.frames >= 2 || heard.bytes >= kEnough;
  });
  if (!failed) return hal::fail(failed.error());
  return heard;
}

// A line that somebody talks on unasked: whether what comes makes sense tells a wrong baud rate from a cable.
void check_line(const Doctor& doctor, const std::string& name, hal::ByteStream& port, const std::string& line,
                SerialPeer peer) {
  if (const auto opened = port.open(); !opened) return doctor.fail(kArea, name, opened.error());
  const auto heard = listen(doctor, port, peer);
  if (!heard) return doctor.fail(kArea, name, heard.error());
  if (peer == SerialPeer::silent) return doctor.ok(kArea, name, line + " opens");
  const char* what = peer == SerialPeer::mavlink ? "MAVLink" : "text";
  if (heard->bytes == 0)
    return doctor.fail(
        kArea, name, fmt::format("{}: not one byte in {} s", line, hal::to_seconds(kListen)),
        "Check the other end's power, that RX and TX cross, and that its port is switched to " +
            std::string(what));
  const bool sense =
      peer == SerialPeer::mavlink ? heard->frames > 0 : heard->printable * 10 >= heard->bytes * 9;
  if (!sense)
    return doctor.fail(
        kArea, name,
        fmt::format("{}: {} bytes came and make no {}: wrong baud rate", line, heard->bytes, what),
        "Set the same baud rate and parity at both ends: baud = of the board file");
  doctor.ok(kArea, name, fmt::format("{}: {} is heard", line, what));
}

void check_serial(const Doctor& doctor, const BenchSerial& serial) {
  const hal::SerialSettings line = settings_of(serial);
  const auto port =
      hal::open_serial_port({.device = serial.port, .line = line}, doctor.machine.clock(), doctor.kernel);
  check_line(doctor, "serial " + serial.name, *port, fmt::format("{} at {}", serial.port, to_string(line)),
             serial.peer);
}

// By the line that a mission would open, flow control included.
void check_autopilot_port(const Doctor& doctor, const Board& board) {
  const auto port = open_autopilot_line(board);
  check_line(doctor, "autopilot", *port,
             fmt::format("{} at {}", board.autopilot_serial, to_string(board.autopilot_line)),
             SerialPeer::mavlink);
}

}  // namespace

void check_reader(const Doctor& doctor, const Board& board) {
  if (board.kind == BoardKind::sim) return doctor.skip(kArea, "reader", "emulated in this process");
  if (!board.reader_named) return doctor.skip(kArea, "reader", "the board file has no table [reader]");
  check_rest(doctor, board);
  check_stream(doctor, board);
}

void check_autopilot(const Doctor& doctor, const Board& board) {
  if (board.kind == BoardKind::sim) return doctor.skip(kArea, "autopilot", "emulated in this process");
  if (!board.autopilot_serial.empty()) return check_autopilot_port(doctor, board);
  const auto stream = open_autopilot_line(board);
  hal::NullJournal journal;
  hal::Clock& clock = doctor.machine.clock();
  flight::MotorBay bay;
  auto motors = bay.claim("forager doctor");
  if (!motors) return doctor.fail(kArea, "autopilot", motors.error());
  const auto link = flight::MavlinkAutopilot::create(*stream, journal, {}, clock.now(), *std::move(motors));
  if (!link) return doctor.fail(kArea, "autopilot", link.error());
  const bool up = within(clock, kHeartbeat, [&] {
    (*link)->feed_deadman(clock.now());
    (*link)->update(clock.now());
    return (*link)->state().link_up;
  });
  const std::string where = "udp " + to_string(board.autopilot);
  if (!up)
    return doctor.fail(kArea, "autopilot",
                       fmt::format("{}: no heartbeat within {} s", where, hal::to_seconds(kHeartbeat)),
                       "Check its power, the link, and autopilot.address of the board file");
  doctor.ok(kArea, "autopilot", where + ": heartbeats come");
}

void check_serials(const Doctor& doctor, const Board& board) {
  for (const BenchSerial& serial : board.bench.serials) check_serial(doctor, serial);
}

}  // namespace forager::boards
