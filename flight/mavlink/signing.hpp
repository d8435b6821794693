#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "flight/mavlink/frame.hpp"
#include "flight/mavlink/sha256.hpp"
#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::flight::mavlink {

using SigningKey = std::array<std::byte, 32>;

// The signing clock of an instant of wall time: 10 us units since 2015, 48 bits. Times before 2015 give 0.
[[nodiscard]] std::uint64_t signing_timestamp(hal::Duration since_unix_epoch);

enum class SignatureVerdict : std::uint8_t {
  good,
  exempt,  // unsigned RADIO_STATUS: the radio that made it has no key
  not_signed,
  wrong_hash,  // another key, or a forgery
  replayed,    // not later than the last good frame of the same stream
  too_old,     // first frame of a stream, more than a minute behind our clock
  too_many_streams,
};
[[nodiscard]] inline bool is_acceptable(SignatureVerdict verdict) {
  return verdict == SignatureVerdict::good || verdict == SignatureVerdict::exempt;
}

// Signs and checks the MAVLink 2 frames of one link (MAVLink message signing): the hash is the first six
// bytes of SHA-256(key, frame up to its CRC, link id, timestamp). One clock serves both directions and is
// moved forward by good frames, never by others. The caller stores timestamp() at least once a minute and
// gives it back at the next start, so that old frames stay old.
class Signing {
 public:
  // `start_timestamp`: the larger of the stored one and signing_timestamp(wall time); holds at `now`.
  // Errors: unsupported (built without libcrypto), io.
  [[nodiscard]] static hal::Result<Signing> create(const SigningKey& key, std::uint8_t link_id,
                                                   std::uint64_t start_timestamp, hal::Instant now);

  // Appends the signature to a frame encoded with kIncompatSigned. Errors: invalid_argument (MAVLink 1, or
  // encoded without the flag), io.
  [[nodiscard]] hal::Result<> sign(FrameBuffer& frame, hal::Instant now);

  // Errors: io. A frame that is not good changes nothing here.
  [[nodiscard]] hal::Result<SignatureVerdict> verify(const Frame& frame, hal::Instant now);

  [[nodiscard]] std::uint64_t timestamp() const { return timestamp_; }

 private:
  struct Stream {
    std::uint8_t sysid = 0;
    std::uint8_t compid = 0;
    std::uint8_t link_id = 0;
    std::uint64_t last_timestamp = 0;
  };

  Signing(const SigningKey& key, std::uint8_t link_id, std::uint64_t start_timestamp, hal::Instant now,
          Sha256 sha);
  void advance(hal::Instant now);
  Stream* find_stream(const Frame& frame, std::uint8_t link_id);

  SigningKey key_;
  std::uint8_t link_id_;
  std::uint64_t timestamp_;  // of the last frame signed or believed; the next one is larger
  hal::Instant clock_start_;
  std::uint64_t clock_base_;
  Sha256 sha_;
  std::array<Stream, 32> streams_{};
  std::size_t used_ = 0;
};

}  // namespace forager::flight::mavlink
