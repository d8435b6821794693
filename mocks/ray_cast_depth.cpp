#include "mocks/ray_cast_depth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mocks/rotation.hpp"

namespace forager::mocks {
namespace {

// Nearer than this nothing is drawn: it bounds the projection, and no sensor sees it.
constexpr double kNear_m = 0.01;
constexpr double kMillimetresPerMetre = 1000.0;
constexpr double kLongest_m = 65.0;  // what 16-bit millimetres can say

bool contains(const Box& box, hal::Vec3 p) {
  return p.x > box.min.x && p.x < box.max.x && p.y > box.min.y && p.y < box.max.y && p.z > box.min.z &&
         p.z < box.max.z;
}

// Nearly normal with variance 1 from 64 bits: the sum of four uniform 16-bit numbers. Bounded by 3.5; cheap
// enough for every pixel.
double quick_normal(std::uint64_t bits) {
  const auto part = [bits](int k) { return static_cast<double>((bits >> (16 * k)) & 0xFFFFU); };
  constexpr double kMean = 4.0 * 32767.5;
  constexpr double kScale = 1.7320508075688772 / 65536.0;
  return (part(0) + part(1) + part(2) + part(3) - kMean) * kScale;
}

int clamp_index(double x, int limit) {
  return static_cast<int>(std::clamp(std::ceil(x), 0.0, static_cast<double>(limit)));
}

hal::Vec3 cross(hal::Vec3 a, hal::Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A convex polygon in pixel coordinates. A face cut by the near plane has at most five corners.
struct Outline {
  struct Point {
    double column;
    double row;
  };
  std::array<Point, 5> points{};
  std::size_t count = 0;

  [[nodiscard]] std::pair<double, double> rows() const {
    double top = points[0].row;
    double bottom = top;
    for (std::size_t i = 1; i < count; ++i) {
      top = std::min(top, points[i].row);
      bottom = std::max(bottom, points[i].row);
    }
    return {top, bottom};
  }

  // Where the horizontal line at `row` enters and leaves; empty (inf, -inf) if it misses.
  [[nodiscard]] std::pair<double, double> columns_at(double row) const {
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    for (std::size_t i = 0; i < count; ++i) {
      const Point& p = points[i];
      const Point& q = points[i + 1 < count ? i + 1 : 0];
      if ((p.row <= row) == (q.row <= row)) continue;
      const double x = p.column + (row - p.row) / (q.row - p.row) * (q.column - p.column);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    return {left, right};
  }
};

// Cuts away what is behind the lens, then projects.
Outline project(const std::array<hal::Vec3, 4>& corners, const hal::DepthCameraModel& model) {
  Outline outline;
  const auto add = [&](hal::Vec3 p) {
    outline.points[outline.count++] = {model.cx_px - model.fx_px * p.y / p.x,
                                       model.cy_px - model.fy_px * p.z / p.x};
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const hal::Vec3 p = corners[i];
    const hal::Vec3 q = corners[(i + 1) % 4];
    if (p.x >= kNear_m) add(p);
    if ((p.x >= kNear_m) != (q.x >= kNear_m)) add(p + ((kNear_m - p.x) / (q.x - p.x)) * (q - p));
  }
  return outline;
}

}  // namespace

struct SimDepthCamera::Camera {
  hal::Vec3 position_world;
  Axes axes_world;  // x along the optical axis, y left, z up
};

SimDepthCamera::SimDepthCamera(const World& world, const TrueBody& body, const SimDepthOptions& options,
                               std::uint64_t seed)
    : world_(&world), body_(&body), options_(options), random_(seed) {
  model_.columns = std::max(options.columns, 1);
  model_.rows = std::max(options.rows, 1);
  model_.cx_px = 0.5 * model_.columns;
  model_.cy_px = 0.5 * model_.rows;
  model_.fx_px = model_.cx_px / std::tan(0.5 * options.hfov_rad);
  model_.fy_px = model_.cy_px / std::tan(0.5 * options.vfov_rad);
  model_.min_m = options.min_m;
  model_.max_m = options.max_m;
  const auto pixels = static_cast<std::size_t>(model_.columns) * static_cast<std::size_t>(model_.rows);
  reciprocal_.resize(pixels);
  if (options.metres)
    metres_.resize(pixels);
  else
    millimetres_.resize(pixels);
  if (options.dead_share > 0.0) {
    dead_.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) dead_[i] = random_.chance(options.dead_share);
  }
}

hal::Result<std::optional<hal::DepthFrame>> SimDepthCamera::do_poll(hal::Instant now) {
  if (fault_ == DepthFault::disconnect)
    return hal::fail(hal::ErrorCode::disconnected, "simulated depth camera", "read frame", "the cable is out",
                     "plug it in again");
  if (!next_exposure_ || now >= *next_exposure_) expose(now);
  if (fault_ == DepthFault::stall) exposed_.reset();
  if (!exposed_ || now < stamp_ + options_.latency) return std::optional<hal::DepthFrame>{};
  if (fault_ != DepthFault::freeze) {
    if (fault_ == DepthFault::blind)
      std::fill(reciprocal_.begin(), reciprocal_.end(), 0.0F);
    else
      render(*exposed_);
    disturb();
    convert();
  }
  exposed_.reset();
  return std::optional<hal::DepthFrame>{frame()};
}

// The shutter keeps its own rhythm: exposures stay on the grid of the first one, and a late poll skips those
// it missed.
void SimDepthCamera::expose(hal::Instant now) {
  exposed_ = body_->state().pose;
  stamp_ = now;
  const hal::Instant due = next_exposure_.value_or(now);
  next_exposure_ = due + ((now - due) / options_.period + 1) * options_.period;
}

hal::DepthFrame SimDepthCamera::frame() const {
  hal::DepthFrame frame{stamp_, model_, {}};
  if (options_.metres)
    frame.pixels = std::span<const float>(metres_);
  else
    frame.pixels = std::span<const std::uint16_t>(millimetres_);
  return frame;
}

void SimDepthCamera::render(const hal::Pose& body) {
  const Axes body_axes = axes_of(body);
  const Camera camera{body.position + body_axes.to_parent(options_.mounting.position),
                      compose(body_axes, axes_of(options_.mounting))};
  std::fill(reciprocal_.begin(), reciprocal_.end(), 0.0F);
  for (const Box& box : world_->obstacles)
    if (contains(box, camera.position_world)) return;
  if (camera.position_world.z <= 0.0) return;
  std::fill(reciprocal_.begin(), reciprocal_.end(), far_reciprocal());
  draw_plane(camera, 0.0);
  if (options_.ceiling_m) draw_plane(camera, *options_.ceiling_m);
  for (const Box& box : world_->obstacles) draw_box(camera, box);
}

// A horizontal plane without end. A ray (1, y, z) of the camera meets it where depth * rise = drop, so the
// reciprocal depth is rise/drop, and rise is linear along a row.
void SimDepthCamera::draw_plane(const Camera& camera, double height_m) {
  const double drop = height_m - camera.position_world.z;
  if (drop == 0.0) return;
  const double per_column = -camera.axes_world.y.z / model_.fx_px / drop;
  for (int row = 0; row < model_.rows; ++row) {
    const double z = (model_.cy_px - (row + 0.5)) / model_.fy_px;
    const double first =
        (camera.axes_world.x.z + z * camera.axes_world.z.z) / drop + per_column * (0.5 - model_.cx_px);
    float* const out = reciprocal_.data() + static_cast<std::ptrdiff_t>(row) * model_.columns;
    const auto start = static_cast<float>(first);
    const auto step = static_cast<float>(per_column);
    for (int c = 0; c < model_.columns; ++c) out[c] = std::max(out[c], start + step * static_cast<float>(c));
  }
}

void SimDepthCamera::draw_box(const Camera& camera, const Box& box) {
  std::array<hal::Vec3, 8> corner;  // bit 0: max x, bit 1: max y, bit 2: max z
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = -nearest;
  for (unsigned i = 0; i < 8; ++i) {
    const hal::Vec3 p{(i & 1U) != 0 ? box.max.x : box.min.x, (i & 2U) != 0 ? box.max.y : box.min.y,
                      (i & 4U) != 0 ? box.max.z : box.min.z};
    corner[i] = camera.axes_world.from_parent(p - camera.position_world);
    nearest = std::min(nearest, corner[i].x);
    farthest = std::max(farthest, corner[i].x);
  }
  // Wholly behind the lens, or too far to be reported: leaves no trace in the picture except that it hides
  // nothing nearer.
  if (farthest < kNear_m || nearest > model_.max_m) return;
  const hal::Vec3 eye = camera.position_world;
  const auto face = [&](unsigned a, unsigned b, unsigned c, unsigned d) {
    draw_face({corner[a], corner[b], corner[c], corner[d]});
  };
  if (eye.x < box.min.x) face(0, 2, 6, 4);
  if (eye.x > box.max.x) face(1, 3, 7, 5);
  if (eye.y < box.min.y) face(0, 1, 5, 4);
  if (eye.y > box.max.y) face(2, 3, 7, 6);
  if (eye.z < box.min.z) face(0, 1, 3, 2);
  if (eye.z > box.max.z) face(4, 5, 7, 6);
}

void SimDepthCamera::draw_face(const std::array<hal::Vec3, 4>& corners) {
  // The plane of the face, n . p = n . p0, gives 1/depth = n . ray / (n . p0) along the ray (1, y, z).
  const hal::Vec3 n = cross(corners[1] - corners[0], corners[3] - corners[0]);
  const double offset = Axes::dot(n, corners[0]);
  if (offset == 0.0) return;
  const double per_column = -n.y / offset / model_.fx_px;
  const double per_row = -n.z / offset / model_.fy_px;
  const double at_zero = n.x / offset - per_column * (model_.cx_px - 0.5) - per_row * (model_.cy_px - 0.5);

  const Outline outline = project(corners, model_);
  if (outline.count < 3) return;
  const auto [top, bottom] = outline.rows();
  const int last_row = clamp_index(bottom - 0.5, model_.rows);
  for (int row = clamp_index(top - 0.5, model_.rows); row < last_row; ++row) {
    const auto [left, right] = outline.columns_at(row + 0.5);
    const int end = clamp_index(right - 0.5, model_.columns);
    float* const out = reciprocal_.data() + static_cast<std::ptrdiff_t>(row) * model_.columns;
    const auto start = static_cast<float>(at_zero + per_row * row);
    const auto step = static_cast<float>(per_column);
    for (int c = clamp_index(left - 0.5, model_.columns); c < end; ++c)
      out[c] = std::max(out[c], start + step * static_cast<float>(c));
  }
}

// Reciprocal depth of a pixel that sees nothing within reach; 0 is unknown.
float SimDepthCamera::far_reciprocal() const {
  return options_.far_as_max ? static_cast<float>(1.0 / std::min(model_.max_m, kLongest_m)) : 0.0F;
}

void SimDepthCamera::disturb() {
  if (options_.noise_per_m > 0.0) {
    const float far = far_reciprocal();
    for (float& r : reciprocal_)
      // depth + k depth^2 n, to first order in the reciprocal: 1/depth - k n.
      if (r > far)
        r = std::max(r - static_cast<float>(options_.noise_per_m * quick_normal(random_.next())),
                     std::max(far, 1e-6F));
  }
  if (options_.speckle_share > 0.0)
    for (float& r : reciprocal_)
      if (random_.chance(options_.speckle_share)) r = 0.0F;
  for (std::size_t i = 0; i < dead_.size(); ++i)
    if (dead_[i]) reciprocal_[i] = 0.0F;
}

void SimDepthCamera::convert() {
  const auto nearest = static_cast<float>(1.0 / std::max(model_.min_m, kNear_m));
  const auto farthest = static_cast<float>(1.0 / std::min(model_.max_m, kLongest_m));
  const std::size_t count = reciprocal_.size();
  if (options_.metres) {
    for (std::size_t i = 0; i < count; ++i) {
      const float r = reciprocal_[i];
      metres_[i] = r >= farthest && r <= nearest ? 1.0F / r : 0.0F;
    }
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const float r = reciprocal_[i];
    const float mm = static_cast<float>(kMillimetresPerMetre) / std::max(r, farthest) + 0.5F;
    const int whole = static_cast<int>(mm);
    millimetres_[i] = static_cast<std::uint16_t>(r >= farthest && r <= nearest ? whole : 0);
  }
}

}  // namespace forager::mocks
