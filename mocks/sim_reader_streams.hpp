#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/byte_stream.hpp"
#include "hal/journal.hpp"
#include "hal/random.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/sim_reader_config.hpp"

namespace forager::mocks {

// The event stream server of an emulated AdvanReader (TCP port 3177): speaks first, needs no login, never
// waits for an acknowledgement. Frames (AdvanNet event stream):
//   ADVANNET/1.1\r\n Content-Length:<n>\r\n Content-Type:text/xml\r\n \r\n <n bytes> \r\n\r\n
// with n = 0 as keep-alive every 5 s. At most four clients; a fifth is closed. A client that reads too slowly
// loses the oldest of 100 waiting frames, unnoticed by it.
class SimReaderStreams {
 public:
  static constexpr std::size_t kMaxClients = 4;
  static constexpr std::size_t kMaxQueued = 100;
  static constexpr hal::Duration kKeepAlivePeriod = std::chrono::seconds(5);

  SimReaderStreams(const SimReaderConfig& config, const SimReaderFaults& faults, hal::Journal& journal);

  // A line whose device side may become a client whenever somebody dials. Both must outlive their attachment.
  void attach(MemoryStreamPair& line);
  // The accepted side of a real connection; let go as soon as it is closed and cannot be opened again.
  void attach(hal::ByteStream& end);
  void detach(const hal::ByteStream& end);
  [[nodiscard]] bool attached(const hal::ByteStream& end) const;

  // How the network sees the reader: off: cables are dead and nobody is told; booting: connects are refused.
  enum class Power : std::uint8_t { on, booting, off };
  void set_power(Power power, hal::Instant now);

  // Queues a message with this body for every client.
  void broadcast(std::string_view body);
  // Lets clients in and out, queues keep-alives, sends what the network takes.
  void update(hal::Instant now);

  [[nodiscard]] std::size_t clients() const;
  [[nodiscard]] std::uint64_t frames_dropped() const { return frames_dropped_; }

 private:
  struct Line {
    hal::ByteStream* end = nullptr;
    MemoryStreamPair* pair = nullptr;  // null for a real connection
    std::uint32_t connection = 0;      // of the pair, as last seen
    bool client = false;
    int number = 0;  // for people
    std::vector<std::string> queue = std::vector<std::string>(kMaxQueued);
    std::size_t head = 0;
    std::size_t count = 0;
    std::size_t sent = 0;   // bytes of the front frame already sent
    bool prepared = false;  // faults of the front frame have been drawn
    bool split = false;
    bool joined = false;          // a frame is waiting, or has waited, for the next one
    std::size_t close_after = 0;  // bytes of the front frame after which the connection is closed; 0: never
    hal::Instant join_until;
    hal::Instant silent_until;
    hal::Instant next_keep_alive;
  };

  bool service(Line& line, hal::Instant now);  // false: let the line go
  bool hang_up(Line& line, hal::Instant now, std::string_view why);
  void welcome(Line& line, hal::Instant now);
  bool hear(Line& line, hal::Instant now);
  bool send(Line& line, hal::Instant now);
  void prepare(Line& line, hal::Instant now);
  void enqueue(Line& line, std::string_view frame);
  void note(hal::Instant now, const Line& line, std::string_view what);

  const SimReaderConfig* config_;
  const SimReaderFaults* faults_;
  hal::Journal* journal_;
  hal::Random random_;
  std::vector<std::unique_ptr<Line>> lines_;
  std::string frame_;
  std::uint64_t frames_dropped_ = 0;
  int connections_ = 0;
  Power power_ = Power::on;
};

}  // namespace forager::mocks
