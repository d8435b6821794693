#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "hal/error.hpp"

namespace forager::hal {

// The two directions of an established TCP connection, shared by dialled and accepted streams. Neither call
// blocks nor raises SIGPIPE; both leave the descriptor open, closing after an error is the stream's part.

// Errors: disconnected (the peer closed or reset), io.
[[nodiscard]] Result<std::size_t> receive_stream(int fd, std::span<std::byte> into, std::string_view device);

// When the peer has gone but left bytes that were not read yet, answers 0 instead of the error, so that
// read() can still deliver them and then report the loss. Errors: as above.
[[nodiscard]] Result<std::size_t> send_stream(int fd, std::span<const std::byte> bytes,
                                              std::string_view device);

}  // namespace forager::hal
