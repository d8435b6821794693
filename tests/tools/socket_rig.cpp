#include "tests/tools/socket_rig.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <stdexcept>

#include "hal/linux/curl_http_client.hpp"
#include "tests/places.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

bool can_bind(const std::string& host, std::uint16_t port, int kind) {
  const int fd = socket(AF_INET, kind | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  inet_pton(AF_INET, host.c_str(), &address.sin_addr);
  const bool bound = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  close(fd);
  return bound;
}

// Below the ports that the kernel gives to callers, so that none of those takes it between now and its use.
std::uint16_t free_port(const std::string& host) {
  static std::uint16_t next = 20000;
  for (int tries = 0; tries < 1000; ++tries) {
    const std::uint16_t port = next++;
    if (can_bind(host, port, SOCK_STREAM) && can_bind(host, port, SOCK_DGRAM)) return port;
  }
  throw std::runtime_error("no free port at " + host);
}

// The whole of 127/8 is this machine: tests that run at the same time get an address each.
std::string own_address() {
  const auto pid = static_cast<unsigned>(getpid());
  return fmt::format("127.{}.{}.{}", 64 + ((pid >> 16) & 63), (pid >> 8) & 255, pid & 255);
}

}  // namespace

std::vector<Json> lines_of(const std::string& out) {
  std::vector<Json> lines;
  std::size_t begin = 0;
  for (std::size_t end = out.find('\n'); end != std::string::npos; end = out.find('\n', begin)) {
    lines.push_back(Json::parse(out.begin() + static_cast<std::ptrdiff_t>(begin),
                                out.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false));
    begin = end + 1;
  }
  return lines;
}

Json last_event(const std::string& out, const std::string& event) {
  Json found;
  for (Json& line : lines_of(out))
    if (line.is_object() && line.value("event", "") == event) found = std::move(line);
  return found;
}

std::uint32_t tags_decided_on(const std::string& out) {
  std::uint32_t sum = 0;
  for (const Json& line : lines_of(out))
    if (line.is_object() && line.value("event", "") == "decision") sum += line.value("new_tags", 0U);
  return sum;
}

SocketRig::SocketRig(const Options& options)
    : host(own_address()),
      rest_port(free_port(host)),
      stream_port(free_port(host)),
      mavlink_port(free_port(host)),
      pose_port(free_port(host)),
      air_port(free_port(host)),
      rogue_port(free_port(host)) {
  write_scene(options);
  write_board(options);
}

SocketRig::~SocketRig() {
  mission_.reset();
  for (auto* emulator : {&reader_, &autopilot_})
    if (*emulator && (*emulator)->running()) end(**emulator);
  if (testing::Test::HasFailure()) {
    if (reader_) fmt::print(stderr, "-- reader:\n{}{}", reader_->so_far().out, reader_->so_far().err);
    if (autopilot_)
      fmt::print(stderr, "-- autopilot:\n{}{}", autopilot_->so_far().out, autopilot_->so_far().err);
  }
}

// Links are given ten times as long as they have on a vehicle, because a busy machine may keep these programs
// waiting ten times as long in their own time. The air is better than the laboratory's, so that chance leaves
// few of the tags unread: 37 or more of the 40 over two hundred seeds.
void SocketRig::write_scene(const Options& options) const {
  std::ofstream(file("aisle.toml")) << fmt::format(R"(base = "{}"
[scene]
name = "aisle"
title = "40 tags along one short shelf"
[mission]
policy = "stigmergy"
window_s = 1.0
tries = 5
{}
[links]
reader_timeout_s = 20.0
stream_timeout_s = 60.0
autopilot_timeout_s = 20.0
deadman_s = 10.0
{}
[[world.shelves]]
min = [1.0, 1.5, 0.0]
max = [4.0, 2.2, 2.5]
[[world.groups]]
tags = 10
centres = [[1.5, 1.8, 1.5], [2.2, 1.8, 1.5], [2.9, 1.8, 1.5], [3.6, 1.8, 1.5]]
[world.radio]
t0_s = 2.0
)",
                                                   test::source_path("scenes/lab.toml"), options.mission,
                                                   options.links);
}

