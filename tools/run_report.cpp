#include "tools/run_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/layout_output.hpp"

namespace forager::tools {
namespace {

std::vector<std::pair<std::string, std::string>> facts_of(const boards::RunSummary& s, double wall_time_s) {
  std::vector<std::pair<std::string, std::string>> facts;
  if (s.other_tags_read > 0) facts.emplace_back("other tags", fmt::format("{}", s.other_tags_read));
  if (s.layout) facts.emplace_back("against the layout", layout_line(*s.layout));
  facts.emplace_back("time in flight", fmt::format("{:.1f} s of {:.1f} s", s.flight_time_s, s.sim_time_s));
  facts.emplace_back("time on the clock", fmt::format("{:.2f} s", wall_time_s));
  if (!s.detail.empty()) facts.emplace_back("ended because", s.detail);
  facts.emplace_back("windows", fmt::format("{}", s.windows));
  facts.emplace_back("link losses",
                     fmt::format("reader {}, autopilot {}", s.reader_losses, s.autopilot_losses));
  facts.emplace_back("contacts and hard landings", fmt::format("{}", s.crashes));
  facts.emplace_back("board", s.board);
  return facts;
}

// A browser draws about this many circles without pain; of a larger world, every n-th tag.
constexpr std::size_t kMostDrawn = 20'000;

std::size_t every_nth(std::size_t count) { return count / (kMostDrawn / 2) + 1; }

void add_tags(ReportData& data, const boards::WorldTags& tags, const std::vector<std::uint32_t>& read) {
  const bool all = tags.size() <= kMostDrawn;
  const std::size_t every_read = all ? 1 : every_nth(read.size());
  const std::size_t every_unread = all ? 1 : every_nth(tags.size());
  std::size_t seen = 0;
  for (std::size_t tag = 0; tag < tags.size(); ++tag) {
    const bool is_read = seen < read.size() && read[seen] == tag;
    if (is_read ? seen++ % every_read == 0 : tag % every_unread == 0)
      data.tags.push_back({tags.position(tag), is_read});
  }
  if (!all) data.totals = {tags.size(), read.size()};
}

hal::Result<> add_world(ReportData& data, const boards::WorldFacts& world,
                        const reader::InventoryStore& inventory) {
  for (const boards::SceneShelf& shelf : world.shelves) data.boxes.push_back({shelf.min, shelf.max});
  const auto read = boards::ReadTags::find(world.tags, inventory);
  if (!read) return hal::fail(read.error());
  add_tags(data, world.tags, read->tags);
  return {};
}

}  // namespace

hal::Result<ReportData> report_of(const boards::Run& run, const boards::RunSummary& summary,
                                  const RunWatch& watch, double wall_time_s, hal::Instant ended) {
  ReportData data;
  data.scene = summary.scene;
  data.title = summary.title;
  data.policy = summary.policy;
  data.seed = summary.seed;
  data.end_reason = std::string(to_string(summary.end));
  data.ended = ended;
  if (const boards::WorldFacts* world = run.world()) {
    FORAGER_TRY(add_world(data, *world, run.inventory()));
  }
  for (const auto& point : run.path())
    data.path.push_back(
        {point.at, point.pose_world.position.x, point.pose_world.position.y, point.pose_world.yaw_rad});
  data.path_m = summary.path_m;
  data.decisions = run.status().decisions;
  data.tags_over_time = watch.samples();
  data.events = watch.events();
  for (const boards::PortSummary& port : summary.ports)
    data.ports.push_back(
        {port.port, port.name, static_cast<std::uint32_t>(std::lround(port.new_tags)), port.reads});
  data.facts = facts_of(summary, wall_time_s);
  return data;
}

}  // namespace forager::tools
