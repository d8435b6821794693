#include "tools/cmd_mavlink.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "boards/board.hpp"
#include "boards/reader_bench.hpp"
#include "boards/run_clock.hpp"
#include "boards/run_journal.hpp"
#include "boards/scene.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/registry.hpp"
#include "flight/mavlink_link.hpp"
#include "flight/mavlink_monitor.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/mavlink_output.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
namespace mavlink = flight::mavlink;

constexpr hal::Duration kHeartbeat = 1s;
constexpr hal::Duration kAskAgain = 2s;
// Not a ground station's and not a companion's: an autopilot that loses sight of those acts on it, and this
// bench comes and goes.
constexpr std::uint8_t kBenchSystem = 254;

flight::MavlinkConfig link_config() {
  flight::MavlinkConfig config;
  config.sysid = kBenchSystem;
  config.compid = mavlink::component::kMissionPlanner;
  config.reopen_after_silence = hal::Duration::zero();
  return config;
}

// The outermost loop of the bench.
class MavlinkListen {
 public:
  MavlinkListen(const MavlinkCommand& command, std::vector<std::uint32_t> ask, boards::MavlinkBench& bench,
                hal::Journal& journal, MavlinkOutput& output, const std::string& problem)
      : command_(command),
        ask_(std::move(ask)),
        bench_(bench),
        output_(output),
        problem_(problem),
        link_(bench.line(), journal, link_config(), std::nullopt) {}

  int run(hal::Clock& clock) {
    BenchLoop loop(clock, 5ms);
    last_moment_ = clock.now();
    std::optional<hal::Duration> time;
    if (command_.for_s > 0.0) time = hal::from_seconds(command_.for_s);
    loop.run(time, [this](hal::Instant now) {
      step(now);
      return true;
    });
    output_.end(moment(clock.now(), true));
    if (monitor_.autopilot() != nullptr) return kExitDone;
    fmt::print(stderr, "forager: {}: {}\n", bench_.line().name(), one_line(why()));
    return kExitFailure;
  }

 private:
  void step(hal::Instant now) {
    bench_.advance(now);
    link_.service(now);
    link_.receive(now, [&](const mavlink::Frame& frame) {
      if (const auto text = monitor_.take(frame, now)) output_.note(now, "says", *text);
      if (command_.raw) output_.raw(now, frame);
    });
    if (!command_.silent) speak(now);
    if (now - last_moment_ < hal::from_seconds(command_.every_s)) return;
    if (!command_.raw) output_.moment(moment(now, false));
    monitor_.next_interval();
    last_moment_ = now;
  }
  // A heartbeat a second, as UDP needs somebody to answer to; and what is to be sent, until it comes.
  void speak(hal::Instant now) {
    if (now >= next_heartbeat_ && link_.is_open()) {
      next_heartbeat_ = now + kHeartbeat;
      mavlink::Heartbeat heartbeat;
      heartbeat.type = mavlink::vehicle_type::kOnboardController;
      heartbeat.autopilot = mavlink::autopilot_type::kInvalid;
      heartbeat.system_status = mavlink::system_state::kActive;
      heartbeat.mavlink_version = mavlink::kProtocolVersion;
      link_.send(heartbeat, now);
    }
    const auto* autopilot = monitor_.autopilot();
    if (autopilot == nullptr || ask_.empty() || now < next_ask_) return;
    next_ask_ = now + kAskAgain;
    for (const std::uint32_t id : ask_) {
      if (heard(id)) continue;
      mavlink::CommandLong command;
      command.target_system = autopilot->sysid;
      command.target_component = autopilot->compid;
      command.command = mavlink::command::kSetMessageInterval;
      command.param1 = static_cast<float>(id);
      command.param2 = static_cast<float>(1e6 / command_.rate_hz);
      link_.send(command, now);
    }
  }
  [[nodiscard]] bool heard(std::uint32_t id) const {
    return std::ranges::any_of(monitor_.traffic(), [id](const auto& it) { return it.id == id; });
  }
  [[nodiscard]] std::string why() const {
    return flight::why_silent({.link_open = link_.is_open(),
                               .link_problem = problem_,
                               .serial = bench_.serial(),
                               .parser = link_.parser_stats(),
                               .autopilot_heard = monitor_.autopilot() != nullptr});
  }
  [[nodiscard]] MavlinkMoment moment(hal::Instant now, bool whole) const {
    const bool none = monitor_.autopilot() == nullptr || (!whole && monitor_.interval_frames() == 0);
    return {now, now - last_moment_, link_, monitor_, none ? why() : std::string()};
  }

