#include "tests/hal/linux/http/tiny_http_server.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cctype>
#include <sstream>

#include "tests/hal/eventually.hpp"

namespace forager::hal {

TinyHttpServer::TinyHttpServer(Handler handler)
    : handler_(std::move(handler)), listener_(TcpListener::listen("127.0.0.1", 0).value()) {}

std::string TinyHttpServer::base_url() const { return fmt::format("http://127.0.0.1:{}", listener_.port()); }

void TinyHttpServer::serve() {
  if (auto next = listener_.accept().value()) {
    connection_ = std::move(next);
    inbox_.clear();
    ++connections_;
  }
  if (!connection_) return;
  std::vector<std::byte> room(4096);
  const auto count = connection_->read(room);
  if (!count) {
    connection_.reset();
    return;
  }
  inbox_ += contract::text_of(std::span(room).first(*count));
  while (auto request = take_request()) {
    seen_.push_back(*request);
    const std::string answer = handler_(*request);
    if (!connection_) return;
    (void)connection_->write(contract::bytes_of(answer));
  }
}

std::optional<SeenRequest> TinyHttpServer::take_request() {
  const std::size_t head_end = inbox_.find("\r\n\r\n");
  if (head_end == std::string::npos) return std::nullopt;
  SeenRequest request;
  const std::string head = inbox_.substr(0, head_end) + "\r\n";
  const std::size_t line_end = head.find("\r\n");
  const std::size_t space = head.find(' ');
  request.method = head.substr(0, space);
  request.target = head.substr(space + 1, head.rfind(' ', line_end) - space - 1);
  for (std::size_t at = line_end + 2; at < head.size();) {
    const std::size_t end = head.find("\r\n", at);
    const std::size_t colon = head.find(": ", at);
    std::string name = head.substr(at, colon - at);
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    request.headers[name] = head.substr(colon + 2, end - colon - 2);
    at = end + 2;
  }
  const std::size_t length =
      request.headers.contains("content-length") ? std::stoul(request.headers["content-length"]) : 0;
  if (inbox_.size() < head_end + 4 + length) return std::nullopt;
  request.body = inbox_.substr(head_end + 4, length);
  inbox_.erase(0, head_end + 4 + length);
  return request;
}

std::string http_answer(int status, const std::string& body, const std::string& extra_headers) {
  return fmt::format("HTTP/1.1 {} Text\r\nContent-Type: text/xml\r\nContent-Length: {}\r\n{}\r\n{}", status,
                     body.size(), extra_headers, body);
}

std::string DigestGuard::hash(const std::string& text) const {
  std::array<unsigned char, EVP_MAX_MD_SIZE> out{};
  unsigned size = 0;
  EVP_Digest(text.data(), text.size(), out.data(), &size,
             algorithm_.starts_with("SHA-256") ? EVP_sha256() : EVP_md5(), nullptr);
  std::string hex;
  for (unsigned i = 0; i < size; ++i) hex += fmt::format("{:02x}", out[i]);
  return hex;
}

std::string DigestGuard::challenge() const {
  return http_answer(401, "<html>401</html>",
                     fmt::format("WWW-Authenticate: Digest realm=\"reader\", qop=\"auth\", algorithm={}, "
                                 "nonce=\"{}\"\r\n",
                                 algorithm_, nonce_));
}

bool DigestGuard::admits(const SeenRequest& request) const {
  const auto header = request.headers.find("authorization");
  if (header == request.headers.end() || !header->second.starts_with("Digest ")) return false;
  std::map<std::string, std::string> field;
  std::istringstream parts(header->second.substr(7));
  for (std::string part; std::getline(parts >> std::ws, part, ',');) {
    const std::size_t equals = part.find('=');
    std::string value = part.substr(equals + 1);
    std::erase(value, '"');
    field[part.substr(0, equals)] = value;
  }
  if (field["nonce"] != nonce_ || field["uri"] != request.target || field["username"] != user_ ||
      field["qop"] != "auth" || field["nc"].size() != 8)
    return false;
  std::string ha1 = hash(user_ + ":reader:" + password_);
  if (algorithm_.ends_with("-sess")) ha1 = hash(ha1 + ":" + nonce_ + ":" + field["cnonce"]);
  const std::string ha2 = hash(request.method + ":" + request.target);
  return field["response"] ==
         hash(ha1 + ":" + nonce_ + ":" + field["nc"] + ":" + field["cnonce"] + ":auth:" + ha2);
}

}  // namespace forager::hal
