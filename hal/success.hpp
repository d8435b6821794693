#pragma once

#include "hal/error.hpp"

namespace forager::hal {

// What `return {}` of a Result<> gives, for calls that are made again and again: compilers fill such a `{}`
// with zeros whole, room for an error and all, which takes ten nanoseconds.
[[nodiscard]] Result<> success();

}  // namespace forager::hal
