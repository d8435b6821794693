#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/random.hpp"

namespace forager::mocks {

// HTTP Digest access authentication, server side (RFC 7616: MD5, qop "auth"). Anything but Digest, Basic
// included, does not get in.
class HttpServerDigest {
 public:
  HttpServerDigest(std::string realm, std::string user, const std::string& password, std::uint64_t seed);

  enum class Verdict : std::uint8_t {
    accepted,
    refused,  // no or other credentials
    stale,    // right credentials, but the nonce is unknown, forgotten or already used with this count
  };
  // `authorization`: value of the header, empty if it did not come.
  [[nodiscard]] Verdict check(std::string_view authorization, std::string_view method,
                              std::string_view target);
  // Value of a WWW-Authenticate header with a new nonce. The last 64 nonces are remembered.
  [[nodiscard]] std::string challenge(bool stale);

 private:
  struct Nonce {
    std::string text;
    std::uint32_t last_count = 0;
  };

  std::string realm_;
  std::string user_;
  std::string secret_;  // MD5 of user:realm:password
  hal::Random random_;
  std::vector<Nonce> nonces_;
};

}  // namespace forager::mocks
