#include <utility>

#include "boards/autopilot_line.hpp"
#include "boards/device_set.hpp"
#include "boards/reader_bench.hpp"
#include "boards/world_builder.hpp"
#include "hal/linux/curl_http_client.hpp"
#include "hal/linux/tcp_stream.hpp"
#include "hal/linux/udp_peer.hpp"
#include "mocks/ray_cast_depth.hpp"
#include "mocks/sim_pose_source.hpp"
#include "mocks/truth_feed.hpp"

namespace forager::boards {
namespace {

// Localisation that knows nothing before the emulated autopilot has said for the first time where it is:
// silence must not pass for standing at the start.
class ToldPose final : public hal::PoseSource {
 public:
  ToldPose(const mocks::TruthFollower& body, const mocks::SimPoseOptions& options, std::uint64_t seed)
      : body_(&body), source_(body, options, seed) {}

 private:
  hal::Result<std::optional<hal::PoseSample>> do_poll(hal::Instant now) override {
    if (!body_->told_at()) return std::optional<hal::PoseSample>{};
    return source_.poll(now);
  }

  const mocks::TruthFollower* body_;
  mocks::SimPoseSource source_;
};

// Reader and autopilot behind sockets; camera and localisation computed from where the emulated autopilot
// says the vehicle really is.
class SocketDevices final : public DeviceSet {
 public:
  SocketDevices(const Scene& scene, const Board& board, std::optional<hal::HttpCredentials> credentials,
                const DeviceOptions& options)
      : world_(build_world(scene, options.seed)),
        facts_(facts_of(scene, world_, options.seed)),
        rest_(hal::make_curl_http_client(reader_url(board), std::move(credentials))),
        events_(hal::open_tcp_stream(board.reader_host, board.reader_stream_port)),
        autopilot_(open_autopilot_line(board)),
        truth_(hal::open_udp_listener(board.truth.host, board.truth.port)),
        body_(*truth_, start_of(scene)),
        depth_(world_, body_, depth_options(scene), seed_for(options.seed, SeedStream::camera)),
        pose_(body_, pose_options(scene), seed_for(options.seed, SeedStream::pose)) {}

  hal::HttpClient& reader_rest() override { return *rest_; }
  hal::ByteStream& reader_events() override { return *events_; }
  hal::ByteStream& autopilot() override { return *autopilot_; }
  hal::DepthSource& depth() override { return depth_; }
  hal::PoseSource& pose() override { return pose_; }
  const WorldFacts* world() const override { return &facts_; }
  void advance(hal::Instant now) override { body_.update(now); }

 private:
  static mocks::BodyState start_of(const Scene& scene) {
    mocks::BodyState body;
    body.pose = scene.vehicle.start;
    return body;
  }

  mocks::World world_;
  WorldFacts facts_;
  std::unique_ptr<hal::HttpClient> rest_;
  std::unique_ptr<hal::ByteStream> events_;
  std::unique_ptr<hal::ByteStream> autopilot_;
  std::unique_ptr<hal::UdpPeer> truth_;
  mocks::TruthFollower body_;
  mocks::SimDepthCamera depth_;
  ToldPose pose_;
};

}  // namespace

hal::Result<std::unique_ptr<DeviceSet>> make_socket_devices(const Scene& scene, const Board& board,
                                                            const DeviceOptions& options) {
  auto login = reader_login(board);
  if (!login) return hal::fail(std::move(login).error());
  std::optional<hal::HttpCredentials> credentials;
  if (*login) credentials = hal::HttpCredentials{(*login)->user, (*login)->password};
  return std::make_unique<SocketDevices>(scene, board, std::move(credentials), options);
}

}  // namespace forager::boards
