#pragma once

#include <optional>
#include <string>

#include "hal/http_client.hpp"
#include "mocks/sim_reader.hpp"

namespace forager::mocks {

// What the way to an emulated reader is like, and what the client says it may do.
struct SimHttpClientConfig {
  std::string name = "http sim-reader";
  hal::Duration latency{};  // shortest time from start() to the answer, network both ways
  std::string user;         // checked when the reader demands digest; empty: none given
  std::string password;
};

// HTTP to an emulated reader in the same process, in its virtual time, without bytes in between. Fails as a
// network does: refused while the reader boots or refuses, silence (timeout) while it has no power,
// disconnected when it reboots under a request, authentication with other credentials than its own.
class SimHttpClient final : public hal::HttpClient {
 public:
  SimHttpClient(SimHttpClientConfig config, SimReader& reader);

  void fail_next(hal::Error error) { next_error_ = std::move(error); }
  void set_latency(hal::Duration latency) { config_.latency = latency; }

 private:
  struct InFlight {
    std::string path;
    hal::Instant earliest;
    hal::Instant timeout_at;
    std::uint32_t id = 0;
    bool submitted = false;
    std::optional<HttpReply> reply;
  };

  hal::Result<> do_start(const hal::HttpRequest& request, hal::Instant now) override;
  hal::Result<std::optional<hal::HttpResponse>> do_poll(hal::Instant now) override;
  void do_cancel() override;
  std::string_view do_name() const override { return config_.name; }
  hal::Failure end(hal::ErrorCode code, std::string detail, std::string mend = {});
  [[nodiscard]] bool credentials_fit() const;

  SimHttpClientConfig config_;
  SimReader* reader_;
  std::optional<InFlight> in_flight_;
  std::optional<hal::Error> next_error_;
};

}  // namespace forager::mocks
