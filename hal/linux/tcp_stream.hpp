#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hal/byte_stream.hpp"

namespace forager::hal {

// A TCP connection to host:port, closed until open(). No delay of small writes (Nagle off); never raises
// SIGPIPE. open() looks the host up the first time it succeeds and remembers the addresses, so that
// reconnecting in flight never waits for a name server; a numeric address never waits at all. When a name has
// several addresses they are tried in turn.
//
// There is no connect time-out of its own: the kernel's is about two minutes, and a caller that wants less
// closes the stream.
//
// open() adds to the contract: invalid_argument (host empty, port 0).
[[nodiscard]] std::unique_ptr<ByteStream> open_tcp_stream(std::string host, std::uint16_t port);

}  // namespace forager::hal
