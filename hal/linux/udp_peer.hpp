#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hal/byte_stream.hpp"

namespace forager::hal {

// One peer over UDP: a write is a datagram, a read takes at most one. Datagrams of anybody else are dropped,
// and so are empty ones and those larger than the room given to read().
class UdpPeer : public ByteStream {
 public:
  // The local port while opening or open; 0 when closed. Tells which one the kernel chose for port 0.
  [[nodiscard]] virtual std::uint16_t local_port() const = 0;
};

// Speaks to a known address and hears only that. local_port 0: any. Open at once; a peer that is not there
// yet is no error, what is sent to it is lost, as UDP is. open() adds invalid_argument (host empty, port 0)
// to the contract; busy: the local port is in use.
[[nodiscard]] std::unique_ptr<UdpPeer> open_udp_peer(std::string remote_host, std::uint16_t remote_port,
                                                     std::uint16_t local_port = 0);

// Waits at local_host:local_port (empty host: every IPv4 address; port 0: any, but always the same) and stays
// `opening` until the first datagram arrives; its sender is the peer from then on. When the peer's machine
// reports that its port is closed, or after close() and open(), the next sender is learnt.
[[nodiscard]] std::unique_ptr<UdpPeer> open_udp_listener(std::string local_host, std::uint16_t local_port);

}  // namespace forager::hal
