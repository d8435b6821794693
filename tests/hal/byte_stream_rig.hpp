#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hal/byte_stream.hpp"

namespace forager::hal::contract {

// A stream under test with somebody at its other end.
class StreamRig {
 public:
  virtual ~StreamRig() = default;
  virtual ByteStream& stream() = 0;
  // The other end, once the stream is open. Stays the same until close_peer() or a new connection.
  virtual ByteStream& peer() = 0;
  // Lets a connect under way come through; called again and again until the stream is open.
  virtual void serve() {}
  // The other end hangs up; it can be called again.
  virtual void close_peer() = 0;
  // From now on nobody listens, or somebody does again. Only for streams that connect.
  virtual void refuse_connects(bool refuse) = 0;
};

struct RigMaker {
  std::string name;
  std::function<std::unique_ptr<StreamRig>()> make;
};

}  // namespace forager::hal::contract
