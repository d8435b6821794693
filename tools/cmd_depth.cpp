#include "tools/cmd_depth.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "boards/board.hpp"
#include "boards/depth_bench.hpp"
#include "boards/reader_bench.hpp"
#include "boards/run_clock.hpp"
#include "boards/scene.hpp"
#include "flight/depth_sectors.hpp"
#include "flight/obstacle_guard.hpp"
#include "hal/units.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using Json = nlohmann::ordered_json;
using flight::DepthSector;

double rounded(double value) { return std::round(value * 1000.0) / 1000.0; }

// What one frame came to.
struct Look {
  hal::Instant now;
  hal::DepthFrame frame;
  flight::GuardVerdict verdict;
  std::vector<DepthSector> sectors;
  double speed_m_s = 0.0;

  [[nodiscard]] const DepthSector* nearest() const {
    const DepthSector* found = nullptr;
    for (const DepthSector& it : sectors)
      if (it.nearest_m && (found == nullptr || *it.nearest_m < *found->nearest_m)) found = &it;
    return found;
  }
  [[nodiscard]] double valid_share() const {
    double pixels = 0.0;
    double valid = 0.0;
    for (const DepthSector& it : sectors) {
      pixels += it.pixels;
      valid += it.valid;
    }
    return pixels > 0.0 ? valid / pixels : 0.0;
  }
};

double middle_deg(const DepthSector& it) { return hal::rad_to_deg(0.5 * (it.left_rad + it.right_rad)); }

std::string guard_text(const Look& look) {
  const auto& verdict = look.verdict;
  std::string text = fmt::format("guard at {:g} m/s: {}", look.speed_m_s, to_string(verdict.way));
  if (verdict.way != flight::WayAhead::clear) text += fmt::format(" ({})", verdict.reason);
  if (verdict.way != flight::WayAhead::blind)
    text += fmt::format(", {:.2f} m free ahead, {:.2f} m wanted", verdict.range_m, verdict.required_m);
  return text;
}

std::vector<std::string> lines_of(const Look& look) {
  const auto& camera = look.frame.camera;
  std::vector<std::string> lines{
      fmt::format("{:.2f} s  {} x {} pixels, {:.0f} % measured, {:.0f} ms old", hal::to_seconds(look.now),
                  camera.columns, camera.rows, 100.0 * look.valid_share(),
                  1e3 * hal::to_seconds(look.now - look.frame.stamp)),
      guard_text(look)};
  const DepthSector* nearest = look.nearest();
  lines.push_back(nearest != nullptr ? fmt::format("nearest at the body's height: {:.2f} m at {:+.0f} deg",
                                                   *nearest->nearest_m, middle_deg(*nearest))
                                     : std::string("nearest at the body's height: nothing"));
  for (const DepthSector& it : look.sectors) {
    const double bar_m = it.nearest_m.value_or(camera.max_m);
    lines.push_back(
        fmt::format("{:+6.0f} deg  {:>7}  {:>4.0f} %  {}", middle_deg(it),
                    it.nearest_m ? fmt::format("{:.2f} m", *it.nearest_m) : "free",
                    it.pixels > 0 ? 100.0 * it.valid / it.pixels : 0.0,
                    std::string(static_cast<std::size_t>(std::max(0.0, 40.0 * bar_m / camera.max_m)), '#')));
  }
  return lines;
}

std::string line_of(const Look& look) {
  const DepthSector* nearest = look.nearest();
  return fmt::format("{:9.2f} s  {}; nearest {}", hal::to_seconds(look.now), guard_text(look),
                     nearest != nullptr
                         ? fmt::format("{:.2f} m at {:+.0f} deg", *nearest->nearest_m, middle_deg(*nearest))
                         : std::string("nothing"));
}

Json json_of(const Look& look) {
  Json sectors = Json::array();
  for (const DepthSector& it : look.sectors)
    sectors.push_back({{"left_deg", rounded(hal::rad_to_deg(it.left_rad))},
                       {"right_deg", rounded(hal::rad_to_deg(it.right_rad))},
                       {"nearest_m", it.nearest_m ? Json(rounded(*it.nearest_m)) : Json(nullptr)},
                       {"valid", it.valid},
                       {"pixels", it.pixels}});
  return {{"event", "frame"},
          {"t_s", hal::to_seconds(look.now)},
          {"age_s", hal::to_seconds(look.now - look.frame.stamp)},
          {"columns", look.frame.camera.columns},
          {"rows", look.frame.camera.rows},
          {"guard",
           {{"way", to_string(look.verdict.way)},
            {"reason", look.verdict.reason},
            {"range_m", rounded(look.verdict.range_m)},
            {"required_m", rounded(look.verdict.required_m)},
            {"speed_m_s", look.speed_m_s}}},
          {"sectors", sectors}};
}

// The outermost loop of the bench.
class DepthLook {
 public:
  DepthLook(const DepthCommand& command, const boards::Scene& scene, boards::DepthBench& bench)
      : command_(command), bench_(bench), guard_(scene.guard), out_(command.json) {}

