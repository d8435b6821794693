#pragma once

#include <string>

#include "tests/places.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {

// A machine with pins under the program: tests/tools/fake_machine/fake_machine.cpp.
struct FakeMachine {
  std::string gpio{};  // words
  std::string root{};  // folder of files that stand for the machine's own

  [[nodiscard]] ProgramOptions options() const {
    ProgramOptions options;
    options.environment = {
        {"LD_PRELOAD", test::fake_machine()},
        // A sanitizer's runtime wants to be first; that nothing of it is used here is enough.
        {"ASAN_OPTIONS", "verify_asan_link_order=0"},
        {"FORAGER_FAKE_GPIO", gpio},
        {"FORAGER_FAKE_ROOT", root}};
    return options;
  }
};

// Whether the program was built with this library.
inline bool built_with(const std::string& library) {
  const ProgramResult result = run_program({"doctor"}, FakeMachine{}.options());
  return result.out.find("ok       backend  " + library + ": ") != std::string::npos;
}

}  // namespace forager::tools
