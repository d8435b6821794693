#include "boards/reader_bench.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "boards/device_set.hpp"
#include "hal/linux/curl_http_client.hpp"
#include "hal/linux/tcp_stream.hpp"

namespace forager::boards {
namespace {

constexpr std::string_view kBenchScene = R"(
[scene]
name = "bench"
[reader]
session = "S0"
on_time_ms = 600
port = [
  { port = 4, name = "front", bearing_deg = 0.0 },
  { port = 3, name = "left", bearing_deg = 90.0 },
  { port = 1, name = "back", bearing_deg = 180.0 },
  { port = 2, name = "right", bearing_deg = -90.0 },
]
[mission]
policy = "stigmergy"
[[world.shelves]]
min = [2.0, -1.0, 0.0]
max = [2.4, 1.0, 2.0]
[[world.groups]]
tags = 20
centres = [[1.5, 0.0, 0.0], [1.5, 0.5, 0.0]]
[[world.groups]]
tags = 4
centres = [[0.0, 1.5, 0.0]]
)";

class RealReader final : public ReaderBench {
 public:
  RealReader(const Board& board, std::optional<hal::HttpCredentials> login)
      : rest_(hal::make_curl_http_client(reader_url(board), std::move(login))),
        events_(hal::open_tcp_stream(board.reader_host, board.reader_stream_port)) {}
  hal::HttpClient& rest() override { return *rest_; }
  hal::ByteStream& events() override { return *events_; }
  void advance(hal::Instant /*now*/) override {}

 private:
  std::unique_ptr<hal::HttpClient> rest_;
  std::unique_ptr<hal::ByteStream> events_;
};

class EmulatedReader final : public ReaderBench {
 public:
  explicit EmulatedReader(std::unique_ptr<DeviceSet> devices) : devices_(std::move(devices)) {}
  hal::HttpClient& rest() override { return devices_->reader_rest(); }
  hal::ByteStream& events() override { return devices_->reader_events(); }
  void advance(hal::Instant now) override { devices_->advance(now); }

 private:
  std::unique_ptr<DeviceSet> devices_;
};

}  // namespace

hal::Result<Scene> bench_scene() {
  return parse_config(kBenchScene, "bench").and_then([](const ConfigNode& node) {
    return read_scene(node, "bench");
  });
}

hal::Result<std::unique_ptr<ReaderBench>> open_reader_bench(const Board& board, const Scene& scene,
                                                            std::uint64_t seed) {
  if (board.kind == BoardKind::sim) {
    auto devices = make_sim_devices(scene, {.seed = seed});
    if (!devices) return hal::fail(std::move(devices).error());
    return std::make_unique<EmulatedReader>(*std::move(devices));
  }
  auto login = reader_login(board);
  if (!login) return hal::fail(std::move(login).error());
  std::optional<hal::HttpCredentials> credentials;
  if (*login) credentials = hal::HttpCredentials{(*login)->user, (*login)->password};
  return std::make_unique<RealReader>(board, std::move(credentials));
}

hal::Result<std::optional<ReaderLogin>> reader_login(const Board& board) {
  if (board.reader_user.empty()) return std::optional<ReaderLogin>{};
  const char* password = std::getenv(board.reader_password_env.c_str());
  if (password == nullptr)
    return hal::fail(hal::ErrorCode::not_present, "board " + board.name, "reader.password_env",
                     fmt::format("the environment variable {} is not set", board.reader_password_env),
                     fmt::format("Set it: export {}=...", board.reader_password_env));
  return ReaderLogin{board.reader_user, password};
}

std::string reader_url(const Board& board) {
  return fmt::format("http://{}:{}", board.reader_host, board.reader_rest_port);
}

}  // namespace forager::boards
