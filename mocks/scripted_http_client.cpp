#include "mocks/scripted_http_client.hpp"

#include <fmt/format.h>

namespace forager::mocks {
namespace {

std::string_view verb(hal::HttpMethod method) { return method == hal::HttpMethod::get ? "GET" : "PUT"; }

}  // namespace

ScriptedHttpClient::ScriptedHttpClient(std::string name, ScriptFailure on_failure)
    : name_(std::move(name)), on_failure_(std::move(on_failure)) {}

ScriptedHttpClient::~ScriptedHttpClient() {
  if (!exchanges_.empty())
    on_failure_(fmt::format("{}: {} requests never came, the next was {} {}", name_, exchanges_.size(),
                            verb(exchanges_.front().method), exchanges_.front().path));
}

ScriptedHttpClient& ScriptedHttpClient::expect(hal::HttpMethod method, std::string_view path,
                                               std::optional<std::string> body) {
  exchanges_.push_back(
      {method, std::string(path), std::move(body), hal::HttpResponse{200, {}}, std::nullopt, latency_});
  return *this;
}

ScriptedHttpClient& ScriptedHttpClient::answer(int status, std::string_view body) {
  if (exchanges_.empty())
    on_failure_(name_ + ": answer() without expect()");
  else
    exchanges_.back().response = {status, std::string(body)};
  return *this;
}

ScriptedHttpClient& ScriptedHttpClient::fail(hal::Error error) {
  if (exchanges_.empty())
    on_failure_(name_ + ": fail() without expect()");
  else
    exchanges_.back().error = std::move(error);
  return *this;
}

ScriptedHttpClient& ScriptedHttpClient::latency(hal::Duration latency) {
  latency_ = latency;
  return *this;
}

void ScriptedHttpClient::check(const Exchange& wanted, const hal::HttpRequest& request) {
  if (wanted.method != request.method || wanted.path != request.path)
    on_failure_(fmt::format("{}: came {} {}, the script wants {} {}", name_, verb(request.method),
                            request.path, verb(wanted.method), wanted.path));
  else if (wanted.body && *wanted.body != request.body)
    on_failure_(fmt::format("{}: {} {} came with body '{}', the script wants '{}'", name_,
                            verb(request.method), request.path, request.body, *wanted.body));
}

hal::Result<> ScriptedHttpClient::do_start(const hal::HttpRequest& request, hal::Instant now) {
  if (in_flight_)
    return hal::fail(hal::ErrorCode::busy, name_, "start request " + request.path, "one is in flight");
  if (exchanges_.empty()) {
    on_failure_(fmt::format("{}: unexpected {} {}", name_, verb(request.method), request.path));
    return hal::fail(hal::ErrorCode::io, name_, "start request " + request.path, "not in the script");
  }
  Exchange exchange = std::move(exchanges_.front());
  exchanges_.pop_front();
  check(exchange, request);
  const hal::Instant answer_at = now + exchange.latency;
  in_flight_ = InFlight{std::move(exchange), answer_at, now + request.timeout};
  return {};
}

hal::Result<std::optional<hal::HttpResponse>> ScriptedHttpClient::do_poll(hal::Instant now) {
  if (!in_flight_) return hal::fail(hal::ErrorCode::invalid_state, name_, "poll", "no request is in flight");
  const bool answers_in_time = in_flight_->answer_at < in_flight_->timeout_at;
  if (answers_in_time && now >= in_flight_->answer_at) {
    Exchange exchange = std::move(in_flight_->exchange);
    in_flight_.reset();
    if (exchange.error) return hal::fail(std::move(*exchange.error));
    return std::optional(std::move(exchange.response));
  }
  if (now >= in_flight_->timeout_at) {
    const std::string path = in_flight_->exchange.path;
    in_flight_.reset();
    return hal::fail(hal::ErrorCode::timeout, name_, "request " + path, "no answer in time");
  }
  return std::optional<hal::HttpResponse>{};
}

void ScriptedHttpClient::do_cancel() {
  if (in_flight_) ++cancelled_;
  in_flight_.reset();
}

}  // namespace forager::mocks
