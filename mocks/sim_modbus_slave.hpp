#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace forager::mocks {

// A Modbus device with declared registers, seen as bytes (Modbus application protocol V1.1b3; RTU: Modbus
// over serial line V1.02, CRC16 with polynomial 0xA001). What was not declared is answered with exception 2,
// an unknown function with 1; frames with a wrong CRC or for another unit are not answered at all. Codes and
// frames are its own.
class SimModbusSlave {
 public:
  enum class Framing : std::uint8_t { rtu, tcp };
  enum class Fault : std::uint8_t { none, silent, wrong_crc, wrong_unit, truncated };

  SimModbusSlave(std::uint8_t unit, Framing framing) : unit_(unit), framing_(framing) {}

  // The physical face.
  std::map<std::uint16_t, std::uint16_t> holding;  // readable and writable
  std::map<std::uint16_t, std::uint16_t> input;    // readable
  std::map<std::uint16_t, bool> coils;
  std::optional<std::uint8_t> exception_next;  // answered to the next request, whatever it is
  Fault fault = Fault::none;
  std::uint32_t requests = 0;

  // Bytes as they arrive, in any pieces; the answers they complete.
  [[nodiscard]] std::vector<std::uint8_t> feed(std::span<const std::uint8_t> bytes);
  // The line was quiet for three and a half characters: whatever came before is no beginning of a frame any
  // more. Without it noise would put every later frame out of step (RTU; a connection keeps its order).
  void silence() {
    if (framing_ == Framing::rtu) pending_.clear();
  }

 private:
  [[nodiscard]] std::size_t frame_size() const;
  [[nodiscard]] std::vector<std::uint8_t> answer(std::span<const std::uint8_t> frame);
  [[nodiscard]] std::vector<std::uint8_t> execute(std::span<const std::uint8_t> pdu);
  [[nodiscard]] std::vector<std::uint8_t> read(std::uint8_t function, std::uint16_t from,
                                               std::uint16_t count);

  std::uint8_t unit_;
  Framing framing_;
  std::vector<std::uint8_t> pending_;
};

}  // namespace forager::mocks
