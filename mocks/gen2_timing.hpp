#pragma once

#include <cstdint>

#include "hal/error.hpp"
#include "mocks/gen2_wire.hpp"

namespace forager::mocks {

// Data rates and coding of a Gen2 link, both ways (Gen2 v1.2.0 sec. 6.3.1). Times in microseconds. The
// default is what ThingMagic modules use out of the box.
struct LinkProfile {
  double tari_us = 25.0;   // length of a reader's data-0, 6.25 to 25
  double pie = 2.0;        // length of its data-1 in Tari, 1.5 to 2
  double blf_khz = 250.0;  // backscatter link frequency, 40 to 640
  int m = 4;               // cycles per bit: 1 FM0, 2, 4, 8 Miller
  bool trext = false;      // tags send a pilot tone
  bool operator==(const LinkProfile&) const = default;
};

// Errors: invalid_argument with the field, its value and what is allowed, or that no divide ratio gives a
// TRcal within 1.1 to 3 RTcal: the reader could not tell a tag this link frequency.
[[nodiscard]] hal::Result<> validate(const LinkProfile& link);

// Everything the slot lengths are made of.
struct LinkTimes {
  double data0_us = 0.0;
  double data1_us = 0.0;
  double rtcal_us = 0.0;
  double trcal_us = 0.0;
  bool dr_64_3 = true;          // divide ratio: 64/3, else 8
  double frame_sync_us = 0.0;   // delimiter, Tari, RTcal
  double preamble_us = 0.0;     // and TRcal: before Query
  double bit_us = 0.0;          // of a tag
  double reply_frame_bits = 0;  // a tag's preamble and its closing dummy bit
  // From a command to a reply, from a reply to a command, silence after T1 that says nobody is there, from a
  // command to the next; nominal T1 (0.9 to 1.1 are allowed), T2 in the middle of its 3 to 20 periods.
  double t1_us = 0.0;
  double t2_us = 0.0;
  double t3_us = 0.0;
  double t4_us = 0.0;

  [[nodiscard]] double command_us(const Gen2Bits& bits) const;  // behind a frame-sync
  [[nodiscard]] double query_us(const Gen2Bits& bits) const;    // behind a preamble
  [[nodiscard]] double reply_us(double bits) const { return (reply_frame_bits + bits) * bit_us; }
};
// Of a link that passed validate().
[[nodiscard]] LinkTimes link_times(const LinkProfile& link);

// How long a slot takes, from the start of its command to the start of the next one, for the command
// QueryRep; another command adds what it is longer.
struct SlotTimes {
  double query_rep_us = 0.0;
  double query_adjust_us = 0.0;  // UpDn 000
  double query_us = 0.0;         // half of its bits ones
  double ack_us = 0.0;           // half of its bits ones
  double nak_us = 0.0;
  double rn16_us = 0.0;
  double epc_us = 0.0;         // PC, EPC, CRC
  double empty_us = 0.0;       // nobody answers
  double collided_us = 0.0;    // an RN16 that cannot be told
  double success_us = 0.0;     // RN16, ACK, EPC
  double ack_no_epc_us = 0.0;  // RN16, ACK, silence
};
// epc_bits: 96 for most tags; 16 to 496.
[[nodiscard]] SlotTimes slot_times(const LinkProfile& link, std::uint8_t session = 0, double epc_bits = 96.0);

// Tags per second when the number of replies in a slot is Poisson with this mean (framed ALOHA in the limit
// of many tags), and the mean at which it is highest.
[[nodiscard]] double aloha_rate(const SlotTimes& slots, double replies_per_slot);
[[nodiscard]] double best_replies_per_slot(const SlotTimes& slots);

}  // namespace forager::mocks
