#include "mocks/sim_http_client.hpp"

#include <utility>

namespace forager::mocks {

using hal::ErrorCode;

SimHttpClient::SimHttpClient(SimHttpClientConfig config, SimReader& reader)
    : config_(std::move(config)), reader_(&reader) {}

bool SimHttpClient::credentials_fit() const {
  const SimReaderConfig& reader = reader_->config();
  return reader.auth == SimReaderAuth::none ||
         (config_.user == reader.user && config_.password == reader.password);
}

hal::Result<> SimHttpClient::do_start(const hal::HttpRequest& request, hal::Instant now) {
  if (in_flight_)
    return hal::fail(ErrorCode::busy, config_.name, "start request " + request.path, "one is in flight");
  InFlight flight{request.path, now + config_.latency, now + request.timeout, 0, false, std::nullopt};
  if (reader_->reachable(now) && credentials_fit()) {
    flight.id = reader_->submit(request.method, request.path, request.body, now);
    flight.submitted = true;
  }
  in_flight_ = std::move(flight);
  return {};
}

hal::Failure SimHttpClient::end(ErrorCode code, std::string detail, std::string mend) {
  const std::string operation = "request " + in_flight_->path;
  do_cancel();
  return hal::fail(code, config_.name, operation, std::move(detail), std::move(mend));
}

hal::Result<std::optional<hal::HttpResponse>> SimHttpClient::do_poll(hal::Instant now) {
  if (!in_flight_)
    return hal::fail(ErrorCode::invalid_state, config_.name, "poll", "no request is in flight");
  if (next_error_) {
    do_cancel();
    return hal::fail(*std::exchange(next_error_, std::nullopt));
  }
  InFlight& flight = *in_flight_;
  if (flight.submitted && !flight.reply) flight.reply = reader_->take(flight.id, now);
  const bool timed_out = now >= flight.timeout_at;
  if (now < flight.earliest && !timed_out) return std::optional<hal::HttpResponse>{};
  if (timed_out && (!flight.reply || flight.earliest >= flight.timeout_at))
    return end(ErrorCode::timeout, "no answer in time");
  if (flight.reply) {
    hal::HttpResponse response{flight.reply->status, std::move(flight.reply->body)};
    in_flight_.reset();
    return std::optional(std::move(response));
  }
  if (!reader_->powered()) return std::optional<hal::HttpResponse>{};
  if (!flight.submitted && !reader_->reachable(now)) return end(ErrorCode::refused, "nobody listens");
  if (!flight.submitted && !credentials_fit())
    return end(ErrorCode::authentication, "the reader answered 401",
               "Check user and password of the reader.");
  if (!flight.submitted || !reader_->knows(flight.id))
    return end(ErrorCode::disconnected, "the reader closed the connection");
  return std::optional<hal::HttpResponse>{};
}

void SimHttpClient::do_cancel() {
  if (in_flight_ && in_flight_->submitted) reader_->forget(in_flight_->id);
  in_flight_.reset();
}

}  // namespace forager::mocks
