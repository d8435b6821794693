#include "mocks/gen2_field_nearby.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace forager::mocks {
namespace {

// Fewer tags than this are all looked at: that is faster than finding out which.
constexpr std::size_t kFewTags = 2048;
constexpr double kCell_m = 2.0;
// Room for as many tags in range is there from the start.
constexpr std::size_t kUsually = std::size_t{1} << 16U;
constexpr double kOneCell_m = 1e12;
constexpr double kFarthest_m = 1e12;
// Nearer in plan than this beyond the margin, a tag belongs to no direction.
constexpr double kAround_m = 1.0;
constexpr double kSector_rad = hal::kPi / 8.0;
constexpr double kTanOfSector = 0.41421356237309503;

// Number of the 16th of the compass a direction lies in, counted from +x to +y.
std::size_t sector_of(double x, double y) {
  const double across = std::abs(x);
  const double along = std::abs(y);
  std::size_t quarter = 0;  // 0..3 within the quadrant
  if (along <= across)
    quarter = along > kTanOfSector * across ? 1 : 0;
  else
    quarter = across > kTanOfSector * along ? 2 : 3;
  const std::size_t half = x < 0.0 ? 7 - quarter : quarter;
  return y < 0.0 ? 15 - half : half;
}

}  // namespace

NearbyTags::NearbyTags(const World& world, const AirLink& link, const AirParameters& air)
    : link_(&link), pattern_(air.pattern), use_grid_(air.skip_by_grid) {
  build_layers(world, air.spread_db);
  const std::size_t usual = std::min(world.tags.size(), kUsually);
  found_.reserve(usual);
  candidates_.reserve(usual);
  guide_.reserve(usual);
}

// Median and better by whole standard deviations: a layer is searched as far as its best tag reaches.
void NearbyTags::build_layers(const World& world, double spread_db) {
  const PointSpans points = world.tags.points();
  std::array<std::vector<std::uint32_t>, 4> parts;
  const bool few = points.x.size() < kFewTags || spread_db <= 0.0;
  for (std::uint32_t tag = 0; tag < points.x.size(); ++tag) {
    const auto usable = [](double v) { return std::abs(v) <= kFarthest_m; };
    if (!usable(points.x[tag]) || !usable(points.y[tag]) || !usable(points.z[tag])) continue;
    std::size_t part = 0;
    if (!few) {
      const double deviations = link_->spread_db(tag) / spread_db;
      part = deviations <= 0.0 ? 0 : std::min(static_cast<std::size_t>(deviations) + 1, parts.size() - 1);
    }
    parts[part].push_back(tag);
  }
  for (const auto& ids : parts) {
    if (ids.empty()) continue;
    auto grid = TagGrid::build(points, ids, points.x.size() < kFewTags ? kOneCell_m : kCell_m);
    if (!grid) continue;  // cannot be: only usable places are in it
    Layer layer{*std::move(grid), {}, 0.0};
    layer.per_r0.reserve(ids.size());
    for (const std::uint32_t tag : layer.grid.id()) {
      layer.per_r0.push_back(1.0 / link_->r0_m(tag));
      layer.max_r0_m = std::max(layer.max_r0_m, link_->r0_m(tag));
    }
    layers_.push_back(std::move(layer));
  }
}

double NearbyTags::radius_of(const Layer& layer, const Place& place) const {
  const double reach_m = layer.max_r0_m * place.max_reach * link_->max_amplitude();
  return link_->hazard_table().last_u() * reach_m * (1.0 + 1e-12) + place.slack_m + link_->longest_arm_m();
}

void NearbyTags::renew(const Place& place, const Silence* silence) {
  ++generation_;
  place_ = place;
  margin_m_ = place.slack_m + link_->longest_arm_m();
  silent_ = 0;
  examined_ = 0;
  found_.clear();
  sectors_ = {};
  if (place.max_reach > 0.0)
    for (const Layer& layer : layers_) look(layer, place, silence);
  sort_by_sector();
}

void NearbyTags::look(const Layer& layer, const Place& place, const Silence* silence) {
  const HazardTable& rates = link_->hazard_table();
  const double per_reach = 1.0 / (place.max_reach * link_->max_amplitude());
  const TagGrid& grid = layer.grid;
  each_run(layer, place, [&](const TagGrid::Run& run) {
    examined_ += run.last - run.first;
    for (std::size_t slot = run.first; slot < run.last; ++slot) {
      const double x = grid.x()[slot] - place.centre.x;
      const double y = grid.y()[slot] - place.centre.y;
      const double z = grid.z()[slot] - place.centre.z;
      const double plan2 = x * x + y * y;
      const double nearest = std::max(std::sqrt(plan2 + z * z) - margin_m_, 0.0);
      const double bound = rates.bound(nearest * layer.per_r0[slot] * per_reach);
      if (bound <= 0.0) continue;
      const std::uint32_t tag = grid.id()[slot];
      if (silence != nullptr) {
        const auto answers = [&](double t_s) {
          return silence->flags->answers(tag, silence->session, silence->target, t_s, silence->dwell);
        };
        if (!answers(silence->now_s) && !answers(silence->until_s)) {
          ++silent_;
          continue;
        }
      }
      const double around = margin_m_ + kAround_m;
      const std::size_t number = plan2 < around * around ? kAround : sector_of(x, y);
      Sector& sector = sectors_[number];
      const double plan = std::sqrt(plan2);
      sector.nearest_m = sector.count == 0 ? plan : std::min(sector.nearest_m, plan);
      sector.highest_m = std::max(sector.highest_m, std::abs(z));
      ++sector.count;
      found_.push_back({tag, static_cast<std::uint32_t>(number), bound});
    }
  });
}

