#include "mocks/http_server_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <variant>

namespace forager::mocks {
namespace {

constexpr std::size_t kMaxOutput = 256 * 1024;  // a client that does not read gets no further answers

std::string_view reason(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 405:
      return "Method Not Allowed";
    case 413:
      return "Content Too Large";
    case 431:
      return "Request Header Fields Too Large";
    case 500:
      return "Internal Server Error";
    case 501:
      return "Not Implemented";
    case 505:
      return "HTTP Version Not Supported";
    default:
      return "Status";
  }
}

}  // namespace

HttpServerSession::HttpServerSession(HttpHandler& handler, HttpServerDigest* digest,
                                     const HttpServerLimits& limits)
    : handler_(&handler), digest_(digest), limits_(&limits) {}

HttpServerSession::~HttpServerSession() {
  if (in_flight_) handler_->forget(*in_flight_);
}

std::size_t HttpServerSession::room() const {
  const std::size_t limit = limits_->header_bytes + limits_->body_bytes;
  return closing_ || in_.size() >= limit ? 0 : limit - in_.size();
}

void HttpServerSession::take_in(std::span<const std::byte> bytes, hal::Instant now) {
  if (closing_) return;
  in_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  update(now);
}

void HttpServerSession::update(hal::Instant now) {
  while (!closing_ && output().size() < kMaxOutput) {
    if (in_flight_) {
      const auto reply = handler_->take(*in_flight_, now);
      if (!reply) {
        if (!handler_->knows(*in_flight_)) closing_ = true;  // the device went down under the request
        return;
      }
      in_flight_.reset();
      answer(reply->status, reply->body);
    } else {
      const std::size_t before = in_.size();
      next_request(now);
      if (!in_flight_ && in_.size() == before) return;
    }
  }
}

void HttpServerSession::next_request(hal::Instant now) {
  if (in_.empty()) return;
  HttpParse parsed = take_http_request(in_, *limits_);
  if (const auto* more = std::get_if<HttpNeedsMore>(&parsed)) {
    if (more->expects_continue && !continued_) out_ += "HTTP/1.1 100 Continue\r\n\r\n";
    continued_ = continued_ || more->expects_continue;
  } else if (const auto* rejected = std::get_if<HttpRejected>(&parsed)) {
    keep_alive_ = false;
    answer(rejected->status, {});
  } else {
    continued_ = false;
    handle(std::get<HttpServerRequest>(parsed), now);
  }
}

void HttpServerSession::handle(const HttpServerRequest& request, hal::Instant now) {
  keep_alive_ = request.keep_alive;
  if (digest_ != nullptr) {
    const auto verdict = digest_->check(request.authorization, request.method, request.target);
    if (verdict != HttpServerDigest::Verdict::accepted)
      return answer(401, {},
                    fmt::format("WWW-Authenticate: {}\r\n",
                                digest_->challenge(verdict == HttpServerDigest::Verdict::stale)));
  }
  if (request.method != "GET" && request.method != "PUT") return answer(405, {}, "Allow: GET, PUT\r\n");
  const auto method = request.method == "GET" ? hal::HttpMethod::get : hal::HttpMethod::put;
  in_flight_ = handler_->submit(method, request.target, request.body, now);
}

void HttpServerSession::answer(int status, std::string_view body, std::string_view extra_header) {
  fmt::format_to(std::back_inserter(out_),
                 "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\n{}Connection: {}\r\n\r\n{}",
                 status, reason(status), body.starts_with('<') ? "text/xml; charset=UTF-8" : "text/plain",
                 body.size(), extra_header, keep_alive_ ? "keep-alive" : "close", body);
  if (!keep_alive_) closing_ = true;
}

void HttpServerSession::sent(std::size_t count) {
  sent_ = std::min(sent_ + count, out_.size());
  if (sent_ < out_.size()) return;
  out_.clear();
  sent_ = 0;
}

}  // namespace forager::mocks