  int run(hal::Clock& clock) {
    BenchLoop loop(clock);
    const hal::Instant start = clock.now();
    std::optional<hal::Duration> time;
    if (command_.watch && command_.for_s > 0.0) time = hal::from_seconds(command_.for_s);
    const hal::Duration within = hal::from_seconds(command_.within_s);
    loop.run(time, [&](hal::Instant now) {
      if (!step(now)) return false;
      return shown_ ? command_.watch : now - start < within;
    });
    if (failure_) return complain(*failure_);
    if (shown_) return kExitDone;
    return complain({hal::ErrorCode::timeout, "depth camera", "wait for a frame",
                     fmt::format("none came within {:g} s", hal::to_seconds(clock.now() - start)),
                     "Check the camera's cable and its power"});
  }

 private:
  bool step(hal::Instant now) {
    bench_.advance(now);
    const auto frame = bench_.camera().poll(now);
    if (!frame) {
      failure_ = frame.error();
      return false;
    }
    if (!*frame || now < next_) return true;
    next_ = now + hal::from_seconds(command_.every_s);
    show({now, **frame, guard_.check(**frame, command_.speed_m_s, 0.0, now),
          flight::depth_sectors(**frame, guard_.config(), command_.sectors), command_.speed_m_s});
    return true;
  }
  void show(const Look& look) {
    shown_ = true;
    if (out_.json()) return out_.record(json_of(look));
    if (!command_.watch) {
      for (const std::string& line : lines_of(look)) out_.line(line);
    } else if (LiveView::possible()) {
      out_.live(lines_of(look));
    } else {
      out_.line(line_of(look));
    }
  }

  const DepthCommand& command_;
  boards::DepthBench& bench_;
  flight::ObstacleGuard guard_;
  BenchOutput out_;
  bool shown_ = false;
  hal::Instant next_;
  std::optional<hal::Error> failure_;
};

void add_shared(CLI::App* sub, const std::shared_ptr<DepthCommand>& command, int& exit_code) {
  sub->add_option("--board", command->board, "Board file, or sim for an emulated camera that stands")
      ->capture_default_str();
  sub->add_option("--scene", command->scene, "Scene whose [camera], [guard] and shelves to use");
  sub->add_option("--speed", command->speed_m_s, "Forward speed the guard is asked for, m/s")
      ->capture_default_str()
      ->check(NumberBetween(0.0, 20.0));
  sub->add_option("--sectors", command->sectors, "Slices the view is cut into")
      ->capture_default_str()
      ->check(WholeNumber(360));
  sub->add_option("--within", command->within_s, "Time for the first frame")
      ->capture_default_str()
      ->transform(TimeSpan(0.01, 600.0));
  sub->add_option("--seed", command->seed, "Of an emulated camera")
      ->capture_default_str()
      ->check(WholeNumber());
  sub->add_flag("--json", command->json, "JSON lines on stdout");
  sub->callback([command, &exit_code] { exit_code = run_depth_command(*command); });
}

}  // namespace

int run_depth_command(const DepthCommand& command) {
  const auto board = boards::load_board(command.board);
  if (!board) return complain(board.error());
  const auto scene = command.scene.empty() ? boards::bench_scene() : boards::load_scene(command.scene);
  if (!scene) return complain(scene.error());
  const bool jumps = board->kind == boards::BoardKind::sim && !command.real_time;
  if (jumps && command.watch && !(command.for_s > 0.0))
    return complain_usage("an emulated camera is watched with --for, or with --real-time");
  const auto clock = jumps ? boards::make_virtual_clock() : boards::make_real_clock(1.0);
  const auto bench = boards::open_depth_bench(*board, *scene, command.seed);
  if (!bench) return complain(bench.error());
  return DepthLook(command, *scene, **bench).run(*clock);
}

void add_depth_command(CLI::App& app, int& exit_code) {
  CLI::App* depth =
      app.add_subcommand("depth", "Look through the depth camera, and what the guard makes of it");
  depth->require_subcommand(1);
  add_shared(depth->add_subcommand("frame", "One frame: sectors, the nearest obstacle, the guard's verdict"),
             std::make_shared<DepthCommand>(), exit_code);
  auto command = std::make_shared<DepthCommand>();
  command->watch = true;
  CLI::App* sub = depth->add_subcommand("watch", "The same again and again");
  add_shared(sub, command, exit_code);
  sub->add_option("--for", command->for_s, "Stop after so long, such as 10s; else at Ctrl-C")
      ->transform(TimeSpan(0.01, 1e6));
  sub->add_option("--every", command->every_s, "Time between two looks")
      ->capture_default_str()
      ->transform(TimeSpan(0.02, 3600.0));
  sub->add_flag("--real-time", command->real_time, "Let an emulated camera live by the clock too");
}

}  // namespace forager::tools