  const MavlinkCommand& command_;
  std::vector<std::uint32_t> ask_;
  boards::MavlinkBench& bench_;
  MavlinkOutput& output_;
  const std::string& problem_;
  flight::MavlinkLink link_;
  flight::MavlinkMonitor monitor_;
  hal::Instant last_moment_;
  hal::Instant next_heartbeat_;
  hal::Instant next_ask_;
};

hal::Result<std::vector<std::uint32_t>> ids_of(const std::vector<std::string>& names) {
  std::vector<std::uint32_t> ids;
  for (const std::string& name : names) {
    const auto known = mavlink::known_messages();
    const auto found = std::ranges::find(known, std::string_view(name), &mavlink::MessageInfo::name);
    if (found == known.end())
      return hal::fail(hal::ErrorCode::invalid_argument, "mavlink", "--ask " + name,
                       "no message of that name is known",
                       "Names are those of MAVLink's common.xml, such as ATTITUDE or SYS_STATUS");
    ids.push_back(found->id);
  }
  return ids;
}

}  // namespace

int run_mavlink_listen(const MavlinkCommand& command) {
  const auto board = boards::load_board(command.board);
  if (!board) return complain(board.error());
  const auto scene = command.scene.empty() ? boards::bench_scene() : boards::load_scene(command.scene);
  if (!scene) return complain(scene.error());
  auto ask = ids_of(command.ask);
  if (!ask) return complain(ask.error());
  const bool emulated =
      board->kind == boards::BoardKind::sim && command.place.serial.empty() && command.place.listen.empty();
  const bool jumps = emulated && !command.real_time;
  if (jumps && !(command.for_s > 0.0))
    return complain_usage("an emulated autopilot is listened to with --for, or with --real-time");
  const auto clock = jumps ? boards::make_virtual_clock() : boards::make_real_clock(1.0);
  const auto bench = boards::open_mavlink_bench(*board, *scene, command.place, *clock, command.seed);
  if (!bench) return complain(bench.error());
  MavlinkOutput output(command.json);
  std::string problem;
  const auto journal =
      boards::RunJournal::open({}, [&](hal::Instant now, std::string_view source, std::string_view text) {
        if (text.starts_with("link failed")) problem = text.substr(text.find(": ") + 2);
        output.note(now, source, text);
      });
  if (!journal) return complain(journal.error());
  return MavlinkListen(command, *std::move(ask), **bench, **journal, output, problem).run(*clock);
}

void add_mavlink_command(CLI::App& app, int& exit_code) {
  CLI::App* mavlink = app.add_subcommand("mavlink", "Listen to an autopilot");
  mavlink->require_subcommand(1);
  auto command = std::make_shared<MavlinkCommand>();
  CLI::App* sub = mavlink->add_subcommand(
      "listen", "Who is there, in which mode, and which messages come how often; moves nothing");
  sub->add_option("--board", command->board, "Board file with [autopilot], or sim for an emulated one")
      ->capture_default_str();
  auto* serial =
      sub->add_option("--serial", command->place.serial, "Serial port, such as /dev/ttyAMA0, instead");
  sub->add_option("--baud", command->place.baud, "Of the serial port")
      ->capture_default_str()
      ->needs(serial)
      ->check(WholeNumber(12'000'000));
  sub->add_option("--listen", command->place.listen, "HOST:PORT to wait at for UDP, instead")
      ->excludes(serial);
  sub->add_option("--scene", command->scene, "Scene of an emulated autopilot");
  sub->add_option("--for", command->for_s, "Stop after so long, such as 10s; else at Ctrl-C")
      ->transform(TimeSpan(0.01, 1e6));
  sub->add_option("--every", command->every_s, "Time between two tables or lines")
      ->capture_default_str()
      ->transform(TimeSpan(0.05, 3600.0));
  sub->add_option("--ask", command->ask, "Messages the autopilot shall send, such as ATTITUDE,SYS_STATUS")
      ->delimiter(',');
  sub->add_option("--rate", command->rate_hz, "How often, 1/s")
      ->capture_default_str()
      ->check(NumberBetween(0.1, 50.0));
  sub->add_flag("--raw", command->raw, "Every frame as it came, in hex, instead of tables");
  sub->add_flag("--silent", command->silent, "Send nothing, not even a heartbeat");
  sub->add_option("--seed", command->seed, "Of an emulated autopilot")
      ->capture_default_str()
      ->check(WholeNumber());
  sub->add_flag("--real-time", command->real_time, "Let an emulated autopilot live by the clock too");
  sub->add_flag("--json", command->json, "JSON lines on stdout");
  sub->callback([command, &exit_code] { exit_code = run_mavlink_listen(*command); });
}

}  // namespace forager::tools
