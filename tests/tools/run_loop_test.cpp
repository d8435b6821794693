// Whatever goes wrong inside a run in flight, the vehicle is told to land and the reader to stop.
#include "tools/run_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "boards/run_clock.hpp"
#include "boards/run_journal.hpp"
#include "tests/places.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using boards::Run;
using testing::HasSubstr;

// A run whose updates throw.
class FaultyRun final : public Run {
 public:
  explicit FaultyRun(std::unique_ptr<Run> run) : run_(std::move(run)) {}

  hal::Instant from;
  int times = 0;                     // so often; -1: for ever
  bool only_until_abandoned = true;  // an abandoned run has less to do
  int abandoned = 0;

  void update(hal::Instant now) override {
    const bool throws = now >= from && times != 0 && !(only_until_abandoned && abandoned > 0);
    if (throws) {
      if (times > 0) --times;
      throw std::runtime_error("out of luck");
    }
    run_->update(now);
  }
  void halt() noexcept override { run_->halt(); }
  void abandon() noexcept override {
    ++abandoned;
    run_->abandon();
  }
  bool done() const override { return run_->done(); }
  const boards::Scene& scene() const override { return run_->scene(); }
  const flight::MissionStatus& status() const override { return run_->status(); }
  const reader::LinkStatus& reader_link() const override { return run_->reader_link(); }
  std::span<const flight::FlownPath::Point> path() const override { return run_->path(); }
  std::vector<boards::PortSummary> ports() const override { return run_->ports(); }
  const boards::WorldFacts* world() const override { return run_->world(); }
  const reader::InventoryStore& inventory() const override { return run_->inventory(); }
  boards::RunTicks ticks() const override { return run_->ticks(); }
  hal::Result<boards::RunSummary> summary() override { return run_->summary(); }

 private:
  std::unique_ptr<Run> run_;
};

class RunLoop : public testing::Test {
 protected:
  void SetUp() override {
    auto journal =
        boards::RunJournal::open({}, [this](hal::Instant, std::string_view source, std::string_view text) {
          notes_ += std::string(source) + ": " + std::string(text) + "\n";
        });
    ASSERT_TRUE(journal);
    journal_ = std::move(*journal);
    const auto scene = boards::load_scene(test::source_path("scenes/4A.toml"));
    ASSERT_TRUE(scene);
    auto run = Run::prepare(*scene, boards::sim_board(), {.inventory_path = {}, .journal = journal_.get()},
                            clock_->now());
    ASSERT_TRUE(run) << describe(run.error());
    run_ = std::make_unique<FaultyRun>(std::move(*run));
    run_->from = hal::Instant(40s);
  }

  std::string notes_;
  std::unique_ptr<boards::RunJournal> journal_;
  std::unique_ptr<hal::Clock> clock_ = boards::make_virtual_clock();
  RunWatch watch_{{}};
  std::unique_ptr<FaultyRun> run_;
};

TEST_F(RunLoop, FliesToTheEnd) {
  EXPECT_TRUE(run_to_end(*run_, *clock_, watch_));
  EXPECT_TRUE(run_->done());
  EXPECT_EQ(run_->status().end, flight::EndReason::no_new_tags);
  EXPECT_EQ(run_->abandoned, 0);
}

TEST_F(RunLoop, LandsAfterAnExceptionInFlight) {
  run_->times = 1;
  const auto result = run_to_end(*run_, *clock_, watch_);
  ASSERT_FALSE(result);
  EXPECT_THAT(describe(result.error()), HasSubstr("out of luck"));
  EXPECT_TRUE(run_->done());
  EXPECT_EQ(run_->status().end, flight::EndReason::halted);
  ASSERT_TRUE(run_->status().touched_down);
  EXPECT_LT(*run_->status().touched_down, hal::Instant(60s));
  EXPECT_THAT(notes_, HasSubstr("stop -> OK"));
  EXPECT_EQ(run_->abandoned, 0);
  const auto summary = run_->summary();
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->crashes, 0U);
  EXPECT_GT(summary->tags_read, 0U);
}

TEST_F(RunLoop, GivesUpARunThatOnlyThrowsButStillTellsEverybody) {
  run_->times = -1;
  const auto result = run_to_end(*run_, *clock_, watch_);
  ASSERT_FALSE(result);
  EXPECT_EQ(run_->abandoned, 1);
  EXPECT_TRUE(run_->done());
  EXPECT_THAT(notes_, HasSubstr("sim-autopilot: mode 9")) << "it was told to land";
  EXPECT_THAT(notes_.substr(notes_.find("link closed: halted")), HasSubstr("stop -> OK"));
  EXPECT_LT(clock_->now(), hal::Instant(60s));
}

TEST_F(RunLoop, EndsEvenIfNothingWorksAnyMore) {
  run_->times = -1;
  run_->only_until_abandoned = false;
  EXPECT_FALSE(run_to_end(*run_, *clock_, watch_));
  EXPECT_GE(run_->abandoned, 1);
  EXPECT_LT(clock_->now(), hal::Instant(60s));
  EXPECT_THAT(notes_, HasSubstr("autopilot: landing requested"));
}

TEST_F(RunLoop, ARunThatIsDroppedInFlightIsToldToLand) {
  for (hal::Instant now; now < hal::Instant(40s); now += Run::kTick) run_->update(now);
  ASSERT_TRUE(run_->status().took_off);
  EXPECT_THAT(notes_, testing::Not(HasSubstr("landing requested")));
  run_.reset();
  EXPECT_THAT(notes_, HasSubstr("autopilot: landing requested"));
  EXPECT_THAT(notes_, HasSubstr("reader: link closed: halted"));
}

TEST_F(RunLoop, HaltedWhileArmingItDisarms) {
  hal::Instant now;
  for (; run_->status().phase != flight::MissionPhase::arming; now += Run::kTick) run_->update(now);
  for (int i = 0; i < 5; ++i, now += Run::kTick) run_->update(now);
  ASSERT_THAT(notes_, HasSubstr("sim-autopilot: Arming motors"));
  ASSERT_EQ(run_->status().phase, flight::MissionPhase::arming) << "no heartbeat has said so yet";
  run_->halt();
  for (; !run_->done() && now < hal::Instant(20s); now += Run::kTick) run_->update(now);
  EXPECT_TRUE(run_->done());
  EXPECT_EQ(run_->status().end, flight::EndReason::halted);
  EXPECT_GT(notes_.rfind("Disarming motors") + 1, notes_.rfind("Arming motors"));
}

TEST_F(RunLoop, ARunThatIsDroppedOnTheGroundCommandsNothing) {
  for (hal::Instant now; now < hal::Instant(200ms); now += Run::kTick) run_->update(now);
  ASSERT_EQ(run_->status().phase, flight::MissionPhase::waiting);
  run_.reset();
  EXPECT_THAT(notes_, testing::Not(HasSubstr("landing requested")));
}

}  // namespace
}  // namespace forager::tools
