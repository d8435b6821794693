#include "mocks/store_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace forager::mocks {
namespace {

constexpr double kRack_m = 12.0;     // longest rack without a passage
constexpr double kEntrance_m = 1.5;  // free before the first rack
constexpr double kWall_m = 0.2;
constexpr double kHall_m = 30.0;  // side of a hall, about
constexpr double kPlot_m = 4.0;
constexpr double kLowest_m = 0.3;
constexpr double kLargest_m = 1e5;

// A shelf, and how many tags it holds beside others of its size.
struct Shelf {
  Box box;
  double share = 0.0;  // of floor and filling, from its place in the store: the same wherever that stands
};

class Builder {
 public:
  Builder(World& world, const StorePlan& plan, hal::Random& random)
      : world_(&world), plan_(plan), random_(&random), area_m2_(area_of(plan)) {}

  void build() {
    switch (plan_.kind) {
      case StoreKind::aisles:
        return aisles(area_m2_, kEntrance_m);
      case StoreKind::t:
        return t_shape();
      case StoreKind::square:
        return square();
      case StoreKind::halls:
        return halls();
      case StoreKind::random:
        return scattered();
    }
  }

  // Shares of floor and filling, rounded so that they add up.
  void fill(EpcSequence& epcs) {
    double whole = 0.0;
    for (const Shelf& shelf : shelves_) whole += shelf.share;
    world_->tags.reserve(world_->tags.size() + plan_.tags);
    double so_far = 0.0;
    std::size_t placed = 0;
    for (std::size_t i = 0; i < shelves_.size(); ++i) {
      so_far += shelves_[i].share;
      const bool last = i + 1 == shelves_.size();
      const double due = std::floor(static_cast<double>(plan_.tags) * so_far / whole);
      const std::size_t until = last ? plan_.tags : std::min(static_cast<std::size_t>(due), plan_.tags);
      for (; placed < until; ++placed) put_tag(shelves_[i].box, epcs);
    }
  }

  static double area_of(const StorePlan& plan) { return static_cast<double>(plan.tags) / plan.tags_per_m2; }

 private:
  [[nodiscard]] double half_aisle() const { return 0.5 * plan_.aisle_m; }
  [[nodiscard]] double pitch() const { return plan_.aisle_m + plan_.shelf_depth_m; }

  void put_tag(const Box& box, EpcSequence& epcs) {
    // One draw per statement: the order of evaluation of arguments is not fixed.
    const double x = random_->uniform(box.min.x, box.max.x);
    const double y = random_->uniform(box.min.y, box.max.y);
    const double z = random_->uniform(std::min(box.min.z + kLowest_m, box.max.z), box.max.z);
    world_->tags.add(epcs.next96(), {x, y, z}, true);
  }
  // Corners on the floor of the store, in any order.
  Box stand(double x0, double y0, double x1, double y1) {
    const hal::Vec3 low{std::min(x0, x1), std::min(y0, y1), 0.0};
    const hal::Vec3 high{std::max(x0, x1), std::max(y0, y1), plan_.shelf_height_m};
    const Box box{plan_.origin + low, plan_.origin + high};
    world_->obstacles.push_back(box);
    return box;
  }
  void shelf(double x0, double y0, double x1, double y1, double fill = 1.0) {
    shelves_.push_back({stand(x0, y0, x1, y1), fill * std::abs((x1 - x0) * (y1 - y0))});
  }

  // About as long as wide; returns where it ends.
  double aisles_from(double area_m2, double from_x) {
    const double count = std::max(1.0, std::round(std::sqrt(area_m2) / pitch()));
    const double length = std::max(area_m2 / (count * pitch()), 1.0);
    const double racks = std::ceil(length / kRack_m);
    const double each = length / racks;
    const double rack = each > 2.0 * plan_.aisle_m && racks > 1.0 ? each - plan_.aisle_m : each;
    const double first = -std::floor(0.5 * count) - 0.5;
    for (int row = 0; row <= static_cast<int>(count); ++row) {
      const double y = (first + row) * pitch();
      for (int i = 0; i < static_cast<int>(racks); ++i)
        shelf(from_x + i * each, y - 0.5 * plan_.shelf_depth_m, from_x + i * each + rack,
              y + 0.5 * plan_.shelf_depth_m);
    }
    return from_x + length;
  }
  void aisles(double area_m2, double from_x) { static_cast<void>(aisles_from(area_m2, from_x)); }

