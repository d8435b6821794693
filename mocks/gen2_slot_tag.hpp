#pragma once

#include <cstdint>

#include "hal/random.hpp"
#include "mocks/gen2_field_flags.hpp"
#include "mocks/gen2_wire.hpp"

namespace forager::mocks {

enum class TagState : std::uint8_t { ready, arbitrate, reply, acknowledged };
// What a tag backscatters after a command.
enum class TagReply : std::uint8_t { nothing, rn16, epc };

// One tag as the standard describes it, command by command (Gen2 v1.2.0 sec. 6.3.2.5, inventory part).
// Without power it hears nothing. The reference that the rounds of the slot-level field are tested against.
class SlotTag {
 public:
  static constexpr std::uint16_t kWrappedSlot = 0x7FFF;

  // flags must outlive the tag; index is its number there.
  SlotTag(SessionFlags& flags, std::uint32_t index, std::uint64_t seed)
      : flags_(&flags), index_(index), random_(seed) {}

  // The carrier comes: into ready with the flags whose persistence lasted. carrier: number of this stretch
  // of carrier, new after each break.
  void power_on(double now_s, std::uint64_t carrier);
  // It goes, in whatever state: what was acknowledged without another command is not inventoried.
  void power_off(double now_s);

  TagReply query(const Gen2Query& query, double now_s);
  TagReply query_rep(std::uint8_t session, double now_s);
  TagReply query_adjust(std::uint8_t session, Gen2UpDn change, double now_s);
  TagReply ack(std::uint16_t rn16);
  void nak();
  // No command within T2 after its reply.
  void time_out() { nak(); }
  // Select with a mask that this tag matches or not; target and action as in Gen2SelectCommand.
  void select(std::uint8_t target, std::uint8_t action, bool matches, double now_s);

  [[nodiscard]] TagState state() const { return state_; }
  [[nodiscard]] std::uint16_t slot() const { return slot_; }
  [[nodiscard]] std::uint16_t rn16() const { return rn16_; }
  // The flag as the tag takes it: a timer of S1 that ends within a round is heeded after it.
  [[nodiscard]] bool is_b(int session, double now_s) const;

 private:
  TagReply draw_slot();
  void count_if_acknowledged(double now_s);

  SessionFlags* flags_;
  std::uint32_t index_;
  hal::Random random_;
  bool powered_ = false;
  std::uint64_t carrier_ = 0;
  TagState state_ = TagState::ready;
  std::uint8_t session_ = 0;
  std::uint8_t q_ = 0;
  std::uint16_t slot_ = 0;
  std::uint16_t rn16_ = 0;
  bool s1_in_round_ = false;  // the flag of S1 as it was when the round began
};

}  // namespace forager::mocks
