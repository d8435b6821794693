#include "tools/completion.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace forager::tools {
namespace {

const CLI::App* inner_command(const CLI::App& app, const std::string& word) {
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (command->get_name() == word) return command;
  return nullptr;
}

const CLI::Option* option_named(const CLI::App& app, const std::string& word) {
  for (const CLI::Option* option : app.get_options())
    if (!option->get_positional() && option->check_name(word)) return option;
  return nullptr;
}

// Options and places whose value is a scene or a board.
std::string kind_of_file(const std::string& name) {
  return name == "scene" || name == "board" || name == "truth" ? ":toml" : ":files";
}

void add_if_fits(std::vector<std::string>& out, const std::string& word, const std::string& candidate) {
  if (candidate.starts_with(word)) out.push_back(candidate);
}

std::vector<std::string> values_of(const CLI::Option& option, const std::string& word) {
  std::vector<std::string> out;
  const std::string name = option.get_lnames().empty() ? option.get_name(true) : option.get_lnames().front();
  if (name == "board") add_if_fits(out, word, "sim");
  out.push_back(kind_of_file(name));
  return out;
}

}  // namespace

std::vector<std::string> completions(const CLI::App& app, std::span<const std::string> words) {
  const CLI::App* command = &app;
  const CLI::Option* awaits = nullptr;  // an option whose value comes next
  std::size_t places = 0;               // positional words so far
  const std::string word = words.empty() ? std::string() : words.back();
  for (const std::string& before : words.empty() ? words : words.first(words.size() - 1)) {
    if (awaits != nullptr) {
      awaits = nullptr;
    } else if (before.starts_with("-")) {
      const CLI::Option* const option = option_named(*command, before);
      if (option != nullptr && option->get_items_expected_max() > 0) awaits = option;
    } else if (const CLI::App* inner = inner_command(*command, before)) {
      command = inner;
      places = 0;
    } else {
      ++places;
    }
  }
  if (awaits != nullptr) return values_of(*awaits, word);
  std::vector<std::string> out;
  if (word.starts_with("-")) {
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames()) add_if_fits(out, word, "--" + name);
    return out;
  }
  for (const CLI::App* inner : command->get_subcommands([](const CLI::App*) { return true; }))
    if (!inner->get_group().empty()) add_if_fits(out, word, inner->get_name());
  if (!out.empty()) return out;
  std::vector<const CLI::Option*> positionals;
  for (const CLI::Option* option : command->get_options())
    if (option->get_positional()) positionals.push_back(option);
  if (places < positionals.size()) return values_of(*positionals[places], word);
  return out;
}

}  // namespace forager::tools
