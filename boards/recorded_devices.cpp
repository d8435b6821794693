#include "boards/recorded_devices.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "mocks/recording_http.hpp"
#include "mocks/recording_sources.hpp"
#include "mocks/recording_stream.hpp"
#include "mocks/replay_http.hpp"
#include "mocks/replay_sources.hpp"
#include "mocks/replay_stream.hpp"
#include "mocks/virtual_clock.hpp"

namespace forager::boards {
namespace {

// Names under which the five are recorded: those of the devices behind them may differ from run to run.
constexpr const char* kDepth = "depth";
constexpr const char* kPose = "pose";

class Recorded final : public DeviceSet {
 public:
  Recorded(std::unique_ptr<DeviceSet> devices, const RunRecording& recording, hal::Instant now)
      : devices_(std::move(devices)), clock_(now), recorder_(clock_, recording.sink) {
    recorder_.take("run", "<begin", {}, recording.facts);
    recorder_.take("run", "<names", {},
                   hal::Fields{std::string(devices_->reader_rest().name()),
                               std::string(devices_->reader_events().name()),
                               std::string(devices_->autopilot().name())});
  }

  hal::HttpClient& reader_rest() override { return rest_; }
  hal::ByteStream& reader_events() override { return events_; }
  hal::ByteStream& autopilot() override { return autopilot_; }
  hal::DepthSource& depth() override { return depth_; }
  hal::PoseSource& pose() override { return pose_; }
  void advance(hal::Instant now) override {
    clock_.sleep_until(now);
    recorder_.take("run", "<tick", {}, hal::Fields{});
    devices_->advance(now);
  }
  [[nodiscard]] const WorldFacts* world() const override { return devices_->world(); }
  [[nodiscard]] DeviceTicks ticks() const override { return devices_->ticks(); }
  [[nodiscard]] std::uint32_t crashes() const override { return devices_->crashes(); }

 private:
  std::unique_ptr<DeviceSet> devices_;
  mocks::VirtualClock clock_;  // the time of the run's last update
  hal::Recorder recorder_;
  mocks::RecordingHttpClient rest_{devices_->reader_rest(), recorder_};
  mocks::RecordingStream events_{devices_->reader_events(), recorder_};
  mocks::RecordingStream autopilot_{devices_->autopilot(), recorder_};
  mocks::RecordingDepthSource depth_{devices_->depth(), kDepth, recorder_};
  mocks::RecordingPoseSource pose_{devices_->pose(), kPose, recorder_};
};

std::string name_of(const std::vector<hal::Record>& records, std::size_t index) {
  for (const hal::Record& record : records)
    if (record.operation == "<names" && record.answer && record.answer->size() > index)
      return (*record.answer)[index];
  return {};
}

class Replayed final : public ReplayedDevices {
 public:
  Replayed(std::vector<hal::Record> records, hal::Instant now)
      : clock_(now), replay_(std::move(records), clock_), calls_(replay_.calls_left()) {}

  hal::HttpClient& reader_rest() override { return rest_; }
  hal::ByteStream& reader_events() override { return events_; }
  hal::ByteStream& autopilot() override { return autopilot_; }
  hal::DepthSource& depth() override { return depth_; }
  hal::PoseSource& pose() override { return pose_; }
  void advance(hal::Instant now) override { clock_.sleep_until(now); }
  [[nodiscard]] const WorldFacts* world() const override { return nullptr; }
  [[nodiscard]] const std::optional<hal::Error>& difference() const override { return replay_.difference(); }
  [[nodiscard]] std::size_t calls_left() const override { return replay_.calls_left(); }
  [[nodiscard]] std::size_t calls() const override { return calls_; }

 private:
  mocks::VirtualClock clock_;
  mocks::Replay replay_;
  std::size_t calls_;
  mocks::ReplayHttpClient rest_{name_of(replay_.records(), 0), replay_};
  mocks::ReplayStream events_{name_of(replay_.records(), 1), replay_};
  mocks::ReplayStream autopilot_{name_of(replay_.records(), 2), replay_};
  mocks::ReplayDepthSource depth_{kDepth, replay_};
  mocks::ReplayPoseSource pose_{kPose, replay_};
};

}  // namespace

std::unique_ptr<DeviceSet> record_devices(std::unique_ptr<DeviceSet> devices, const RunRecording& recording,
                                          hal::Instant now) {
  return std::make_unique<Recorded>(std::move(devices), recording, now);
}

std::unique_ptr<ReplayedDevices> replay_devices(std::vector<hal::Record> records, hal::Instant now) {
  return std::make_unique<Replayed>(std::move(records), now);
}

}  // namespace forager::boards
