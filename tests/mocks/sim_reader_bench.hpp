#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>

#include "hal/http_client.hpp"
#include "mocks/fake_tag_field.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/sim_reader.hpp"
#include "mocks/text_journal.hpp"

namespace forager::mocks {

// An emulated reader on the bench: a made-up air, a journal, and a client that speaks bytes.
struct SimReaderBench {
  static constexpr std::string_view kDevice = "/devices/AdvanReader-m4-160";

  explicit SimReaderBench(const SimReaderConfig& config = {}) : reader(config, field, journal) {}

  static hal::Instant at(double seconds) { return hal::Instant{hal::from_seconds(seconds)}; }

  HttpReply get(std::string_view path) { return call(hal::HttpMethod::get, path, ""); }
  HttpReply put(std::string_view path, std::string_view body) {
    return call(hal::HttpMethod::put, path, body);
  }
  HttpReply call(hal::HttpMethod method, std::string_view path, std::string_view body) {
    return reader.handle_http(method, path, body, now).reply;
  }
  HttpReply device_get(std::string_view path) { return get(fmt::format("{}/{}", kDevice, path)); }
  HttpReply device_put(std::string_view path, std::string_view body) {
    return put(fmt::format("{}/{}", kDevice, path), body);
  }

  // Moves time on in steps of 5 ms, collecting what `line` says into `heard`.
  void run_until(double seconds) {
    while (now < at(seconds)) {
      now = std::min(now + std::chrono::milliseconds(5), at(seconds));
      reader.update(now);
      listen();
    }
  }
  // Dials; open when true.
  bool dial() {
    if (line.near().state() == hal::StreamState::closed && !line.near().open()) return false;
    const auto state = line.near().poll();
    return state && *state == hal::StreamState::open;
  }
  void listen() {
    std::array<std::byte, 4096> bytes{};
    while (line.near().state() == hal::StreamState::open) {
      const auto count = line.near().read(bytes);
      if (!count || *count == 0) return;
      heard.append(reinterpret_cast<const char*>(bytes.data()), *count);
    }
  }
  // A tag heard at port 1.. at this time.
  void reply(std::uint32_t tag, double seconds, int port = 1, int rssi_dbm = -60) {
    field.add_reply({tag, port, rssi_dbm, 45, 866300, at(seconds)});
  }

  hal::Instant now;
  FakeTagField field;
  TextJournal journal;
  SimReader reader;
  MemoryStreamPair line{"tcp sim-reader:3177", MemoryStreamKind::bytes, 256 * 1024};
  std::string heard;
};

// How often `part` stands in `text`.
inline int occurrences(std::string_view text, std::string_view part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size()))
    ++count;
  return count;
}

}  // namespace forager::mocks
