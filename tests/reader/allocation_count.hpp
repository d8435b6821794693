#pragma once

#include <cstdint>

namespace forager::test {

// Number of heap allocations (operator new of any form) of this test program so far. Take the difference
// around the code under test.
[[nodiscard]] std::uint64_t allocation_count();

}  // namespace forager::test
