#include "mocks/gen2_timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace forager::mocks {
namespace {

constexpr double kDelimiter_us = 12.5;
constexpr double kShortestTrcal = 1.1;  // of RTcal
constexpr double kLongestTrcal = 3.0;
constexpr double kRatios[] = {64.0 / 3.0, 8.0};
// Sums of decimals such as 2.75 x 6.25 may miss a limit by a rounding error.
constexpr double kSlack = 1e-9;

double rtcal_us(const LinkProfile& link) { return (1.0 + link.pie) * link.tari_us; }

bool legal(double trcal_us, double rtcal_us) {
  return trcal_us >= kShortestTrcal * rtcal_us - kSlack && trcal_us <= kLongestTrcal * rtcal_us + kSlack;
}

hal::Result<> refuse(std::string detail) {
  return hal::fail(hal::ErrorCode::invalid_argument, "Gen2 link", "check parameters", std::move(detail));
}

}  // namespace

hal::Result<> validate(const LinkProfile& link) {
  const struct {
    const char* name;
    double value;
    double low;
    double high;
  } fields[] = {{"tari_us", link.tari_us, 6.25, 25.0},
                {"pie", link.pie, 1.5, 2.0},
                {"blf_khz", link.blf_khz, 40.0, 640.0}};
  for (const auto& f : fields)
    if (!(f.value >= f.low && f.value <= f.high))
      return refuse(fmt::format("{} = {} is not within {} to {}", f.name, f.value, f.low, f.high));
  if (link.m != 1 && link.m != 2 && link.m != 4 && link.m != 8)
    return refuse(fmt::format("m = {} is none of 1 (FM0), 2, 4, 8 (Miller)", link.m));
  for (const double ratio : kRatios)
    if (legal(1000.0 * ratio / link.blf_khz, rtcal_us(link))) return {};
  return refuse(fmt::format(
      "blf_khz = {} cannot be told with tari_us = {} and pie = {}: TRcal would be {:.1f} us (ratio 64/3) or "
      "{:.1f} us (ratio 8), and {:.1f} to {:.1f} us are allowed",
      link.blf_khz, link.tari_us, link.pie, 1000.0 * kRatios[0] / link.blf_khz,
      1000.0 * kRatios[1] / link.blf_khz, kShortestTrcal * rtcal_us(link), kLongestTrcal * rtcal_us(link)));
}

LinkTimes link_times(const LinkProfile& link) {
  LinkTimes t;
  t.data0_us = link.tari_us;
  t.data1_us = link.pie * link.tari_us;
  t.rtcal_us = rtcal_us(link);
  t.dr_64_3 = legal(1000.0 * kRatios[0] / link.blf_khz, t.rtcal_us);
  t.trcal_us = 1000.0 * (t.dr_64_3 ? kRatios[0] : kRatios[1]) / link.blf_khz;
  t.frame_sync_us = kDelimiter_us + t.data0_us + t.rtcal_us;
  t.preamble_us = t.frame_sync_us + t.trcal_us;
  const double period_us = 1000.0 / link.blf_khz;
  t.bit_us = link.m * period_us;
  const double preamble_bits = (link.m == 1 ? 6.0 : 10.0) + (link.trext ? 12.0 : 0.0);
  t.reply_frame_bits = preamble_bits + 1.0;
  t.t1_us = std::max(t.rtcal_us, 10.0 * period_us);
  t.t2_us = 10.0 * period_us;
  t.t3_us = 0.0;
  t.t4_us = 2.0 * t.rtcal_us;
  return t;
}

double LinkTimes::command_us(const Gen2Bits& bits) const {
  const auto ones = static_cast<double>(bits.ones());
  return frame_sync_us + ones * data1_us + (static_cast<double>(bits.size()) - ones) * data0_us;
}

double LinkTimes::query_us(const Gen2Bits& bits) const {
  return command_us(bits) + preamble_us - frame_sync_us;
}

SlotTimes slot_times(const LinkProfile& link, std::uint8_t session, double epc_bits) {
  const LinkTimes t = link_times(link);
  const double mean_bit_us = 0.5 * (t.data0_us + t.data1_us);
  constexpr double kRn16Bits = 16.0;
  constexpr double kPcAndCrcBits = 32.0;
  SlotTimes s;
  s.query_rep_us = t.command_us(encode_query_rep(session));
  s.query_adjust_us = t.command_us(encode_query_adjust(session, Gen2UpDn::same));
  s.query_us = t.preamble_us + 22.0 * mean_bit_us;
  s.ack_us = t.frame_sync_us + 18.0 * mean_bit_us;
  s.nak_us = t.command_us(encode_nak());
  s.rn16_us = t.reply_us(kRn16Bits);
  s.epc_us = t.reply_us(epc_bits + kPcAndCrcBits);
  const double silence_us = std::max(t.t1_us + t.t3_us, t.t4_us);
  s.empty_us = s.query_rep_us + silence_us;
  s.collided_us = s.query_rep_us + t.t1_us + s.rn16_us + t.t2_us;
  s.success_us = s.collided_us + s.ack_us + t.t1_us + s.epc_us + t.t2_us;
  s.ack_no_epc_us = s.collided_us + s.ack_us + silence_us;
  return s;
}

double aloha_rate(const SlotTimes& s, double mean) {
  const double none = std::exp(-mean);
  const double one = mean * none;
  return 1e6 * one / (none * s.empty_us + one * s.success_us + (1.0 - none - one) * s.collided_us);
}

double best_replies_per_slot(const SlotTimes& slots) {
  // The rate has one maximum: golden section.
  constexpr double kGolden = 0.6180339887498949;
  double low = 1e-3;
  double high = 4.0;
  while (high - low > 1e-9) {
    const double a = high - kGolden * (high - low);
    const double b = low + kGolden * (high - low);
    (aloha_rate(slots, a) < aloha_rate(slots, b) ? low : high) =
        aloha_rate(slots, a) < aloha_rate(slots, b) ? a : b;
  }
  return 0.5 * (low + high);
}

}  // namespace forager::mocks
