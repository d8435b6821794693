#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>

namespace forager::tools {

// A whole number from `least` (or 0) to `most`, decimal digits and nothing else: neither "-1" nor "5x" nor
// "0x10" is taken for something its author may not have meant.
struct WholeNumber : CLI::Validator {
  explicit WholeNumber(std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
  WholeNumber(std::uint64_t least, std::uint64_t most);
};

// A finite decimal number within the range.
struct NumberBetween : CLI::Validator {
  NumberBetween(double low, double high);
};

// A length of time: seconds ("10", "0.5"), or with a unit, "10s", "250ms", "2min", "1h". For transform(), not
// check(): the variable gets seconds.
struct TimeSpan : CLI::Validator {
  TimeSpan(double low_s, double high_s);
};

// What is wrong with a command line, where, and where help is to be had, on stderr as one line. Gives
// kExitUsage.
int complain_about_arguments(const CLI::App& app, const CLI::ParseError& error, int argc,
                             const char* const* argv);

}  // namespace forager::tools
