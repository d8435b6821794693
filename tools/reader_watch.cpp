#include "tools/reader_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "boards/reader_bench.hpp"
#include "boards/robot_config.hpp"
#include "boards/run_clock.hpp"
#include "boards/run_journal.hpp"
#include "reader/advannet_wire.hpp"
#include "reader/silence.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_style.hpp"
#include "tools/reader_output.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kTick = 5ms;
constexpr hal::Duration kToStop = 5s;  // on top of a request under way

// The outermost loop of the bench.
class ReaderWatch {
 public:
  ReaderWatch(const ReaderCommand& command, const reader::ReadPlan& plan, hal::Clock& clock,
              boards::ReaderBench& bench, reader::AdvanNetReader& reader, ReaderOutput& output,
              const std::string& reader_says)
      : command_(command),
        plan_(plan),
        clock_(clock),
        bench_(bench),
        reader_(reader),
        output_(output),
        reader_says_(reader_says),
        tally_(plan.ports) {}

  int run() {
    BenchLoop loop(clock_, kTick);
    std::optional<hal::Duration> time;
    if (command_.for_s > 0.0) time = hal::from_seconds(command_.for_s);
    last_moment_ = clock_.now();
    reader_.start(last_moment_);
    loop.run(time, [this](hal::Instant now) {
      live(now);
      if (now - last_moment_ >= hal::from_seconds(command_.every_s)) show();
      return reader_.link().phase != reader::LinkPhase::failed;
    });
    return finish();
  }

 private:
  void live(hal::Instant now) {
    bench_.advance(now);
    reader_.update(now);
    tally_.add(reader_.reads());
  }
  [[nodiscard]] ReaderMoment moment(bool whole) const {
    const auto& counters = reader_.counters();
    ReaderMoment moment{clock_.now(),
                        clock_.now() - last_moment_,
                        reader_.link(),
                        counters,
                        tally_,
                        counters.inventories - inventories_,
                        {}};
    if ((whole ? tally_.total() : tally_.interval()).reads == 0)
      moment.why = reader::why_silent({.link = reader_.link(),
                                       .plan = plan_,
                                       .tags_before = tally_.total().tags,
                                       .reads_dropped = counters.stale,
                                       .bad_items = counters.bad_items,
                                       .reader_says = reader_says_});
    return moment;
  }
  void show() {
    output_.moment(moment(false));
    inventories_ = reader_.counters().inventories;
    tally_.next_interval();
    last_moment_ = clock_.now();
  }
  int finish() {
    const ReaderMoment last = moment(true);
    const reader::LinkStatus link = reader_.link();
    output_.end(last);
    reader_.stop(clock_.now());
    const hal::Deadline end(clock_.now(), kToStop + 2 * hal::from_seconds(command_.timeout_s));
    while (!reader_.idle() && !end.expired(clock_.now())) {
      clock_.sleep_until(clock_.now() + kTick);
      live(clock_.now());
    }
    if (reader_.may_radiate())
      return complain({hal::ErrorCode::timeout, "reader", "stop",
                       "it has not confirmed that it stopped radiating",
                       "Switch it off, or ask again: forager reader stop"});
    // A reader without tags is silent for a keep-alive's period, and that is no failure.
    const bool mute = !link.speaks && last.now - link.since > reader::advannet::kKeepAlivePeriod;
    if (link.phase != reader::LinkPhase::open || mute) {
      fmt::print(stderr, "forager: {}\n", one_line(link.reason.empty() ? last.why : link.reason));
      return kExitFailure;
    }
    if (tally_.total().tags >= command_.least_tags) return kExitDone;
    fmt::print(stderr, "forager: {} different tags were heard, fewer than the {} of --least\n",
               tally_.total().tags, command_.least_tags);
    return kExitCheckFailed;
  }

  const ReaderCommand& command_;
  const reader::ReadPlan& plan_;
  hal::Clock& clock_;
  boards::ReaderBench& bench_;
  reader::AdvanNetReader& reader_;
  ReaderOutput& output_;
  const std::string& reader_says_;
  reader::ReadTally tally_;
  hal::Instant last_moment_;
  std::uint64_t inventories_ = 0;
};

// Of the reader's events, those that tell of trouble.
bool is_trouble(std::string_view event) {
  return event.find("ERROR") != std::string_view::npos || event.find("PROBLEM") != std::string_view::npos;
}

}  // namespace

hal::Result<reader::ReadPlan> plan_of(const boards::Scene& scene, const ReaderCommand& command) {
  reader::ReadPlan plan = scene.read_plan;
  if (command.session) {
    auto session = reader::session_from(*command.session);
    if (!session) return hal::fail(std::move(session).error());
    plan.session = *session;
  }
  if (command.target) {
    auto target = reader::target_from(*command.target);
    if (!target) return hal::fail(std::move(target).error());
    plan.target = *target;
  }
  if (command.power_dbm) {
    plan.power_dbm = *command.power_dbm;
    for (auto& port : plan.ports) port.power_dbm.reset();
  }
  if (command.sensitivity_dbm) {
    plan.sensitivity_dbm = *command.sensitivity_dbm;
    for (auto& port : plan.ports) port.sensitivity_dbm.reset();
  }
  if (!command.ports.empty()) {
    std::vector<reader::ReadPort> ports;
    for (const int number : command.ports) {
      const auto known = std::ranges::find(plan.ports, number, &reader::ReadPort::port);
      ports.push_back(
          known != plan.ports.end()
              ? *known
              : reader::ReadPort{
                    static_cast<std::uint8_t>(number), fmt::format("port {}", number), 0.0, {}, {}});
    }
    plan.ports = std::move(ports);
  }
  FORAGER_TRY(reader::validate(plan));
  return plan;
}

reader::AdvanNetConfig driver_config(const ReaderCommand& command, const boards::Board& board,
                                     const boards::Scene& scene) {
  reader::AdvanNetConfig config = boards::advannet_config(scene, board);
  config.request_timeout = hal::from_seconds(command.timeout_s);
  config.status_period = 2s;  // somebody at a bench wants to see at once that the reader was stopped
  config.backoff_cap = 4s;
  return config;
}

int watch_reader(const ReaderCommand& command, const boards::Board& board, const boards::Scene& scene) {
  if (!command.wedge.empty()) return watch_wedge(command, board);
  if (command.listen) return listen_to_reader(command, board, scene);
  const auto plan = plan_of(scene, command);
  if (!plan) return complain(plan.error());
  const bool emulated = board.kind == boards::BoardKind::sim;
  const bool jumps = emulated && !command.real_time;
  if (jumps && !(command.for_s > 0.0))
    return complain_usage("an emulated reader is watched with --for, or with --real-time");
  const auto clock = jumps ? boards::make_virtual_clock() : boards::make_real_clock(1.0);
  ReaderOutput output(command.json);
  std::string reader_says;
  const auto journal =
      boards::RunJournal::open({}, [&](hal::Instant now, std::string_view source, std::string_view text) {
        if (source == "reader" && text.starts_with("event ") && is_trouble(text))
          reader_says = text.substr(6);
        output.note(now, source, text);
      });
  if (!journal) return complain(journal.error());
  const auto bench = boards::open_reader_bench(board, scene, command.seed);
  if (!bench) return complain(bench.error());
  reader::AdvanNetReader reader((*bench)->rest(), (*bench)->events(), **journal, *plan,
                                driver_config(command, board, scene));
  return ReaderWatch(command, *plan, *clock, **bench, reader, output, reader_says).run();
}

}  // namespace forager::tools
