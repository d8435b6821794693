#pragma once

#include <memory>
#include <string>

#include "boards/bench_board.hpp"
#include "hal/error.hpp"
#include "hal/hid.hpp"
#include "hal/time.hpp"
#include "reader/hid_wedge.hpp"

namespace forager::boards {

// Where a reader that plays a keyboard is plugged in: this machine, or one emulated in this process.
class WedgeBench {
 public:
  virtual ~WedgeBench() = default;
  [[nodiscard]] virtual hal::Hid& hid() = 0;
  // Lets an emulated reader live: it reads one of ten tags every half second.
  virtual void advance(hal::Instant now) = 0;
  [[nodiscard]] virtual bool emulated() const = 0;
};

// Errors: unsupported (built without hidapi), io.
[[nodiscard]] hal::Result<std::unique_ptr<WedgeBench>> open_wedge_bench(const BenchWedge& wedge);
// What its driver is to be told.
[[nodiscard]] reader::HidWedgeConfig wedge_config(const BenchWedge& wedge);
// Errors: invalid_argument, naming those there are.
[[nodiscard]] hal::Result<BenchWedge> find_wedge(const BenchBoard& board, const std::string& text);

}  // namespace forager::boards
