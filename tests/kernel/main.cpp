// The tests of the real backends on a real kernel. They make devices and take them away, as root: so they run
// in the guest of tests/kernel/run.sh, and nowhere else.
#include <gmock/gmock.h>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  if (std::getenv("FORAGER_KERNEL_GUEST") == nullptr) {
    std::fputs("kernel_tests: runs inside the guest of tests/kernel/run.sh only\n", stderr);
    return 2;
  }
  return RUN_ALL_TESTS();
}