void NearbyTags::sort_by_sector() {
  std::array<std::uint32_t, kSectors + 1> next{};
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < sectors_.size(); ++i) {
    sectors_[i].first = next[i] = first;
    first += sectors_[i].count;
  }
  candidates_.resize(found_.size());
  for (const Found& found : found_) candidates_[next[found.sector]++] = {found.tag, found.bound_per_s, 0.0};
  double sum = 0.0;
  for (Candidate& candidate : candidates_) candidate.sum_per_s = sum += candidate.bound_per_s;

  guide_.resize(candidates_.size());
  std::uint32_t at = 0;
  const double step = sum / static_cast<double>(candidates_.size());
  for (std::size_t k = 0; k < guide_.size(); ++k) {
    const double from = step * static_cast<double>(k) * (1.0 - 1e-9);
    while (at + 1 < candidates_.size() && candidates_[at].sum_per_s <= from) ++at;
    guide_[k] = at;
  }
}

Audible NearbyTags::everything() const {
  Audible audible;
  audible.total_per_s = sum_per_s();
  audible.stretches[0] = {0.0, audible.total_per_s};
  audible.count = candidates_.empty() ? 0 : 1;
  return audible;
}

// A tag at offset o from the centre is seen from an antenna up to margin_m_ away and turned by up to t, so
// its component along the normal is at most o.n + t |o| + margin. In a sector o.n is at most h c |n_xy| +
// |n_z| z, with h the distance in plan and c the cosine between the normal and the sector. If the factor of h
// is negative the nearest tag is the worst.
bool NearbyTags::hidden(const Sector& sector, std::size_t number, hal::Vec3 normal, double turn_rad) const {
  const double flat = std::sqrt(normal.x * normal.x + normal.y * normal.y);
  const double middle = (static_cast<double>(number) + 0.5) * kSector_rad;
  const double off = std::abs(hal::angle_difference(std::atan2(normal.y, normal.x), middle));
  const double cosine = std::cos(std::max(off - 0.5 * kSector_rad - 1e-9, 0.0));
  const double per_metre = cosine * flat + turn_rad;
  return per_metre < 0.0 && sector.nearest_m * per_metre +
                                    sector.highest_m * (std::abs(normal.z) + turn_rad) +
                                    margin_m_ * (1.0 + turn_rad) <
                                0.0;
}

Audible NearbyTags::before(const AntennaView& antenna, double turn_rad) const {
  Audible audible;
  if (!antenna.fitted) return audible;
  const auto beam = pattern_.beam();
  if (!beam) return everything();  // measured cuts may have a back lobe
  // A beam of either shape hears nothing behind; a cosine squared narrower than a half circle nothing beyond
  // the two upright planes through its nulls either.
  std::array<hal::Vec3, 3> normals{antenna.axes_world.x};
  std::size_t count = 1;
  if (beam->shape == AntennaPattern::Shape::cosine_squared && beam->width_h_rad < 0.5 * hal::kPi) {
    const double s = std::sin(beam->width_h_rad);
    const double c = std::cos(beam->width_h_rad);
    normals[count++] = s * antenna.axes_world.x - c * antenna.axes_world.y;
    normals[count++] = s * antenna.axes_world.x + c * antenna.axes_world.y;
  }
  for (std::size_t i = 0; i < sectors_.size(); ++i) {
    const Sector& sector = sectors_[i];
    if (sector.count == 0) continue;
    const auto hides = [&](hal::Vec3 normal) { return hidden(sector, i, normal, turn_rad); };
    if (i != kAround && std::any_of(normals.begin(), normals.begin() + count, hides)) continue;
    const double from = sector.first > 0 ? candidates_[sector.first - 1].sum_per_s : 0.0;
    const double to = candidates_[sector.first + sector.count - 1].sum_per_s;
    audible.total_per_s += to - from;
    if (audible.count > 0 && audible.stretches[audible.count - 1].to_per_s == from)
      audible.stretches[audible.count - 1].to_per_s = to;
    else
      audible.stretches[audible.count++] = {from, to};
  }
  return audible;
}

const NearbyTags::Candidate& NearbyTags::pick(const Audible& audible, double share) const {
  double along = share * audible.total_per_s;
  std::size_t stretch = 0;
  for (; stretch + 1 < audible.count; ++stretch) {
    const double length = audible.stretches[stretch].to_per_s - audible.stretches[stretch].from_per_s;
    if (along < length) break;
    along -= length;
  }
  const double at =
      std::min(audible.stretches[stretch].from_per_s + along, audible.stretches[stretch].to_per_s);
  const double size = static_cast<double>(guide_.size());
  const auto k = static_cast<std::size_t>(std::min(at / sum_per_s() * size, size - 1.0));
  std::size_t i = guide_[k];
  while (i > 0 && candidates_[i - 1].sum_per_s > at) --i;
  while (i + 1 < candidates_.size() && candidates_[i].sum_per_s <= at) ++i;
  return candidates_[i];
}

}  // namespace forager::mocks