  void t_shape() {
    const double stem = std::max(area_m2_ / (3.0 * pitch()), 2.0);
    const double end = kEntrance_m + stem;  // the near faces of the aisle across
    const double h = half_aisle();
    const double d = plan_.shelf_depth_m;
    const double arm = h + stem;
    for (const double side : {1.0, -1.0}) {
      shelf(kEntrance_m, side * h, end, side * (h + d));
      shelf(end - d, side * (h + d), end, side * arm);
    }
    shelf(end + plan_.aisle_m, -arm, end + plan_.aisle_m + d, arm);
  }

  // The middle of the aisle runs through (0, 0), (c, 0), (c, c) and (0, c).
  void square() {
    const double h = half_aisle();
    const double d = plan_.shelf_depth_m;
    const double c = std::max(area_m2_ / (4.0 * pitch()), 2.0 * (h + d) + 0.5);
    shelf(h, h, c - h, h + d);
    shelf(h, c - h - d, c - h, c - h);
    shelf(h, h + d, h + d, c - h - d);
    shelf(c - h - d, h + d, c - h, c - h - d);
    shelf(-h, -h - d, c + h, -h);
    shelf(-h, c + h, c + h, c + h + d);
    shelf(-h - d, -h, -h, c + h);
    shelf(c + h, -h, c + h + d, c + h);
  }

  void halls() {
    const double count = std::clamp(std::round(std::sqrt(area_m2_) / kHall_m), 2.0, 100.0);
    double x = kEntrance_m;
    for (int hall = 0; hall < static_cast<int>(count); ++hall) {
      const std::size_t first = shelves_.size();
      const double end = aisles_from(area_m2_ / count, x);
      double low = 0.0;
      double high = 0.0;
      for (std::size_t i = first; i < shelves_.size(); ++i) {
        low = std::min(low, shelves_[i].box.min.y - plan_.origin.y);
        high = std::max(high, shelves_[i].box.max.y - plan_.origin.y);
      }
      if (hall + 1.0 == count) return;
      const double wall = end + plan_.aisle_m;
      stand(wall, half_aisle(), wall + kWall_m, std::max(high, pitch()));
      stand(wall, -half_aisle(), wall + kWall_m, std::min(low, -pitch()));
      x = wall + kWall_m + plan_.aisle_m;
    }
  }

  void scattered() {
    const double plots = std::max(1.0, std::round(std::sqrt(area_m2_) / kPlot_m));
    for (int i = 0; i < static_cast<int>(plots); ++i)
      for (int j = 0; j < static_cast<int>(plots); ++j) {
        const double length = random_->uniform(1.2, 2.4);
        const double depth = std::min(plan_.shelf_depth_m, 1.2);
        const bool along_x = random_->chance(0.5);
        const double wide = along_x ? length : depth;
        const double deep = along_x ? depth : length;
        const double at_x = kEntrance_m + kPlot_m * i + random_->uniform(0.0, kPlot_m - 1.2 - wide);
        const double at_y = kPlot_m * (j - 0.5 * plots) + random_->uniform(0.6, kPlot_m - 0.6 - deep);
        shelf(at_x, at_y, at_x + wide, at_y + deep, random_->uniform(0.1, 1.9));
      }
  }

  World* world_;
  StorePlan plan_;
  hal::Random* random_;
  double area_m2_;
  std::vector<Shelf> shelves_;
};

hal::Result<> check(const StorePlan& plan) {
  const auto refuse = [](std::string detail) {
    return hal::fail(hal::ErrorCode::invalid_argument, "warehouse", "make store", std::move(detail));
  };
  const struct {
    const char* name;
    double value;
  } fields[] = {{"tags_per_m2", plan.tags_per_m2},
                {"aisle_m", plan.aisle_m},
                {"shelf_depth_m", plan.shelf_depth_m},
                {"shelf_height_m", plan.shelf_height_m}};
  for (const auto& field : fields)
    if (!(field.value > 0.0 && field.value <= kLargest_m))
      return refuse(fmt::format("{} = {} is not above 0", field.name, field.value));
  if (!is_finite(plan.origin)) return refuse("its origin is no place");
  if (plan.tags == 0) return refuse("0 tags");
  if (Builder::area_of(plan) > kLargest_m * kLargest_m)
    return refuse(fmt::format("{} tags at {} a square metre make it too large", plan.tags, plan.tags_per_m2));
  return {};
}

}  // namespace

hal::Result<> add_store(World& world, const StorePlan& plan, EpcSequence& epcs, hal::Random& random) {
  FORAGER_TRY(check(plan));
  Builder builder(world, plan, random);
  builder.build();
  builder.fill(epcs);
  return {};
}

}  // namespace forager::mocks
