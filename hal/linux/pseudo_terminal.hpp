#pragma once

#include <memory>
#include <string>

#include "hal/byte_stream.hpp"

namespace forager::hal {

// The far end of a serial line that exists in the kernel only: what one program opens as a port, this is the
// device at its other end. It is there from construction on; open() waits for somebody to open the port
// (`opening` until then), and when they close it again reading says `disconnected` and open() waits anew. The
// end of the object is the adapter being unplugged. Baud rate and parity mean nothing here.
class PseudoTerminal : public ByteStream {
 public:
  [[nodiscard]] virtual const std::string& port() const = 0;  // what to open: the link, or "/dev/pts/7"
};

// `link` not empty: a symbolic link of that name leads to the port for as long as the object lives; one that
// is left from an earlier run is replaced. Errors: invalid_argument (`link` exists and is no symbolic link),
// permission, io (the kernel has no more of them).
[[nodiscard]] Result<std::unique_ptr<PseudoTerminal>> open_pseudo_terminal(const std::string& link = {});

}  // namespace forager::hal
