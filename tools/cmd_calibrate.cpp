#include "tools/cmd_calibrate.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "boards/calibration.hpp"
#include "boards/published_fit.hpp"
#include "boards/scene.hpp"
#include "tools/calibrate_output.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/published_fit_output.hpp"

namespace forager::tools {
namespace {

int fail_with(const hal::Error& error) {
  const int code = complain(error);
  return error.code == hal::ErrorCode::refused ? kExitCheckFailed : code;
}

int print(const std::string& html, const std::string& page, const std::string& text) {
  if (!html.empty())
    if (const auto written = write_output(html, page); !written) return complain(written.error());
  if (html != "-")
    if (const auto written = write_output("-", text); !written) return complain(written.error());
  return kExitDone;
}

int write_recording(const CalibrateCommand& command, const boards::Scene& scene) {
  const auto recording = boards::simulate_recording(scene, command.seed, command.seconds);
  if (!recording) return complain(recording.error());
  std::error_code code;
  std::filesystem::create_directories(command.simulate, code);
  const std::pair<const char*, std::string> files[] = {{"reads.csv", boards::reads_csv(*recording)},
                                                       {"poses.csv", boards::poses_csv(*recording)},
                                                       {"tags.csv", boards::tags_csv(*recording)}};
  for (const auto& [name, text] : files)
    if (const auto written = write_output(command.simulate + "/" + name, text); !written)
      return complain(written.error());
  std::fprintf(stderr, "forager: wrote %zu reads of %zu tags to %s\n", recording->reads.size(),
               recording->tags.size(), one_line(command.simulate).c_str());
  return kExitDone;
}

int fit_published(const CalibrateCommand& command) {
  boards::PublishedFitOptions options;
  options.folder = command.folder;
  options.seeds = command.seeds;
  options.evaluations = static_cast<int>(command.evaluations);
  if (command.start.size() == 3)
    options.start = boards::CalibrationParameters{command.start[0], command.start[1], command.start[2]};
  const bool terminal = isatty(STDERR_FILENO) == 1;
  if (terminal)
    options.progress = [](int evaluation, double rms) {
      std::fprintf(stderr, "\r\x1b[Kset %d: %.2f points", evaluation, rms);
      std::fflush(stderr);
    };
  const auto fit = boards::fit_published(options);
  if (terminal) std::fputs("\r\x1b[K", stderr);
  if (!fit) return fail_with(fit.error());
  return print(command.html, published_fit_page(*fit),
               command.json ? published_fit_json(*fit) : published_fit_table(*fit));
}

int fit_recording(const CalibrateCommand& command, const boards::Scene& scene) {
  const auto recording = boards::load_recording(command.reads, command.poses, command.tags);
  if (!recording) return complain(recording.error());
  boards::CalibrationOptions options;
  options.spread_db = command.spread_db;
  options.rician_k_db = command.rician_k_db;
  const auto result = boards::calibrate(*recording, scene, options);
  if (!result) return fail_with(result.error());
  return print(command.html, calibration_page(*result),
               command.json ? calibration_json(*result) : calibration_table(*result));
}

}  // namespace

int run_calibrate_command(const CalibrateCommand& command) {
  const bool recorded = !command.reads.empty() || !command.poses.empty() || !command.tags.empty();
  if (int{recorded} + int{command.published} + int{!command.simulate.empty()} != 1)
    return complain_usage("calibrate: give --reads, --poses and --tags, or --published, or --simulate");
  if (recorded && (command.reads.empty() || command.poses.empty() || command.tags.empty()))
    return complain_usage("calibrate: --reads, --poses and --tags go together");
  if (command.published) return fit_published(command);
  const auto scene = boards::load_scene(command.scene);
  if (!scene) return complain(scene.error());
  return recorded ? fit_recording(command, *scene) : write_recording(command, *scene);
}

void add_calibrate_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<CalibrateCommand>();
  CLI::App* calibrate = app.add_subcommand(
      "calibrate", "Fit R0, spread and fade to a recorded run or to the published totals, with intervals");
  calibrate->add_option("--reads", command->reads, "CSV of reads: time_s,epc,port,rssi");
  calibrate->add_option("--poses", command->poses, "CSV of poses: time_s,x,y,z,yaw (m, rad)");
  calibrate->add_option("--tags", command->tags, "CSV of tags whose place is known: epc,x,y,z");
  calibrate->add_option("--scene", command->scene, "Scene with the antennas, T0 and the power-up limit")
      ->capture_default_str();
  calibrate->add_option("--spread-db", command->spread_db, "Hold the spread at this instead of fitting it")
      ->check(NumberBetween(0.0, 12.0));
  calibrate
      ->add_option("--rician-k-db", command->rician_k_db, "Hold the fade's K at this instead of fitting it")
      ->check(NumberBetween(-10.0, 30.0));
  calibrate->add_flag("--published", command->published,
                      "Fit to the published totals by flying the experiments");
  calibrate->add_option("--scenes", command->folder, "Folder of the published scenes")->capture_default_str();
  calibrate->add_option("--seeds", command->seeds, "With --published: missions of each experiment")
      ->capture_default_str()
      ->check(WholeNumber(1, 1000));
  calibrate
      ->add_option("--evaluations", command->evaluations, "With --published: parameter sets to try at most")
      ->capture_default_str()
      ->check(WholeNumber(1, 100000));
  calibrate
      ->add_option("--start", command->start,
                   "With --published: R0 [m], spread [dB] and K [dB] to start from instead of the scenes'")
      ->expected(3)
      ->check(NumberBetween(0.0, 40.0));
  calibrate->add_option("--simulate", command->simulate,
                        "Write a simulated recording of the scene to this folder");
  calibrate->add_option("--seconds", command->seconds, "With --simulate: its length")
      ->capture_default_str()
      ->check(NumberBetween(1.0, 36000.0));
  calibrate->add_option("--seed", command->seed, "With --simulate: seed of everything random")
      ->capture_default_str()
      ->check(WholeNumber());
  calibrate->add_option("--html", command->html,
                        "Write a page with plot and residuals to this file, - for stdout");
  calibrate->add_flag("--json", command->json,
                      "JSON lines: parameters with low and high, residuals, a closing row");
  calibrate->callback([command, &exit_code] { exit_code = run_calibrate_command(*command); });
}

}  // namespace forager::tools
