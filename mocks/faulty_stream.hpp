#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/byte_stream.hpp"
#include "hal/random.hpp"

namespace forager::mocks {

// How a line goes wrong; all chances in 0..1, all zero: a perfect line.
struct StreamFaults {
  double split = 0.0;       // per call: only part of the bytes now, the rest next time
  double join = 0.0;        // per call: nothing now, so that bytes pile up
  double drop = 0.0;        // per byte: lost
  double flip = 0.0;        // per byte: one bit inverted
  double garbage = 0.0;     // per call with bytes: 1..16 random bytes in front
  double disconnect = 0.0;  // per call: the connection is gone
};

// Breaks the bytes of another stream, seeded: equal seeds and equal calls give equal faults. Reads suffer all
// faults; writes suffer all but garbage, and a joined write takes nothing.
class FaultyStream final : public hal::ByteStream {
 public:
  FaultyStream(hal::ByteStream& line, const StreamFaults& read, const StreamFaults& write,
               std::uint64_t seed);

  void set_read_faults(const StreamFaults& faults) { read_ = faults; }
  void set_write_faults(const StreamFaults& faults) { write_ = faults; }
  [[nodiscard]] std::uint64_t faults() const { return faults_; }  // faults done so far

 private:
  hal::Result<> do_open() override { return line_->open(); }
  hal::Result<hal::StreamState> do_poll() override { return line_->poll(); }
  hal::Result<std::size_t> do_read(std::span<std::byte> into) override;
  hal::Result<std::size_t> do_write(std::span<const std::byte> bytes) override;
  void do_close() override;
  std::string_view do_name() const override { return line_->name(); }
  hal::Result<> maybe_disconnect(const StreamFaults& faults, const char* operation);
  bool happens(double chance);
  hal::Result<> flush();
  void damage(std::vector<std::byte>& bytes, const StreamFaults& faults);

  hal::ByteStream* line_;
  StreamFaults read_;
  StreamFaults write_;
  hal::Random random_;
  std::uint64_t faults_ = 0;
  std::vector<std::byte> damaged_;  // read from the line, damaged, not yet handed on
  std::size_t handed_on_ = 0;
  std::vector<std::byte> outgoing_;
  std::size_t sent_ = 0;
};

}  // namespace forager::mocks
