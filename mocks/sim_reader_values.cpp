#include "mocks/sim_reader_values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace forager::mocks {
namespace {

using Kind = SimReaderValue::Kind;
using Group = SimReaderValue::Group;

constexpr std::string_view kOffTimes = "0 10 20 30 40 50 75 100 125 150 175 200";

constexpr SimReaderValue number(std::string_view name, std::string_view initial, double low, double high,
                                double step) {
  SimReaderValue value{name, initial};
  value.kind = Kind::number;
  value.low = low;
  value.high = high;
  value.step = step;
  return value;
}

constexpr SimReaderValue words(std::string_view name, std::string_view initial, std::string_view allowed) {
  SimReaderValue value{name, initial};
  value.kind = Kind::words;
  value.words = allowed;
  return value;
}

constexpr SimReaderValue boolean(std::string_view name, std::string_view initial,
                                 Group group = Group::reader) {
  SimReaderValue value{name, initial};
  value.kind = Kind::boolean;
  value.group = group;
  return value;
}

constexpr SimReaderValue read_only(std::string_view name, std::string_view initial,
                                   Group group = Group::reader) {
  SimReaderValue value{name, initial};
  value.kind = Kind::fixed;
  value.read_only = true;
  value.group = group;
  return value;
}

// Ranges from the AdvanNet parameter resources; the sensitivity floor is that of the M6e module.
constexpr std::array kParameters{
    number("RF_READ_POWER", "31.5", 0.0, 31.5, 0.5),
    number("RF_WRITE_POWER", "31.5", 0.0, 31.5, 0.5),
    number("RF_SENSITIVITY", "-82.0", -90.0, -20.0, 0.0),
    read_only("RF_PORT_NUMBER", "4"),
    read_only("RF_POWER_MIN", "0"),
    read_only("RF_POWER_MAX", "31.5"),
    read_only("RF_SENSITIVITY_MIN", "-90"),
    read_only("RF_SENSITIVITY_MAX", "-20"),
    read_only("RF_CHIP_TEMP", "43"),
    words("RF_REGION", "ETSI", "FCC ETSI OPEN"),
    number("RF_ASYNCH_ONTIME", "600", 50, 3000, 1),
    words("RF_ASYNCH_OFFTIME", "0", kOffTimes),
    words("GEN2_SESSION", "S0", "S0 S1 S2 S3"),
    words("GEN2_TARGET", "A", "A B AB BA"),
    words("GEN2_Q", "Q_DYNAMIC",
          "Q_DYNAMIC Q_1 Q_2 Q_3 Q_4 Q_5 Q_6 Q_7 Q_8 Q_9 Q_10 Q_11 Q_12 Q_13 Q_14 Q_15"),
    words("GEN2_ENCODING", "M4", "HIGH_SPEED HYBRID M2 M4 M8 MAX_MILLER FM0 AUTO_DRM AUTO_SINGLE"),
    words("GEN2_BLF", "BLF250", "BLF250 BLF300 BLF640"),
    words("GEN2_TARI", "TARI25", "TARI6_25 TARI12_5 TARI25"),
    read_only("DATA_GPI_NUMBER", "4"),
    read_only("DATA_GPO_NUMBER", "10"),
    boolean("DEVICE_RUNTIME_AUTOSTART", "false", Group::device),
    read_only("MCU_GPI_NUMBER", "4", Group::mcu),
    read_only("MCU_GPO_NUMBER", "10", Group::mcu),
    boolean("MCU_GPI_NOTIFICATION_ENABLE", "true", Group::mcu),
};

// Filters, TID reading and calibrators exist in the device and not here: only "off" is accepted.
constexpr SimReaderValue kFilterOffset = number("filterMaskOffset", "32", 0, 496, 4);
constexpr SimReaderValue kFilterLength = words("filterMaskBitLength", "0", "0");
constexpr SimReaderValue kFilterHex = words("filterMaskHex", "", "");
constexpr SimReaderValue kFilterOnly = words("swFilterOnly", "false", "false");
constexpr SimReaderValue kTid = words("enableTID", "false", "false");
constexpr SimReaderValue kTidOffset = number("TIDOffset", "0", 0, 80, 1);
constexpr SimReaderValue kTidLength = number("TIDLength", "64", 16, 96, 1);
constexpr SimReaderValue kCalibrators = words("startUpCalibrators", "None", "None");
constexpr SimReaderValue kCalibratorsPeriod = number("calibratorsRefreshPeriod", "60", 0, 10080, 1);

constexpr std::array kAutonomous{
    boolean("useFastSearch", "false"),
    kFilterOnly,
    kFilterOffset,
    kFilterLength,
    kFilterHex,
    kTid,
    kTidOffset,
    kTidLength,
    kCalibrators,
    kCalibratorsPeriod,
    boolean("keepAllReads", "false"),
    words("asynch", "true", "true"),
    boolean("cleanBufferOnSynchRead", "false"),
    number("timeWindow", "2500", 0, 60000, 1),
    number("onTime", "600", 50, 3000, 1),
    words("offTime", "0", kOffTimes),
};

constexpr std::array kSequential{
    number("readTime", "500", 100, 5000, 1),
    boolean("smartReading", "false"),
    number("antennaFactor", "0.8", 0, 1, 0),
    kFilterOnly,
    kFilterOffset,
    kFilterLength,
    kFilterHex,
    kTid,
    kTidOffset,
    kTidLength,
    kCalibrators,
    kCalibratorsPeriod,
};

bool is_word(std::string_view list, std::string_view text) {
  if (list.empty()) return text.empty();
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(' '), list.size());
    if (list.substr(0, end) == text) return true;
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return false;
}

}  // namespace

std::span<const SimReaderValue> sim_reader_parameters() { return kParameters; }
std::span<const SimReaderValue> sim_autonomous_parameters() { return kAutonomous; }
std::span<const SimReaderValue> sim_sequential_parameters() { return kSequential; }

const SimReaderValue* find_value(std::span<const SimReaderValue> table, std::string_view name) {
  const auto found = std::ranges::find(table, name, &SimReaderValue::name);
  return found == table.end() ? nullptr : &*found;
}

std::optional<double> decimal(std::string_view text) {
  double written = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), written, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(written))
    return std::nullopt;
  return written;
}

bool allows(const SimReaderValue& value, std::string_view text) {
  switch (value.kind) {
    case Kind::fixed:
      return false;
    case Kind::boolean:
      return text == "true" || text == "false";
    case Kind::words:
      return is_word(value.words, text);
    case Kind::number:
      break;
  }
  const auto written = decimal(text);
  if (!written || *written < value.low || *written > value.high) return false;
  return value.step == 0.0 || std::fmod(*written - value.low, value.step) == 0.0;
}

}  // namespace forager::mocks
