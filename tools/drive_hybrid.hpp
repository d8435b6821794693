#pragma once

#include <cstdint>
#include <string>

namespace forager::tools {

struct HybridDriveCommand {
  std::string scene;
  std::uint64_t seed = 1;  // of the first run; each next one has the next
  std::uint64_t runs = 1;
  bool json = false;
  std::string journal;          // of the first run; empty: none
  double least_arrived = 0.99;  // share of the runs that must arrive
};

// `forager drive` for a scene whose vehicle may also fly (table [hybrid]): says how the route was decided and
// on which assumptions, runs it, and prints a closing table. Always through MAVLink bytes and servo pulses.
// Gives an exit code of tools/cli_style.hpp: check failed when fewer runs arrived than asked, failure when a
// signal ended it or there is no route.
int run_hybrid_drive(const HybridDriveCommand& command);

}  // namespace forager::tools
