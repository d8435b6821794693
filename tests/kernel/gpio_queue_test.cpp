// What the kernel keeps of more edges than its queue holds: by the interface that libgpiod 1 uses, and by
// that of libgpiod 2, asked here without the library, so that hal::EdgeIn promises of both what is so.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <thread>

#include "hal/linux/gpio.hpp"
#include "hal/linux/steady_clock.hpp"
#include "tests/kernel/gpio_sim.hpp"

namespace forager::kernel {
namespace {

using namespace std::chrono_literals;
using hal::Instant;

constexpr int kEdges = 40;
constexpr std::size_t kQueue = 16;

class EdgeQueueInVirtualTime : public testing::Test {
 protected:
  // An edge each 20 ms, the first one rising.
  void drive() {
    const auto clock = hal::make_steady_clock();
    for (int i = 0; i < kEdges; ++i) {
      sim_.drive(0, i % 2 == 0);
      std::this_thread::sleep_for(20ms);  // gpio-sim's interrupts wait for the next tick, of 10 ms
      if (static_cast<std::size_t>(i) + 1 == kQueue) after_first_ = clock->now();
      if (i + 1 == kEdges - static_cast<int>(kQueue)) before_last_ = clock->now();
    }
  }
  GpioSim sim_{"bench", {{"IN"}}};
  Instant after_first_;
  Instant before_last_;
};

TEST_F(EdgeQueueInVirtualTime, TheInterfaceOfLibgpiod1KeepsTheFirst) {
  ASSERT_EQ(0U, hal::gpio_library().find("libgpiod 1"));
  const auto in =
      hal::open_gpio_edges({.chip = "bench", .line = "IN", .edges = hal::GpioEdges::both}).value();
  drive();
  std::array<hal::Edge, 2 * kQueue> edges{};
  ASSERT_EQ(kQueue, in->edges(edges).value());
  EXPECT_TRUE(edges[0].active);
  EXPECT_LT(edges[kQueue - 1].at, after_first_);
  EXPECT_EQ(0U, in->edges(edges).value());
}

TEST_F(EdgeQueueInVirtualTime, TheInterfaceOfLibgpiod2KeepsTheLast) {
  const int chip = ::open(("/dev/" + sim_.chip()).c_str(), O_RDWR | O_CLOEXEC);
  gpio_v2_line_request line{};
  line.num_lines = 1;
  line.config.flags =
      GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_EDGE_RISING | GPIO_V2_LINE_FLAG_EDGE_FALLING;
  ASSERT_EQ(0, ::ioctl(chip, GPIO_V2_GET_LINE_IOCTL, &line)) << std::strerror(errno);
  drive();
  std::array<gpio_v2_line_event, 2 * kQueue> events{};
  const auto bytes = ::read(line.fd, events.data(), sizeof events);
  EXPECT_EQ(static_cast<ssize_t>(kQueue * sizeof events[0]), bytes);
  EXPECT_EQ(kEdges - kQueue + 1, events[0].line_seqno);
  EXPECT_GT(events[0].timestamp_ns, static_cast<std::uint64_t>(before_last_.time_since_epoch().count()));
  ::close(line.fd);
  ::close(chip);
}

}  // namespace
}  // namespace forager::kernel
