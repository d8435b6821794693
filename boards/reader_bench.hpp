#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "boards/board.hpp"
#include "boards/scene.hpp"
#include "hal/byte_stream.hpp"
#include "hal/error.hpp"
#include "hal/http_client.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// The two connections to the reader of a board; drivers borrow them.
class ReaderBench {
 public:
  virtual ~ReaderBench() = default;
  [[nodiscard]] virtual hal::HttpClient& rest() = 0;
  [[nodiscard]] virtual hal::ByteStream& events() = 0;
  // Lets an emulated reader live up to `now`; a real one does that by itself.
  virtual void advance(hal::Instant now) = 0;
};

// Scene of a bench without one: four antennas around a vehicle that stands, 40 tags 1 to 2 m before the first
// of them, a few beside.
[[nodiscard]] hal::Result<Scene> bench_scene();

// The board of kind sim has a reader, its air and the scene's tags emulated in this process. Errors: those of
// reader_login(); unsupported.
[[nodiscard]] hal::Result<std::unique_ptr<ReaderBench>> open_reader_bench(const Board& board,
                                                                          const Scene& scene,
                                                                          std::uint64_t seed);

// User and password of the board's reader; empty: no login. Errors: not_present (the environment variable is
// not set).
struct ReaderLogin {
  std::string user;
  std::string password;
};
[[nodiscard]] hal::Result<std::optional<ReaderLogin>> reader_login(const Board& board);
// "http://192.168.1.50:3161"
[[nodiscard]] std::string reader_url(const Board& board);

}  // namespace forager::boards
