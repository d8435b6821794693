#include <fmt/format.h>

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "boards/reader_bench.hpp"
#include "boards/run_clock.hpp"
#include "boards/run_journal.hpp"
#include "boards/wedge_bench.hpp"
#include "reader/advannet_listener.hpp"
#include "reader/advannet_wire.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_style.hpp"
#include "tools/reader_output.hpp"
#include "tools/reader_watch.hpp"

namespace forager::tools {
namespace {

constexpr hal::Duration kTick = std::chrono::milliseconds(5);

std::string why_silent(const reader::LinkStatus& link, bool wedge) {
  if (link.phase != reader::LinkPhase::open)
    return fmt::format("the link is {}{}{}", to_string(link.phase), link.reason.empty() ? "" : ": ",
                       link.reason);
  if (wedge)
    return "it is plugged in and types nothing: no tag in reach, or it is not set to type what it reads";
  if (!link.speaks) return "the event stream is open, and not even keep-alives have come";
  return "it sends keep-alives and no reads: stopped, or no tag in reach; ask it how it is: forager reader "
         "info";
}

// Names of ports are of a plan, which only who runs the reader has; one that types tells no port at all.
std::vector<reader::ReadPort> ports_of(const ReaderCommand& command) {
  if (command.wedge.empty()) return {};
  return {{0, "typed", 0.0, {}, {}}};
}

// The outermost loop.
class ReaderListen {
 public:
  // `advance` lets an emulated reader live.
  ReaderListen(const ReaderCommand& command, reader::TagReader& reader,
               const reader::AdvanNetCounters& counters, hal::Clock& clock, ReaderOutput& output,
               std::function<void(hal::Instant)> advance)
      : command_(command),
        reader_(reader),
        counters_(counters),
        clock_(clock),
        output_(output),
        advance_(std::move(advance)),
        tally_(ports_of(command)) {}

  int run() {
    BenchLoop loop(clock_, kTick);
    last_moment_ = clock_.now();
    reader_.start(last_moment_);
    const auto time = command_.for_s > 0.0 ? std::optional(hal::from_seconds(command_.for_s)) : std::nullopt;
    loop.run(time, [this](hal::Instant now) {
      advance_(now);
      reader_.update(now);
      tally_.add(reader_.reads());
      if (now - last_moment_ >= hal::from_seconds(command_.every_s)) show();
      return reader_.link().phase != reader::LinkPhase::failed;
    });
    const ReaderMoment last = moment(true);
    output_.end(last);
    // A reader without tags is silent for a keep-alive's period, and that is no failure.
    const reader::LinkStatus& link = reader_.link();
    const bool mute = !link.speaks && last.now - link.since > reader::advannet::kKeepAlivePeriod;
    if (link.phase != reader::LinkPhase::open || mute) {
      fmt::print(stderr, "forager: {}\n", one_line(last.why.empty() ? link.reason : last.why));
      return kExitFailure;
    }
    if (tally_.total().tags >= command_.least_tags) return kExitDone;
    fmt::print(stderr, "forager: {} different tags were heard, fewer than the {} of --least\n",
               tally_.total().tags, command_.least_tags);
    return kExitCheckFailed;
  }

 private:
  [[nodiscard]] ReaderMoment moment(bool whole) const {
    ReaderMoment moment{clock_.now(),
                        clock_.now() - last_moment_,
                        reader_.link(),
                        counters_,
                        tally_,
                        counters_.inventories - inventories_,
                        {}};
    if ((whole ? tally_.total() : tally_.interval()).reads == 0)
      moment.why = why_silent(reader_.link(), !command_.wedge.empty());
    return moment;
  }
  void show() {
    output_.moment(moment(false));
    inventories_ = counters_.inventories;
    tally_.next_interval();
    last_moment_ = clock_.now();
  }

  const ReaderCommand& command_;
  reader::TagReader& reader_;
  const reader::AdvanNetCounters& counters_;
  hal::Clock& clock_;
  ReaderOutput& output_;
  std::function<void(hal::Instant)> advance_;
  reader::ReadTally tally_;
  hal::Instant last_moment_;
  std::uint64_t inventories_ = 0;
};

}  // namespace

int listen_to_reader(const ReaderCommand& command, const boards::Board& board, const boards::Scene& scene) {
  if (board.kind == boards::BoardKind::sim)
    return complain_usage("a reader emulated in this program runs for nobody else: give --board or --host");
  const auto clock = boards::make_real_clock(1.0);
  ReaderOutput output(command.json);
  const auto journal =
      boards::RunJournal::open({}, [&output](hal::Instant now, std::string_view source,
                                             std::string_view text) { output.note(now, source, text); });
  if (!journal) return complain(journal.error());
  const auto bench = boards::open_reader_bench(board, scene, command.seed);
  if (!bench) return complain(bench.error());
  reader::AdvanNetListener reader((*bench)->events(), **journal, driver_config(command, board, scene));
  return ReaderListen(command, reader, reader.counters(), *clock, output, [](hal::Instant) {}).run();
}

int watch_wedge(const ReaderCommand& command, const boards::Board& board) {
  const auto wanted = boards::find_wedge(board.bench, command.wedge);
  if (!wanted) return complain(wanted.error());
  const auto bench = boards::open_wedge_bench(*wanted);
  if (!bench) return complain(bench.error());
  const bool jumps = (*bench)->emulated() && !command.real_time;
  if (jumps && !(command.for_s > 0.0))
    return complain_usage("an emulated reader is watched with --for, or with --real-time");
  const auto clock = jumps ? boards::make_virtual_clock() : boards::make_real_clock(1.0);
  ReaderOutput output(command.json);
  reader::HidWedge reader((*bench)->hid(), boards::wedge_config(*wanted));
  const reader::AdvanNetCounters none;
  return ReaderListen(command, reader, none, *clock, output,
                      [&](hal::Instant now) { (*bench)->advance(now); })
      .run();
}

}  // namespace forager::tools
