#include "hal/linux/service_notify.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/notify_listener.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

class ServiceNotifyTest : public testing::Test {
 protected:
  void SetUp() override { TearDown(); }
  void TearDown() override {
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
  }
  test::ScratchFolder folder_;
};

TEST_F(ServiceNotifyTest, SaysThatItIsReadyLivesAndEnds) {
  test::NotifyListener systemd(folder_.file("notify"));
  ::setenv("NOTIFY_SOCKET", folder_.file("notify").c_str(), 1);
  ::setenv("WATCHDOG_USEC", "2000000", 1);
  auto service = ServiceNotify::from_environment();
  EXPECT_TRUE(service.watched());
  service.ready();
  for (int tick = 0; tick < 250; ++tick) service.alive(Instant(tick * 10ms));  // 0 to 2.49 s
  service.stopping();
  EXPECT_THAT(systemd.heard(),
              ElementsAre("READY=1", "WATCHDOG=1", "WATCHDOG=1", "WATCHDOG=1", "STOPPING=1"));
}

TEST_F(ServiceNotifyTest, AWatchdogOfAnotherProcessIsNotFed) {
  test::NotifyListener systemd(folder_.file("notify"));
  ::setenv("NOTIFY_SOCKET", folder_.file("notify").c_str(), 1);
  ::setenv("WATCHDOG_USEC", "2000000", 1);
  ::setenv("WATCHDOG_PID", "1", 1);
  auto service = ServiceNotify::from_environment();
  EXPECT_FALSE(service.watched());
  service.alive(Instant(1s));
  EXPECT_THAT(systemd.heard(), IsEmpty());
}

TEST_F(ServiceNotifyTest, OutsideOfAServiceNothingHappens) {
  for (const char* socket : {"", "/", "relative", "/no/such/folder/notify"}) {
    ::setenv("NOTIFY_SOCKET", socket, 1);
    auto service = ServiceNotify::from_environment();
    service.ready();
    service.alive(Instant(1s));
    EXPECT_FALSE(service.watched()) << socket;
  }
}

}  // namespace
}  // namespace forager::hal
