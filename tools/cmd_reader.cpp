#include "tools/cmd_reader.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "boards/board.hpp"
#include "boards/reader_bench.hpp"
#include "boards/run_clock.hpp"
#include "boards/scene.hpp"
#include "reader/advannet_rest.hpp"
#include "reader/advannet_wire.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/reader_calls.hpp"
#include "tools/reader_watch.hpp"
#include "tools/stop_signal.hpp"

namespace forager::tools {
namespace {

namespace advannet = reader::advannet;
using Json = nlohmann::ordered_json;

constexpr std::array kParameters{advannet::kReadPower, advannet::kSensitivity, advannet::kSession,
                                 advannet::kTarget,    advannet::kQ,           advannet::kGpiNumber,
                                 advannet::kGpoNumber};

void print(const std::string& line) { fmt::print("{}\n", one_line(line)); }

std::string_view advice(std::string_view status) {
  if (status == advannet::kStatusRunning) return "reading";
  if (status == advannet::kStatusShutdown) return "shut down: 'forager reader watch' connects and starts it";
  return "not started: 'forager reader start' starts it as it is set up, 'forager reader watch' sets it up "
         "first";
}

// One-shot commands: ask, print, gone.
class ReaderQuestions {
 public:
  ReaderQuestions(const ReaderCommand& command, boards::ReaderBench& bench, hal::Clock& clock,
                  advannet::Device device)
      : command_(command),
        calls_(bench, clock, hal::from_seconds(command.timeout_s)),
        url_(bench.rest().name()),
        device_(std::move(device)) {}

  int info() {
    std::vector<std::pair<std::string, std::optional<std::string>>> values;
    for (const std::string_view name : kParameters) {
      auto reply = calls_.ask(advannet::get_parameter(device_.id, name));
      if (!reply) return complain(reply.error());
      values.emplace_back(name, reply->ok ? reply->result : std::nullopt);
    }
    if (command_.json) {
      Json parameters = Json::object();
      for (const auto& [name, value] : values) parameters[name] = value ? Json(*value) : Json(nullptr);
      fmt::print("{}\n", Json{{"event", "reader"},
                              {"at", url_},
                              {"id", device_.id},
                              {"serial", device_.serial},
                              {"family", device_.family},
                              {"status", device_.status},
                              {"parameters", parameters}}
                             .dump(-1, ' ', false, Json::error_handler_t::replace));
      return kExitDone;
    }
    print(fmt::format("{:<15} {} at {}", "reader", device_.id, url_));
    print(fmt::format("{:<15} {}", "serial", device_.serial));
    print(fmt::format("{:<15} {}: {}", "status", device_.status, advice(device_.status)));
    for (const auto& [name, value] : values)
      print(fmt::format("{:<15} {}", name, value.value_or("not known to this reader")));
    return kExitDone;
  }

  int operate(const char* operation, const char* done) {
    auto reply = calls_.demand(advannet::get_operation(device_.id, operation));
    if (!reply) return complain(reply.error());
    if (command_.json)
      fmt::print("{}\n", Json{{"event", operation}, {"id", device_.id}}.dump());
    else
      print(fmt::format("{}: {}", device_.id, done));
    return kExitDone;
  }

  int list_lines() {
    auto inputs = calls_.demand(advannet::get_operation(device_.id, "getGPIAll"));
    if (!inputs) return complain(inputs.error());
    auto outputs = calls_.ask(advannet::get_parameter(device_.id, advannet::kGpoNumber));
    if (!outputs) return complain(outputs.error());
    const std::string count = outputs->ok ? outputs->result.value_or("unknown") : "unknown";
    if (command_.json) {
      Json levels = Json::array();
      for (const auto& input : inputs->inputs) levels.push_back({{"line", input.line}, {"high", input.high}});
      fmt::print("{}\n", Json{{"event", "gpio"}, {"inputs", levels}, {"outputs", count}}.dump());
      return kExitDone;
    }
    for (const auto& input : inputs->inputs)
      print(fmt::format("input {:<3} {}", input.line, input.high ? "high" : "low"));
    print(fmt::format("outputs   {}", count));
    return kExitDone;
  }

