#pragma once

#include <cstdint>
#include <string>

#include "hal/time.hpp"
#include "mocks/sim_reader_faults.hpp"

namespace forager::mocks {

enum class SimReaderAuth : std::uint8_t {
  none,    // older firmware
  digest,  // newer firmware; Basic is answered with 401
};

// What a particular AdvanReader-160 is: what is printed on it, how it was set up when its power comes on.
struct SimReaderConfig {
  std::string name = "sim-reader";  // in the journal
  std::string device_id = "AdvanReader-m4-160";
  std::string ip = "192.168.26.120";
  std::string mac = "64:cf:d9:c7:56:1c";
  std::string product_code = "0091104";  // serial number = product code, "::", MAC without colons
  int ports = 4;
  std::string firmware = "2.10.33";
  std::string firmware_revision = "20260317_1530";

  std::int64_t clock_at_boot_ms = 1'779'868'340'000;   // Unix time of the reader's clock at power-up
  double clock_drift_ppm = 0.0;                        // positive: the reader's clock runs fast
  hal::Duration boot_time = std::chrono::seconds(25);  // after a reboot or power cut, not at construction
  bool autostart = false;  // RUNNING after boot; saved as DEVICE_RUNTIME_AUTOSTART

  SimReaderAuth auth = SimReaderAuth::none;
  std::string user = "admin";
  std::string password = "admin";

  // Two things the public material leaves open.
  int error_http_status = 200;         // HTTP status of an answer whose envelope says ERROR
  bool refuse_changes_running = true;  // PUT of modes and antennas while RUNNING: OPERATION_NOT_EXECUTED

  std::uint64_t seed = 1;     // of the faults
  bool journal_wire = false;  // stream bytes to the journal too
  SimReaderFaults faults;
};

}  // namespace forager::mocks
