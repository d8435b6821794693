#pragma once

#include <functional>
#include <string>

namespace forager::mocks {

// What a scripted double does when the script is not followed: a test passes
// [](const std::string& why) { ADD_FAILURE() << why; }.
using ScriptFailure = std::function<void(const std::string& why)>;

// Prints the reason to stderr and aborts: a script must never fail unseen.
[[nodiscard]] ScriptFailure abort_on_script_failure();

}  // namespace forager::mocks