void SocketRig::write_board(const Options& options) const {
  std::ofstream(file("board.toml")) << fmt::format(R"([board]
name = "three programs"
[reader]
host = "{0}"
rest_port = {1}
stream_port = {2}
{5}
[autopilot]
address = "{0}:{3}"
[world]
truth = "{0}:{4}"
)",
                                                   host, rest_port,
                                                   options.rogue_stream ? rogue_port : stream_port,
                                                   mavlink_port, pose_port, options.login);
}

std::vector<std::string> SocketRig::with_shared(std::vector<std::string> arguments,
                                                const std::vector<std::string>& more) const {
  for (const std::string& argument :
       {file("aisle.toml"), std::string("--speed"), fmt::format("{}", kSpeed), std::string("--json")})
    arguments.push_back(argument);
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void SocketRig::start_reader(std::vector<std::string> more, ProgramOptions options) {
  const std::vector<std::string> where{"--host",        host,
                                       "--rest-port",   fmt::format("{}", rest_port),
                                       "--stream-port", fmt::format("{}", stream_port),
                                       "--truth",       fmt::format("{}:{}", host, air_port),
                                       "--for",         "120"};
  more.insert(more.begin(), where.begin(), where.end());
  reader_.emplace(with_shared({"emulate", "reader"}, more), std::move(options));
  ASSERT_TRUE(reader_->wait_for_out("listening", kPatience)) << reader_->finish().err;
}

void SocketRig::start_autopilot(std::vector<std::string> more) {
  const std::vector<std::string> where{
      "--listen", fmt::format("{}:{}", host, mavlink_port), "--truth", fmt::format("{}:{}", host, pose_port),
      "--truth",  fmt::format("{}:{}", host, air_port),     "--for",   "120"};
  more.insert(more.begin(), where.begin(), where.end());
  autopilot_.emplace(with_shared({"emulate", "autopilot"}, more));
  ASSERT_TRUE(autopilot_->wait_for_out("listening", kPatience)) << autopilot_->finish().err;
}

Program& SocketRig::start_mission(ProgramOptions options) {
  options.deadline = 50s;
  mission_.emplace(with_shared({"run"}, {"--board", file("board.toml"), "--output", file("out")}),
                   std::move(options));
  return *mission_;
}

ProgramResult SocketRig::fly_in_process() const {
  return run_program({"run", file("aisle.toml"), "--json", "--no-files"});
}

ProgramResult SocketRig::end(Program& emulator) {
  emulator.send_signal(SIGTERM);
  ProgramResult result = emulator.finish();
  EXPECT_EQ(result.exit_code, 0) << "signal " << result.signal << "\n" << result.err;
  return result;
}

bool SocketRig::autopilot_armed() { return end(*autopilot_).out.find("Arming motors") != std::string::npos; }

std::vector<reader::InventoryItem> SocketRig::items() const {
  reader::StoreOptions options;
  options.mode = reader::StoreMode::read;
  options.busy_wait = 5s;
  const auto store = reader::open_sqlite_inventory(file("out/inventory.sqlite"), options);
  if (!store) return {};
  return (*store)->items().value_or(std::vector<reader::InventoryItem>{});
}

std::set<std::string> SocketRig::inventory() const {
  std::set<std::string> epcs;
  for (const reader::InventoryItem& item : items()) epcs.emplace(item.epc.hex());
  return epcs;
}

std::uint64_t SocketRig::inventory_reads() const {
  std::uint64_t reads = 0;
  for (const reader::InventoryItem& item : items()) reads += item.count;
  return reads;
}

void SocketTest::SetUp() {
  const auto store = reader::open_sqlite_inventory("no/such.sqlite", reader::StoreMode::read);
  if (!store && store.error().code == hal::ErrorCode::unsupported) GTEST_SKIP() << "built without SQLite";
  const auto client = hal::make_curl_http_client("http://127.0.0.1:1");
  hal::HttpRequest request;
  request.path = "/";
  request.timeout = 1s;
  const auto started = client->start(request, hal::Instant{});
  if (!started && started.error().code == hal::ErrorCode::unsupported)
    GTEST_SKIP() << "built without libcurl";
}

}  // namespace forager::tools
