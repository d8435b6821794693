#include "tools/cmd_generate.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "boards/generate.hpp"
#include "boards/scene.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {

int run_generate_command(const GenerateCommand& command) {
  const auto scene = boards::load_scene(command.scene);
  if (!scene) return complain(scene.error());
  const auto written = command.layout ? boards::write_world_layout(*scene, command.seed, command.output)
                                      : boards::write_world_tags(*scene, command.seed, command.output);
  if (!written) return complain(written.error());
  const std::string line = fmt::format("{} tags in {}\n", *written, one_line(command.output));
  if (const auto said = write_output("-", line); !said) return complain(said.error());
  return kExitDone;
}

void add_generate_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<GenerateCommand>();
  CLI::App* generate =
      app.add_subcommand("generate", "Write the tags of a scene's simulated world into a tag file (CSV)");
  generate->add_option("scene", command->scene, "Scene file, such as scenes/store-1e4.toml")->required();
  generate->add_option("--output", command->output, "The tag file; one that is there is replaced")
      ->type_name("FILE")
      ->required();
  generate->add_option("--seed", command->seed, "Places the tags")
      ->capture_default_str()
      ->check(WholeNumber());
  generate->add_flag("--layout", command->layout,
                     "As the scene lists its tags, wrong where it says so, instead of as they are");
  generate->callback([command, &exit_code] { exit_code = run_generate_command(*command); });
}

}  // namespace forager::tools
