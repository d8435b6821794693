#include <nanoflann.hpp>
#include <utility>

#include "boards/radius_peer.hpp"

namespace forager::boards {
namespace {

// What nanoflann asks of a set of points.
struct Cloud {
  mocks::PointSpans points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.x.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return axis == 0 ? points.x[i] : axis == 1 ? points.y[i] : points.z[i];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

class NanoflannPeer final : public RadiusPeer {
 public:
  explicit NanoflannPeer(const mocks::PointSpans& points) : cloud_{points}, tree_(3, cloud_) {}
  [[nodiscard]] std::string name() const override { return "nanoflann"; }
  void within(hal::Vec3 centre, double radius_m, std::vector<std::uint32_t>& out) override {
    const double at[3] = {centre.x, centre.y, centre.z};
    nanoflann::SearchParams unsorted;
    unsorted.sorted = false;
    // It takes the square of the radius and leaves out what lies exactly on it.
    const double square = radius_m * radius_m * (1.0 + 1e-15);
    tree_.radiusSearch(at, square, found_, unsorted);
    out.clear();
    for (const auto& [id, distance] : found_) out.push_back(id);
  }

 private:
  using Metric = nanoflann::L2_Simple_Adaptor<double, Cloud>;
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Cloud, 3, std::uint32_t>;
  Cloud cloud_;
  Tree tree_;
  std::vector<std::pair<std::uint32_t, double>> found_;
};

}  // namespace

std::unique_ptr<RadiusPeer> make_radius_peer(const mocks::PointSpans& points) {
  return std::make_unique<NanoflannPeer>(points);
}

}  // namespace forager::boards
