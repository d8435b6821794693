#include "boards/depth_bench.hpp"

#include <utility>

#include "boards/world_builder.hpp"
#include "hal/linux/udp_peer.hpp"
#include "mocks/ray_cast_depth.hpp"
#include "mocks/truth_feed.hpp"

namespace forager::boards {
namespace {

mocks::BodyState start_in_air(const Scene& scene) {
  mocks::BodyState body;
  body.pose = scene.vehicle.start;
  body.pose.position.z += scene.vehicle.altitude_m;
  body.on_ground = false;
  return body;
}

class StandingBody final : public mocks::TrueBody {
 public:
  explicit StandingBody(const mocks::BodyState& state) : state_(state) {}
  [[nodiscard]] const mocks::BodyState& state() const override { return state_; }

 private:
  mocks::BodyState state_;
};

class StandingCamera final : public DepthBench {
 public:
  StandingCamera(const Scene& scene, std::uint64_t seed)
      : world_(build_world(scene, seed)),
        body_(start_in_air(scene)),
        camera_(world_, body_, depth_options(scene), seed_for(seed, SeedStream::camera)) {}
  hal::DepthSource& camera() override { return camera_; }
  void advance(hal::Instant /*now*/) override {}

 private:
  mocks::World world_;
  StandingBody body_;
  mocks::SimDepthCamera camera_;
};

class FollowingCamera final : public DepthBench {
 public:
  FollowingCamera(const Scene& scene, std::uint64_t seed, std::unique_ptr<hal::UdpPeer> truth)
      : world_(build_world(scene, seed)),
        truth_(std::move(truth)),
        body_(*truth_, start_in_air(scene)),
        camera_(world_, body_, depth_options(scene), seed_for(seed, SeedStream::camera)) {}
  hal::DepthSource& camera() override { return camera_; }
  void advance(hal::Instant now) override { body_.update(now); }

 private:
  mocks::World world_;
  std::unique_ptr<hal::UdpPeer> truth_;
  mocks::TruthFollower body_;
  mocks::SimDepthCamera camera_;
};

}  // namespace

hal::Result<std::unique_ptr<DepthBench>> open_depth_bench(const Board& board, const Scene& scene,
                                                          std::uint64_t seed) {
  if (board.kind == BoardKind::sim) return std::make_unique<StandingCamera>(scene, seed);
  auto truth = hal::open_udp_listener(board.truth.host, board.truth.port);
  FORAGER_TRY(truth->open());
  return std::make_unique<FollowingCamera>(scene, seed, std::move(truth));
}

}  // namespace forager::boards
