#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "hal/time.hpp"
#include "mocks/http_handler.hpp"
#include "mocks/http_server_digest.hpp"
#include "mocks/http_server_request.hpp"

namespace forager::mocks {

// One connection of the HTTP server of an emulated reader: bytes in, requests to the handler, bytes out.
// Requests may be pipelined; they are answered one after the other. GET and PUT only, 405 for the rest. After
// bytes that are no HTTP one answer (400, 413, 431, 501, 505) goes out and the connection ends.
class HttpServerSession {
 public:
  // digest: null for a server without authentication. All must outlive the session.
  HttpServerSession(HttpHandler& handler, HttpServerDigest* digest, const HttpServerLimits& limits);
  ~HttpServerSession();
  HttpServerSession(const HttpServerSession&) = delete;
  HttpServerSession& operator=(const HttpServerSession&) = delete;

  // How many bytes it would take in now: bounds what a client can make it keep.
  [[nodiscard]] std::size_t room() const;
  void take_in(std::span<const std::byte> bytes, hal::Instant now);
  // Drives the request in flight.
  void update(hal::Instant now);
  // Bytes to send; tell with sent() how many were.
  [[nodiscard]] std::string_view output() const { return std::string_view(out_).substr(sent_); }
  void sent(std::size_t count);
  // Nothing more will come: close the connection once the output is sent.
  [[nodiscard]] bool finished() const { return closing_ && sent_ == out_.size(); }

 private:
  void next_request(hal::Instant now);
  void handle(const HttpServerRequest& request, hal::Instant now);
  void answer(int status, std::string_view body, std::string_view extra_header = {});

  HttpHandler* handler_;
  HttpServerDigest* digest_;
  const HttpServerLimits* limits_;
  std::string in_;
  std::string out_;
  std::size_t sent_ = 0;
  std::optional<std::uint32_t> in_flight_;
  bool keep_alive_ = true;
  bool continued_ = false;  // "100 Continue" was said for the request now coming in
  bool closing_ = false;
};

}  // namespace forager::mocks
