#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boards/config_node.hpp"
#include "boards/scene_store.hpp"
#include "flight/obstacle_guard.hpp"
#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "hal/time.hpp"
#include "reader/new_tag_counter.hpp"
#include "reader/read_plan.hpp"

namespace forager::mocks {
class TagList;
}

namespace forager::boards {

// The vehicle of a scene. World frame REP-103, metres and radians.
struct SceneVehicle {
  hal::Pose start;                  // on the floor
  double altitude_m = 1.8;          // flown height
  std::vector<double> altitudes_m;  // several heights, tried in turn; empty: altitude_m only
  double body_radius_m = 0.6;
  double max_speed_m_s = 1.0;
  double max_acceleration_m_s2 = 1.5;
  double max_climb_m_s = 0.7;
  double max_yaw_rate_rad_s = 1.0;
  double battery_s = 1500.0;   // flight time of a full battery
  double battery_start = 1.0;  // 0..1
  bool operator==(const SceneVehicle&) const = default;
};

struct SceneCamera {
  int columns = 80;
  int rows = 60;
  double horizontal_fov_rad = 1.518;
  double vertical_fov_rad = 1.012;
  double rate_hz = 10.0;
  double min_m = 0.15;
  double max_m = 7.0;
  double noise = 0.0;  // depth noise: standard deviation is noise * depth^2, 1/m
  bool operator==(const SceneCamera&) const = default;
};

struct SceneLocalisation {
  double rate_hz = 30.0;
  double noise_m = 0.003;
  double noise_rad = 0.002;
  bool operator==(const SceneLocalisation&) const = default;
};

enum class PolicyKind : std::uint8_t { stigmergy, hover, dead_reckoning, stop_and_rotate, random_walk };
[[nodiscard]] std::string_view to_string(PolicyKind kind);  // "stigmergy", "static", "dead_reckoning", ...
// Errors: invalid_argument listing the names there are.
[[nodiscard]] hal::Result<PolicyKind> policy_from(std::string_view name);

struct SceneMission {
  PolicyKind policy = PolicyKind::stigmergy;
  hal::Duration window{};
  double step_m = 1.0;
  double speed_m_s = 0.5;
  double arrival_m = 0.2;
  double arrival_yaw_rad = 0.26;
  int tries = 5;
  hal::Duration settle{};                   // between arriving and listening: reads of the way come late
  std::optional<hal::Duration> time_limit;  // from take-off
  double battery_reserve = 0.2;             // 0..1
  reader::ShareRule share = reader::ShareRule::first_heard;
  double significance = 0.0;  // k of |V| > k sqrt(sum w); 0: off
  bool winner_takes_all = false;
  bool memory = false;
  double memory_half_life_s = 60.0;
  std::vector<hal::Vec3> waypoints;  // dead reckoning; z is filled in with the altitude
  std::uint32_t rotate_above = 10;   // stop-and-rotate: new tags in a window that start a rotation
  std::uint32_t rotate_below = 3;    // and that end it
  bool operator==(const SceneMission&) const = default;
};

struct SceneLinks {
  hal::Duration reader_timeout{};       // REST exchange
  hal::Duration stream_timeout{};       // silence on the event stream
  hal::Duration reader_allowance{};     // reader lost for longer: land
  hal::Duration autopilot_timeout{};    // heartbeat silence
  hal::Duration autopilot_allowance{};  // silent for longer: the mission ends
  hal::Duration pose_timeout{};         // localisation silent or jumping for longer is bad
  hal::Duration pose_allowance{};       // bad for longer: land
  hal::Duration store_allowance{};      // inventory refuses for longer: land
  hal::Duration start_timeout{};        // everything ready and airborne by then
  hal::Duration deadman{};              // our own heartbeats stop when the loop stalls this long
  bool operator==(const SceneLinks&) const = default;
};

struct SceneShelf {
  hal::Vec3 min;
  hal::Vec3 max;
  bool operator==(const SceneShelf&) const = default;
};
struct SceneGroup {
  std::uint32_t tags = 0;
  double spread_xy_m = 0.5;  // tags scatter +- this around the centre
  double spread_z_m = 0.5;   // and 0 .. this above it
  bool wanted = true;
  std::vector<hal::Vec3> centres;
  bool operator==(const SceneGroup&) const = default;
};
// One sample of a measured antenna pattern: power over that on boresight.
struct ScenePatternSample {
  double angle_rad = 0.0;
  double gain_db = 0.0;
  bool operator==(const ScenePatternSample&) const = default;
};
struct SceneRadio {
  double r0_m = 2.75;
  double t0_s = 1.0;
  double beam_horizontal_rad = 1.2217;
  double beam_vertical_rad = 1.2217;
  std::string pattern = "cosine";                     // cosine, gaussian, table
  std::vector<ScenePatternSample> pattern_azimuth;    // of a table: angle positive to the left
  std::vector<ScenePatternSample> pattern_elevation;  // positive upwards
  double pattern_exponent = 0.5;         // u = R / (R0 D0^e): 0.5 the paper, 1 the published plugin
  double power_up_limit = 2.0;           // beyond this u a tag has too little power, however long one listens
  double spread_db = 2.0;                // sensitivity from tag to tag, standard deviation
  double rician_k_db = 6.0;              // frozen multipath: power of the direct path over the scattered ones
  std::string tag_axes = "none";         // "none", "upright", "scattered": tags as dipoles
  double polarisation_loss_db = 3.0103;  // of them, before a circular antenna
  double occlusion_db = 0.0;             // loss for each shelf crossed
  double rssi_at_1m_dbm = -51.0;
  double patience_s = 0.018;  // the radio leaves a port that brought nothing new for so long, median
  std::optional<double> singulation_s;  // one reply at most in this time; by default what the link takes
  bool operator==(const SceneRadio&) const = default;
};
enum class AirModel : std::uint8_t { round, slot };
// Gen2 between the simulated reader and tags.
struct SceneAir {
  AirModel model = AirModel::round;
  double tari_us = 25.0;
  double pie = 2.0;
  double blf_khz = 250.0;
  int m = 4;  // cycles per bit: 1 FM0, 2, 4, 8 Miller
  bool pilot_tone = false;
  double first_q = 4.0;
  double q_step = 0.3;
  double round_overhead_s = 0.010;
  std::optional<double> dwell_s;  // the same for each port; by default the reader decides by what it hears
  double hop_interval_s = 0.0;
  double capture_probability = 0.0;
  bool operator==(const SceneAir&) const = default;
};
struct SceneWorld {
  std::vector<SceneShelf> shelves;
  std::vector<SceneGroup> groups;
  SceneStore store;      // kind empty: none
  std::string tag_file;  // CSV, as the scene names it; empty: none
  // What is in it; load_scene() reads it, read_scene() does not.
  std::shared_ptr<const mocks::TagList> file_tags;
  // What is wrong with the list of where the tags are, as shares of them; the tags themselves stay.
  double mislabeled = 0.0;
  double unlisted = 0.0;
  SceneSkip skip;
  SceneRadio radio;
  SceneAir air;
  bool operator==(const SceneWorld&) const = default;
};

// A vehicle, its devices, a task and, off-target, a world.
struct Scene {
  std::string file;
  std::string name;
  std::string title;
  SceneVehicle vehicle;
  SceneCamera camera;
  SceneLocalisation localisation;
  reader::ReadPlan read_plan;
  flight::GuardConfig guard;
  SceneMission mission;
  SceneLinks links;
  SceneWorld world;
  bool operator==(const Scene&) const = default;
};

// Reads and checks a scene file (and the files it lies on). Errors: those of load_config; invalid_argument
// for an unknown key, a wrong type, a value out of range, a port without bearing, a policy without what it
// needs.
[[nodiscard]] hal::Result<Scene> load_scene(const std::string& path);
// The same from a parsed tree; for tests and fuzzers.
[[nodiscard]] hal::Result<Scene> read_scene(const ConfigNode& root, const std::string& file);

// Flies the scene with another policy than its own. Errors: invalid_argument if the scene lacks what that
// policy needs (waypoints, a time limit).
[[nodiscard]] hal::Result<> change_policy(Scene& scene, PolicyKind policy);

}  // namespace forager::boards
