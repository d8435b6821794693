#pragma once

#include <string>
#include <string_view>

// Where things of this build lie. One file is told; every other test is compiled the same wherever the
// checkout lies.
namespace forager::test {

// Absolute paths of a file of the project, "scenes/4A.toml", and of a file under tests/data.
[[nodiscard]] std::string source_path(std::string_view file);
[[nodiscard]] std::string data_path(std::string_view file);

// The program forager and the machine with pins that is preloaded into it; empty in a build without them.
[[nodiscard]] const char* program();
[[nodiscard]] const char* fake_machine();

}  // namespace forager::test
