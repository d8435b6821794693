#include "tools/cmd_emulate.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "boards/emulate.hpp"
#include "boards/run_clock.hpp"
#include "boards/run_journal.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/emulate_watch.hpp"
#include "tools/stop_signal.hpp"

namespace forager::tools {
namespace {

using WallClock = std::chrono::steady_clock;

// Of the device's time: short against every delay of the emulated devices. However fast its time runs, the
// process wakes up at most once in a millisecond of ours.
hal::Duration tick_at(double speed) {
  constexpr hal::Duration kTick = std::chrono::milliseconds(5);
  constexpr double kWallTickS = 1e-3;
  return std::max(kTick, hal::from_seconds(kWallTickS * speed));
}

// The outermost loop: the only one that waits. What it missed while the machine was busy, the device makes up
// for in one update.
void serve(boards::EmulatedServer& server, hal::Clock& clock, const EmulateCommand& command,
           EmulateWatch& watch) {
  const StopSignal signals;
  const auto start = WallClock::now();
  const hal::Duration tick = tick_at(command.speed);
  watch.listening(server);
  for (hal::Instant next = clock.now(); !StopSignal::raised(); next = std::max(next + tick, clock.now())) {
    clock.sleep_until(next);
    server.update(clock.now());
    const double wall_s = std::chrono::duration<double>(WallClock::now() - start).count();
    watch.update(server, clock.now(), wall_s);
    if (command.for_s > 0.0 && wall_s >= command.for_s) break;
  }
  watch.ended(StopSignal::raised() ? StopSignal::name() : "its time is over");
}

// `make` opens the device: (scene, journal) -> Result<unique_ptr<EmulatedServer>>.
template <class Make>
int emulate(const char* device, const EmulateCommand& command, const Make& make) {
  const auto scene = boards::load_scene(command.scene);
  if (!scene) return complain(scene.error());
  const auto clock = boards::make_real_clock(command.speed);
  EmulateWatch watch({.device = device,
                      .json = command.json,
                      .notes = !command.quiet,
                      .status_line = !command.json && !command.quiet && isatty(STDERR_FILENO) != 0},
                     clock->now());
  const auto journal =
      boards::RunJournal::open({}, [&watch](hal::Instant now, std::string_view source,
                                            std::string_view text) { watch.note(now, source, text); });
  if (!journal) return complain(journal.error());
  const auto server = make(*scene, **journal);
  if (!server) return complain(server.error());
  serve(**server, *clock, command, watch);
  return kExitDone;
}

hal::Result<std::string> password_of(const EmulateReaderCommand& command) {
  if (command.user.empty()) return std::string();
  const char* password = std::getenv(command.password_env.c_str());
  if (password == nullptr)
    return hal::fail(hal::ErrorCode::not_present, "emulated reader", "--password-env",
                     fmt::format("the environment variable {} is not set", command.password_env),
                     fmt::format("Set it: export {}=...", command.password_env));
  return std::string(password);
}

void add_shared(CLI::App* sub, const std::shared_ptr<EmulateCommand>& command) {
  sub->add_option("scene", command->scene, "Scene file, such as scenes/4A.toml")->required();
  sub->add_option("--seed", command->seed, "Seed of everything random, the same as the run's")
      ->capture_default_str()
      ->check(WholeNumber());
  sub->add_option("--speed", command->speed, "Real time, this many times as fast, the same as the run's")
      ->check(CLI::Range(0.01, 100.0));
  sub->add_option("--for", command->for_s, "Stop after so many seconds on the clock")
      ->check(NumberBetween(0.001, 1e9));
  sub->add_flag("--json", command->json, "JSON lines on stdout");
  sub->add_flag("--quiet", command->quiet, "Neither notes nor status");
}

void add_reader(CLI::App& emulate, int& exit_code) {
  auto command = std::make_shared<EmulateReaderCommand>();
  CLI::App* sub = emulate.add_subcommand("reader", "The scene's RFID reader, its tags and the air between");
  add_shared(sub, command);
  sub->add_option("--host", command->host, "Address to listen at")->capture_default_str();
  sub->add_option("--rest-port", command->rest_port, "TCP port of REST; 0: any")
      ->capture_default_str()
      ->check(WholeNumber(65535));
  sub->add_option("--stream-port", command->stream_port, "TCP port of the event stream; 0: any")
      ->capture_default_str()
      ->check(WholeNumber(65535));
  sub->add_option("--truth", command->truth, "HOST:PORT where the autopilot tells where the vehicle is")
      ->capture_default_str();
  auto* user = sub->add_option("--user", command->user, "Demand digest login by this user");
  auto* password =
      sub->add_option("--password-env", command->password_env, "Environment variable with the password");
  user->needs(password);
  password->needs(user);
  sub->callback([command, &exit_code] { exit_code = run_emulate_reader_command(*command); });
}

void add_autopilot(CLI::App& emulate, int& exit_code) {
  auto command = std::make_shared<EmulateAutopilotCommand>();
  CLI::App* sub = emulate.add_subcommand("autopilot", "The scene's flight controller and vehicle");
  add_shared(sub, command);
  sub->add_option("--listen", command->listen, "HOST:PORT of MAVLink over UDP; port 0: any")
      ->capture_default_str();
  sub->add_option("--serial", command->serial,
                  "Make a serial port of this name and be at its other end instead")
      ->excludes("--listen");
  sub->add_option("--truth", command->truth,
                  "HOST:PORT that is told where the vehicle is; repeat it for several")
      ->allow_extra_args(false)
      ->capture_default_str();
  sub->add_option("--refuse-arming", command->refuse_arming, "Refuse to arm, giving this reason");
  sub->callback([command, &exit_code] { exit_code = run_emulate_autopilot_command(*command); });
}

}  // namespace

int run_emulate_reader_command(const EmulateReaderCommand& command) {
  auto truth = boards::endpoint_from(command.truth, boards::AnyPort::allowed);
  if (!truth) return complain(truth.error());
  auto password = password_of(command);
  if (!password) return complain(password.error());
  const boards::EmulatedReaderOptions options{.host = command.host,
                                              .rest_port = command.rest_port,
                                              .stream_port = command.stream_port,
                                              .truth = *std::move(truth),
                                              .seed = command.seed,
                                              .user = command.user,
                                              .password = *std::move(password)};
  return emulate("reader", command, [&options](const boards::Scene& scene, hal::Journal& journal) {
    return boards::emulate_reader(scene, options, journal);
  });
}

int run_emulate_autopilot_command(const EmulateAutopilotCommand& command) {
  auto listen = boards::endpoint_from(command.listen, boards::AnyPort::allowed);
  if (!listen) return complain(listen.error());
  boards::EmulatedAutopilotOptions options;
  options.listen = *std::move(listen);
  options.serial = command.serial;
  options.seed = command.seed;
  options.refuse_arming = command.refuse_arming;
  for (const std::string& text : command.truth) {
    auto listener = boards::endpoint_from(text);
    if (!listener) return complain(listener.error());
    options.truth.push_back(*std::move(listener));
  }
  return emulate("autopilot", command, [&options](const boards::Scene& scene, hal::Journal& journal) {
    return boards::emulate_autopilot(scene, options, journal);
  });
}

void add_emulate_command(CLI::App& app, int& exit_code) {
  CLI::App* emulate = app.add_subcommand("emulate", "Serve an emulated device of a scene on real sockets");
  emulate->require_subcommand(1);
  add_reader(*emulate, exit_code);
  add_autopilot(*emulate, exit_code);
}

}  // namespace forager::tools
