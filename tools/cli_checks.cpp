#include "tools/cli_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

template <class Number>
bool parse_all(const std::string& text, Number& value) {
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stopped == end && !text.empty();
}

// The innermost command that was named: its help is the one to look at.
const CLI::App& named(const CLI::App& app) {
  const auto inner = app.get_subcommands();
  return inner.empty() ? app : named(*inner.front());
}

std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name() : full_name(*app.get_parent()) + " " + app.get_name();
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

int depth_of(const CLI::App& app) {
  return app.get_parent() == nullptr ? 0 : 1 + depth_of(*app.get_parent());
}

// The word in the place of a command of `app` that is none.
std::string unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  const int place = 1 + depth_of(app);
  if (commands_of(app).empty() || place >= argc) return {};
  const std::string word(argv[place]);
  return word.starts_with("-") ? std::string{} : word;
}

}  // namespace

WholeNumber::WholeNumber(std::uint64_t most) : WholeNumber(0, most) {}

WholeNumber::WholeNumber(std::uint64_t least, std::uint64_t most) {
  func_ = [least, most](const std::string& text) {
    std::uint64_t value = 0;
    return parse_all(text, value) && value >= least && value <= most
               ? std::string{}
               : fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
  };
}

NumberBetween::NumberBetween(double low, double high) {
  func_ = [low, high](const std::string& text) {
    double value = 0.0;
    return parse_all(text, value) && value >= low && value <= high
               ? std::string{}
               : fmt::format("'{}' is not a number from {} to {}", text, low, high);
  };
}

TimeSpan::TimeSpan(double low_s, double high_s) {
  func_ = [low_s, high_s](std::string& text) {
    constexpr std::array<std::pair<std::string_view, double>, 4> kUnits{
        {{"ms", 1e-3}, {"min", 60.0}, {"s", 1.0}, {"h", 3600.0}}};
    std::string number = text;
    double factor = 1.0;
    for (const auto& [unit, seconds] : kUnits) {
      if (!text.ends_with(unit)) continue;
      number.resize(text.size() - unit.size());
      factor = seconds;
      break;
    }
    double value = 0.0;
    if (!parse_all(number, value) || !(value * factor >= low_s && value * factor <= high_s))
      return fmt::format("'{}' is not a time from {} s to {} s, such as 10s, 250ms or 2min", text, low_s,
                         high_s);
    text = fmt::format("{}", value * factor);
    return std::string{};
  };
}

int complain_about_arguments(const CLI::App& app, const CLI::ParseError& error, int argc,
                             const char* const* argv) {
  const CLI::App& command = named(app);
  const std::string name = full_name(command);
  const std::string unknown = unknown_command(command, argc, argv);
  std::string what = error.what();
  if (!unknown.empty())
    what =
        fmt::format("'{}' is not a command. There are: {}", unknown, fmt::join(commands_of(command), ", "));
  else if (!commands_of(command).empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
    what = fmt::format("a command is missing. There are: {}", fmt::join(commands_of(command), ", "));
  std::string_view inside(name);
  inside.remove_prefix(app.get_name().size());
  if (!inside.empty()) inside.remove_prefix(1);
  return complain_usage(
      fmt::format("{}{}{}. See '{} --help'", inside, inside.empty() ? "" : ": ", what, name));
}

}  // namespace forager::tools
