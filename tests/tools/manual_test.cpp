// The manual page and bash's completion, both made by the program of its own description.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::StartsWith;
using testing::UnorderedElementsAreArray;

std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// The commands a help page lists.
std::vector<std::string> commands_in(const std::string& help) {
  std::vector<std::string> commands;
  bool listed = false;
  for (const std::string& line : lines_in(help)) {
    if (line == "Subcommands:") listed = true;
    if (listed && line.starts_with("  ") && line[2] != ' ')
      commands.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return commands;
}

std::set<std::string> options_in(const std::string& help) {
  std::set<std::string> options;
  const std::regex option("--[a-z][a-z0-9-]*");
  for (const std::string& line : lines_in(help)) {
    if (!line.starts_with("  -")) continue;
    const std::string names = line.substr(0, line.find("  ", 3));
    for (auto it = std::sregex_iterator(names.begin(), names.end(), option); it != std::sregex_iterator();
         ++it)
      options.insert(it->str());
  }
  return options;
}

std::string with_minus_signs(std::string text) {
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\\-");
  return text;
}

// What the program tells bash that fits after these words.
std::vector<std::string> completions_of(std::vector<std::string> words, const std::string& begun) {
  words.insert(words.begin(), "__complete");
  words.push_back(begun);
  return lines_in(run_program(words).out);
}

// Looks at a command and all below it; gives how many there were.
int check_command(const std::vector<std::string>& words, const std::string& page) {
  std::vector<std::string> arguments = words;
  arguments.emplace_back("--help");
  const std::string help = run_program(arguments).out;
  const auto commands = commands_in(help);
  int count = 1;
  if (commands.empty()) {
    EXPECT_THAT(completions_of(words, "--"), UnorderedElementsAreArray(options_in(help)));
  } else {
    EXPECT_THAT(completions_of(words, ""), UnorderedElementsAreArray(commands));
  }
  for (const std::string& command : commands) {
    std::vector<std::string> inner = words;
    inner.push_back(command);
    count += check_command(inner, page);
  }
  if (!commands.empty()) return count;
  std::string name = "forager";
  for (const std::string& word : words) name += " " + word;
  const std::size_t begin = page.find(".SS " + with_minus_signs(name) + "\n");
  EXPECT_NE(begin, std::string::npos) << name;
  if (begin == std::string::npos) return count;
  const std::string section = page.substr(begin, page.find("\n.S", begin + 1) - begin);
  for (const std::string& option : options_in(help))
    if (option != "--help") {
      EXPECT_THAT(section, HasSubstr("\\fB" + with_minus_signs(option) + "\\fR")) << name;
    }
  return count;
}

TEST(ManualPage, HasEveryCommandWithAllOfItsOptionsAndSoDoesTheCompletion) {
  const ProgramResult page = run_program({"manual"});
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_THAT(page.out, StartsWith(".TH FORAGER 1"));
  EXPECT_GT(check_command({}, page.out), 20);
}

TEST(ManualPage, CanBeWrittenToAFile) {
  const test::ScratchFolder folder;
  EXPECT_EQ(run_program({"manual", "--output", folder.file("forager.1")}).exit_code, 0);
  EXPECT_EQ(folder.read("forager.1"), run_program({"manual"}).out);
  const ProgramResult nowhere = run_program({"manual", "--output", folder.file("no/such/forager.1")});
  EXPECT_EQ(nowhere.exit_code, 3);
}

// What bash offers after these words, the last of which is being typed.
std::vector<std::string> offered(const std::vector<std::string>& words) {
  std::string script = "cd " + test::source_path(".") +
                       " && source tools/forager.bash-completion && COMP_WORDS=(" + test::program();
  for (const std::string& word : words) script += " '" + word + "'";
  script += ") && COMP_CWORD=" + std::to_string(words.size()) +
            " && _forager && printf '%s\\n' \"${COMPREPLY[@]}\"";
  const std::string command =
      "bash --norc --noprofile -c \"" + std::regex_replace(script, std::regex("([\"$])"), "\\$1") + "\"";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string out;
  std::array<char, 4096> room{};
  for (std::size_t got = 0; (got = std::fread(room.data(), 1, room.size(), pipe.get())) > 0;)
    out.append(room.data(), got);
  return lines_in(out);
}

TEST(BashCompletion, OffersCommands) {
  EXPECT_THAT(offered({"rep"}), IsSupersetOf({"report", "reproduce"}));
  EXPECT_THAT(offered({""}), IsSupersetOf({"run", "reader", "mavlink", "emulate"}));
  EXPECT_THAT(offered({"reader", "w"}), ElementsAre("watch"));
  EXPECT_THAT(offered({"reader", "gpio", ""}), ElementsAre("list", "set"));
}

TEST(BashCompletion, OffersOptionsOfTheCommand) {
  EXPECT_THAT(offered({"reader", "watch", "--s"}),
              ElementsAre("--scene", "--session", "--sensitivity", "--seed"));
  EXPECT_THAT(offered({"run", "scenes/4A.toml", "--bo"}), Contains("--board"));
}

TEST(BashCompletion, OffersScenesAndBoards) {
  EXPECT_THAT(offered({"run", "scenes/4"}), Contains("scenes/4A.toml"));
  EXPECT_THAT(offered({"run", "scenes/4"}), Each(StartsWith("scenes/4")));
  EXPECT_THAT(offered({"run", "scenes/4A.toml", "--board", "boards/em"}),
              ElementsAre("boards/emulated.toml"));
  EXPECT_THAT(offered({"reader", "info", "--board", "s"}), Contains("sim"));
  EXPECT_THAT(offered({"reader", "watch", "--scene", "scenes/lab"}), ElementsAre("scenes/lab.toml"));
}

}  // namespace
}  // namespace forager::tools
