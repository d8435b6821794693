#pragma once

#include <string>
#include <string_view>

#include "hal/error.hpp"

namespace forager::tools {

// What the program's exit codes mean, the same for every command.
enum ExitCode : int {
  kExitDone = 0,         // did what was asked
  kExitFailure = 1,      // a device or input/output failed
  kExitUsage = 2,        // asked wrongly; nothing was done
  kExitUnavailable = 3,  // not built in, not present, no permission; the message says how to mend it
  kExitCheckFailed = 4,  // ran to its end, and what it checked is not so
};

[[nodiscard]] int exit_code_for(hal::ErrorCode code);

// Prints "forager: <error>" as one line to stderr and gives the exit code.
int complain(const hal::Error& error);
// The same for a usage error of our own; gives kExitUsage.
int complain_usage(std::string_view message);

// Text from a file, a device or a person, made safe to print on a terminal: every control character becomes a
// blank, so that it can neither move the cursor nor break the line.
[[nodiscard]] std::string one_line(std::string_view text);

// Writes all of it to a file, or to stdout if path is "-". Errors: not_present (no such folder), permission,
// io.
[[nodiscard]] hal::Result<> write_output(const std::string& path, std::string_view text);

}  // namespace forager::tools
