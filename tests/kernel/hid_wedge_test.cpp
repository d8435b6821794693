// A reader that plays a keyboard, on a kernel that makes an input device of it.
#include "reader/hid_wedge.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <unistd.h>

#include <cerrno>

#include "hal/linux/hid_bus.hpp"
#include "hal/linux/kernel.hpp"
#include "hal/linux/steady_clock.hpp"
#include "mocks/sim_wedge.hpp"
#include "tests/hal/eventually.hpp"
#include "tests/kernel/hid_plug.hpp"
#include "tests/kernel/sysfs.hpp"

namespace forager::kernel {
namespace {

using namespace std::chrono_literals;
using hal::contract::eventually;
using testing::HasSubstr;

// Whoever reads the kernel's event devices: a console, a desktop.
class Console {
 public:
  // Of the one input device there is.
  Console() {
    EXPECT_TRUE(eventually([&] {
      for (const std::string& name : hal::real_kernel().list("/sys/class/input"))
        if (name.starts_with("event"))
          fd_ = ::open(("/dev/input/" + name).c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
      return fd_ >= 0;
    }));
  }
  ~Console() { ::close(fd_); }
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  // How many keys have gone down since the last call.
  [[nodiscard]] int keys() const {
    int down = 0;
    input_event event{};
    while (::read(fd_, &event, sizeof event) == static_cast<ssize_t>(sizeof event))
      if (event.type == EV_KEY && event.value == 1) ++down;
    return down;
  }

 private:
  int fd_ = -1;
};

constexpr std::string_view kTag = "30349bb6000000000000002a";

class WedgeOnAKernel : public testing::Test {
 protected:
  void read_tag() {
    const auto held = plug_.lock();
    keyboard_.read_tag(kTag);
  }
  // The kernel makes the input device a moment before the hidraw.
  bool takes(reader::HidWedge& wedge) {
    wedge.start(clock_->now());
    return eventually([&] {
      wedge.update(clock_->now());
      return wedge.link().phase == reader::LinkPhase::open;
    });
  }
  // Few keys: the kernel forgets what a console does not read at once.
  bool console_hears_keys() {
    {
      const auto held = plug_.lock();
      keyboard_.type("42");
    }
    int keys = 0;
    return eventually([&] { return (keys += console_.keys()) == 2; });
  }
  mocks::SimWedge keyboard_;
  HidPlug plug_{keyboard_};
  Console console_;
  std::unique_ptr<hal::Hid> hid_ = hal::open_hid_bus().value();
  std::unique_ptr<hal::Clock> clock_ = hal::make_steady_clock();
};

TEST_F(WedgeOnAKernel, WhileItIsTakenNothingItTypesReachesAConsole) {
  ASSERT_TRUE(console_hears_keys()) << "it is a keyboard like any other";
  reader::HidWedge wedge(*hid_, {});
  ASSERT_TRUE(takes(wedge)) << wedge.link().reason;
  for (int i = 0; i < 3; ++i) {
    read_tag();
    std::string heard;
    EXPECT_TRUE(eventually([&] {
      wedge.update(clock_->now());
      for (const reader::TagRead& read : wedge.reads()) heard += read.epc.hex();
      return heard == kTag;
    })) << heard;
  }
  EXPECT_EQ(0, console_.keys());
  wedge.halt();
  EXPECT_TRUE(console_hears_keys()) << "given back";
}

TEST_F(WedgeOnAKernel, OneProgramAtATimeHasIt) {
  reader::HidWedge first(*hid_, {});
  ASSERT_TRUE(takes(first)) << first.link().reason;
  reader::HidWedge second(*hid_, {});
  second.start(clock_->now());
  EXPECT_EQ(reader::LinkPhase::lost, second.link().phase);
  EXPECT_THAT(second.link().reason, HasSubstr("another program has it for itself"));
  first.halt();
  second.update(clock_->now() + 1s);
  EXPECT_EQ(reader::LinkPhase::open, second.link().phase) << second.link().reason;
}

}  // namespace
}  // namespace forager::kernel
