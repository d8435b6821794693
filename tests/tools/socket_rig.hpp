#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "reader/inventory_store.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {

using Json = nlohmann::json;

// Ten times the pace of the clock: a mission takes seconds, and a process may still be kept waiting for a
// good half second (5 s of flight) before the autopilot's failsafe finds the vision gone (7.9 s). Twice as
// fast worked too, with six programs waiting for each core, but leaves half as much.
inline constexpr double kSpeed = 10.0;
inline constexpr std::chrono::milliseconds kPatience = std::chrono::seconds(40);

// JSON lines of a program's stdout; a last line without its end is not counted.
std::vector<Json> lines_of(const std::string& out);
// The last of them with this "event"; null if there is none.
Json last_event(const std::string& out, const std::string& event);
// New tags of all decisions so far.
std::uint32_t tags_decided_on(const std::string& out);

// An aisle with 40 tags on one short shelf, flown by three programs: reader, autopilot and mission, on an
// address and on ports that no other test uses. Everything lives in a folder of its own.
class SocketRig {
 public:
  struct Options {
    std::string mission = {};   // more lines of [mission]
    std::string links = {};     // more lines of [links]
    std::string login = {};     // lines of the board's [reader]
    bool rogue_stream = false;  // the mission looks for the event stream at a port of its own, rogue_port
  };
  SocketRig() : SocketRig(Options{}) {}
  explicit SocketRig(const Options& options);
  ~SocketRig();
  SocketRig(const SocketRig&) = delete;
  SocketRig& operator=(const SocketRig&) = delete;

  // Start a program and, for the emulators, wait until it listens.
  void start_reader(std::vector<std::string> more = {}, ProgramOptions options = {});
  void start_autopilot(std::vector<std::string> more = {});
  Program& start_mission(ProgramOptions options = {});
  // The same scene and seed with every device in the program itself.
  ProgramResult fly_in_process() const;

  Program& reader() { return *reader_; }
  Program& autopilot() { return *autopilot_; }
  // What the autopilot has printed so far speaks of motors.
  bool autopilot_armed();

  [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }
  // EPCs in the inventory as it is now, mission under way or not.
  [[nodiscard]] std::set<std::string> inventory() const;
  // Sum of the reads of all items.
  [[nodiscard]] std::uint64_t inventory_reads() const;

  std::string host;
  std::uint16_t rest_port, stream_port, mavlink_port, pose_port, air_port, rogue_port;

 private:
  // Asks an emulator to end; it must do so well.
  static ProgramResult end(Program& emulator);
  void write_scene(const Options& options) const;
  void write_board(const Options& options) const;
  [[nodiscard]] std::vector<reader::InventoryItem> items() const;
  std::vector<std::string> with_shared(std::vector<std::string> arguments,
                                       const std::vector<std::string>& more) const;

  test::ScratchFolder folder_;
  std::optional<Program> reader_;
  std::optional<Program> autopilot_;
  std::optional<Program> mission_;
};

// Skips where the mission cannot be flown because a library was not built in.
class SocketTest : public testing::Test {
 protected:
  void SetUp() override;
};

}  // namespace forager::tools
