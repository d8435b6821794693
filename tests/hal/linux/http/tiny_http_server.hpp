#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/linux/tcp_listener.hpp"

namespace forager::hal {

struct SeenRequest {
  std::string method;
  std::string target;
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;
};

// Just enough of an HTTP/1.1 server to hold the client to its contract, driven by the test's own loop. What
// it sends back is up to the test, byte for byte.
class TinyHttpServer {
 public:
  using Handler = std::function<std::string(const SeenRequest&)>;  // the whole answer; empty: say nothing

  explicit TinyHttpServer(Handler handler);
  void serve();
  void hang_up() { connection_.reset(); }
  [[nodiscard]] std::string base_url() const;
  [[nodiscard]] const std::vector<SeenRequest>& seen() const { return seen_; }
  [[nodiscard]] int connections() const { return connections_; }

 private:
  [[nodiscard]] std::optional<SeenRequest> take_request();

  Handler handler_;
  TcpListener listener_;
  std::unique_ptr<ByteStream> connection_;
  std::string inbox_;
  std::vector<SeenRequest> seen_;
  int connections_ = 0;
};

[[nodiscard]] std::string http_answer(int status, const std::string& body,
                                      const std::string& extra_headers = {});

// A server side of RFC 7616 Digest with qop=auth, on OpenSSL's hashes and independent of the client's.
class DigestGuard {
 public:
  // algorithm: "MD5", "SHA-256", "MD5-sess", "SHA-256-sess".
  DigestGuard(std::string algorithm, std::string user, std::string password)
      : algorithm_(std::move(algorithm)), user_(std::move(user)), password_(std::move(password)) {}
  [[nodiscard]] bool admits(const SeenRequest& request) const;
  [[nodiscard]] std::string challenge() const;  // a whole 401 answer
  void renew_nonce() { nonce_ += "x"; }

 private:
  [[nodiscard]] std::string hash(const std::string& text) const;

  std::string algorithm_;
  std::string user_;
  std::string password_;
  std::string nonce_ = "dcd98b7102dd2f0e8b11d0f600bfb0c093";
};

}  // namespace forager::hal
