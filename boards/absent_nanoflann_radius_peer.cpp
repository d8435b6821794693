// Twin of nanoflann_radius_peer.cpp for a build without nanoflann (Debian: libnanoflann-dev).
#include "boards/radius_peer.hpp"

namespace forager::boards {
namespace {

class EveryPoint final : public RadiusPeer {
 public:
  explicit EveryPoint(const mocks::PointSpans& points) : points_(points) {}
  [[nodiscard]] std::string name() const override { return "a look at every tag (no nanoflann built in)"; }
  void within(hal::Vec3 centre, double radius_m, std::vector<std::uint32_t>& out) override {
    out.clear();
    for (std::uint32_t i = 0; i < points_.x.size(); ++i) {
      const double x = points_.x[i] - centre.x;
      const double y = points_.y[i] - centre.y;
      const double z = points_.z[i] - centre.z;
      if (x * x + y * y + z * z <= radius_m * radius_m) out.push_back(i);
    }
  }

 private:
  mocks::PointSpans points_;
};

}  // namespace

std::unique_ptr<RadiusPeer> make_radius_peer(const mocks::PointSpans& points) {
  return std::make_unique<EveryPoint>(points);
}

}  // namespace forager::boards