  int set_line() {
    if (auto reply = calls_.demand(advannet::set_gpo(device_.id, command_.line, true)); !reply)
      return complain(reply.error());
    print(fmt::format("output {} on for {:g} s", command_.line, command_.hold_s));
    std::fflush(stdout);
    calls_.wait(hal::from_seconds(command_.hold_s));
    const bool interrupted = StopSignal::raised();
    StopSignal::forget();  // off it must go all the same
    if (auto reply = calls_.demand(advannet::set_gpo(device_.id, command_.line, false)); !reply)
      return complain(reply.error());
    print(fmt::format("output {} off", command_.line));
    return interrupted ? kExitFailure : kExitDone;
  }

 private:
  const ReaderCommand& command_;
  ReaderCalls calls_;
  std::string url_;
  advannet::Device device_;
};

int ask_reader(const ReaderCommand& command, const boards::Board& board, const boards::Scene& scene) {
  const StopSignal signals;
  const bool emulated = board.kind == boards::BoardKind::sim;
  const auto clock = emulated ? boards::make_virtual_clock() : boards::make_real_clock(1.0);
  const auto bench = boards::open_reader_bench(board, scene, command.seed);
  if (!bench) return complain(bench.error());
  auto device =
      ReaderCalls(**bench, *clock, hal::from_seconds(command.timeout_s)).find_device(board.reader_device_id);
  if (!device) return complain(device.error());
  ReaderQuestions questions(command, **bench, *clock, *std::move(device));
  switch (command.task) {
    case ReaderTask::start:
      return questions.operate("start", "reading; 'forager reader stop' stops it");
    case ReaderTask::stop:
      return questions.operate("stop", "stopped, the radio is off");
    case ReaderTask::gpio_list:
      return questions.list_lines();
    case ReaderTask::gpio_set:
      return questions.set_line();
    case ReaderTask::info:
    case ReaderTask::watch:
      break;
  }
  return questions.info();
}

using Command = std::shared_ptr<ReaderCommand>;

void add_shared(CLI::App* sub, const Command& command) {
  sub->add_option("--board", command->board, "Board file with [reader], or sim for an emulated one")
      ->capture_default_str();
  sub->add_option("--host", command->host, "Name or address of a reader, instead of the board's");
  sub->add_option("--scene", command->scene, "Scene whose [reader] to use and, emulated, whose tags");
  sub->add_option("--timeout", command->timeout_s, "For each answer of the reader, such as 500ms")
      ->capture_default_str()
      ->transform(TimeSpan(0.05, 60.0));
  sub->add_flag("--json", command->json, "JSON lines on stdout");
}

CLI::App* add_task(CLI::App& reader, const char* name, const char* what, const Command& command,
                   int& exit_code) {
  CLI::App* sub = reader.add_subcommand(name, what);
  add_shared(sub, command);
  sub->callback([command, &exit_code] { exit_code = run_reader_command(*command); });
  return sub;
}

Command make_command(ReaderTask task) {
  auto command = std::make_shared<ReaderCommand>();
  command->task = task;
  return command;
}

void add_watch(CLI::App& reader, int& exit_code) {
  const auto command = make_command(ReaderTask::watch);
  CLI::App* sub =
      add_task(reader, "watch",
               "Set it up, start it, show what it hears on which antenna and why nothing; then stop it",
               command, exit_code);
  sub->add_option("--for", command->for_s, "Stop after so long, such as 10s; else at Ctrl-C")
      ->transform(TimeSpan(0.01, 1e6));
  sub->add_option("--every", command->every_s, "Time between two lines")
      ->capture_default_str()
      ->transform(TimeSpan(0.05, 3600.0));
  sub->add_option("--least", command->least_tags, "Exit code 4 if fewer different tags were heard")
      ->check(WholeNumber());
  auto* listen =
      sub->add_flag("--listen", command->listen,
                    "Only listen to what it sends: it runs for somebody else, and goes on as it is");
  sub->add_option("--session", command->session, "Gen2 session: S0, S1, S2, S3");
  sub->add_option("--target", command->target, "Which inventoried flag answers: A, B, AB, BA");
  sub->add_option("--power", command->power_dbm, "Transmit power of every antenna, dBm")
      ->check(NumberBetween(0.0, 31.5));
  sub->add_option("--sensitivity", command->sensitivity_dbm, "Drop weaker replies, dBm")
      ->check(NumberBetween(-90.0, -20.0));
  sub->add_option("--ports", command->ports, "Antenna ports, such as 1,2,4")
      ->delimiter(',')
      ->check(WholeNumber(32));
  auto* wedge = sub->add_option("--wedge", command->wedge,
                                "Instead of the board's reader one that types as a keyboard, by its name");
  wedge->excludes(listen);
  for (const char* option : {"--session", "--target", "--power", "--sensitivity", "--ports", "--host"})
    wedge->excludes(sub->get_option(option));
  for (const char* option : {"--session", "--target", "--power", "--sensitivity", "--ports"})
    listen->excludes(sub->get_option(option));
  sub->add_option("--seed", command->seed, "Of an emulated reader, its air and its tags")
      ->capture_default_str()
      ->check(WholeNumber());
  sub->add_flag("--real-time", command->real_time, "Let an emulated reader live by the clock too");
}

void add_gpio(CLI::App& reader, int& exit_code) {
  CLI::App* gpio = reader.add_subcommand("gpio", "The reader's own inputs and outputs");
  gpio->require_subcommand(1);
  add_task(*gpio, "list", "Levels of the inputs, number of outputs", make_command(ReaderTask::gpio_list),
           exit_code);
  const auto command = make_command(ReaderTask::gpio_set);
  CLI::App* sub = add_task(*gpio, "set", "Switch an output on for a while, then off", command, exit_code);
  sub->add_option("line", command->line, "Number of the output, from 1")->required()->check(WholeNumber(32));
  sub->add_option("--hold", command->hold_s, "How long it stays on, such as 2s")
      ->required()
      ->transform(TimeSpan(0.01, 600.0));
  sub->add_flag("--arm", command->arm, "Yes, what is wired to it may move");
}

}  // namespace

int run_reader_command(const ReaderCommand& command) {
  auto board = boards::load_board(command.board);
  if (!board) return complain(board.error());
  if (!command.host.empty()) {
    board->kind = boards::BoardKind::socket;
    board->reader_host = command.host;
  }
  const auto scene = command.scene.empty() ? boards::bench_scene() : boards::load_scene(command.scene);
  if (!scene) return complain(scene.error());
  if (command.task == ReaderTask::watch) return watch_reader(command, *board, *scene);
  if (command.task == ReaderTask::gpio_set && !command.arm)
    return complain_usage("nothing moves without --arm: the output will be switched on");
  return ask_reader(command, *board, *scene);
}

void add_reader_command(CLI::App& app, int& exit_code) {
  CLI::App* reader =
      app.add_subcommand("reader", "Look at an RFID reader: what it is, what it hears, why nothing");
  reader->require_subcommand(1);
  add_task(*reader, "info", "Which reader answers, how it is and how it is set up",
           make_command(ReaderTask::info), exit_code);
  add_watch(*reader, exit_code);
  add_task(*reader, "start", "Start it as it is set up", make_command(ReaderTask::start), exit_code);
  add_task(*reader, "stop", "Stop it: the radio goes off", make_command(ReaderTask::stop), exit_code);
  add_gpio(*reader, exit_code);
}

}  // namespace forager::tools
