#include "mocks/scripted_failure.hpp"

#include <cstdio>
#include <cstdlib>

namespace forager::mocks {

ScriptFailure abort_on_script_failure() {
  return [](const std::string& why) {
    std::fprintf(stderr, "script not followed: %s\n", why.c_str());
    std::abort();
  };
}

}  // namespace forager::mocks
