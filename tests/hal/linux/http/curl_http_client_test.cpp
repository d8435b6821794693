#include "hal/linux/curl_http_client.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "hal/linux/steady_clock.hpp"
#include "hal/linux/tcp_stream.hpp"
#include "tests/hal/eventually.hpp"
#include "tests/hal/linux/http/tiny_http_server.hpp"

namespace forager::hal {
namespace {

using contract::eventually;

HttpRequest get(std::string path) { return {HttpMethod::get, std::move(path), "", "", 5s}; }
HttpRequest put(std::string path, std::string body) {
  return {HttpMethod::put, std::move(path), std::move(body), "", 5s};
}

class CurlHttpClient : public testing::Test {
 protected:
  using Outcome = Result<HttpResponse>;

  // One exchange, driving both sides until it ends.
  Outcome exchange(HttpClient& client, TinyHttpServer& server, const HttpRequest& request) {
    const auto started = client.start(request, clock_->now());
    if (!started) return fail(started.error());
    Outcome outcome = fail(ErrorCode::timeout, "test", "exchange", "the request never ended");
    (void)eventually([&] {
      server.serve();
      auto polled = client.poll(clock_->now());
      if (!polled)
        outcome = fail(polled.error());
      else if (*polled)
        outcome = **polled;
      else
        return false;
      return true;
    });
    return outcome;
  }

  std::unique_ptr<Clock> clock_ = make_steady_clock();
};

TEST_F(CurlHttpClient, CarriesPathBodyAndStatusAsTheyAre) {
  TinyHttpServer server([](const SeenRequest& request) {
    return request.method == "GET" ? http_answer(200, "<device/>") : http_answer(404, "<error/>");
  });
  auto client = make_curl_http_client(server.base_url());
  const auto got = exchange(*client, server, get("/devices/x/readModes%5B0%5D/../a"));
  ASSERT_TRUE(got.has_value()) << describe(got.error());
  EXPECT_EQ(200, got->status);
  EXPECT_EQ("<device/>", got->body);
  const auto refused = exchange(*client, server, put("/devices/x/activeDeviceMode", "AUTONOMOUS"));
  ASSERT_TRUE(refused.has_value()) << describe(refused.error());
  EXPECT_EQ(404, refused->status);
  const auto again = exchange(*client, server, get("/devices"));
  ASSERT_TRUE(again.has_value());

  ASSERT_EQ(3U, server.seen().size());
  EXPECT_EQ("/devices/x/readModes%5B0%5D/../a", server.seen()[0].target);
  EXPECT_FALSE(server.seen()[0].headers.contains("authorization"));
  EXPECT_EQ("PUT", server.seen()[1].method);
  EXPECT_EQ("AUTONOMOUS", server.seen()[1].body);
  EXPECT_EQ("text/plain", server.seen()[1].headers.at("content-type"));
  EXPECT_FALSE(server.seen()[1].headers.contains("expect"));
  EXPECT_EQ("GET", server.seen()[2].method);
  EXPECT_EQ("", server.seen()[2].body);
  EXPECT_EQ(1, server.connections()) << "the connection is kept";
}

TEST_F(CurlHttpClient, SendsEmptyAndBinaryBodies) {
  TinyHttpServer server([](const SeenRequest& request) { return http_answer(200, request.body); });
  auto client = make_curl_http_client(server.base_url());
  EXPECT_EQ("", exchange(*client, server, put("/a", "")).value().body);
  EXPECT_EQ("0", server.seen().back().headers.at("content-length"));
  const std::string binary("a\0b\xff", 4);
  HttpRequest request = put("/a", binary);
  request.content_type = "application/octet-stream";
  EXPECT_EQ(binary, exchange(*client, server, request).value().body);
  EXPECT_EQ("application/octet-stream", server.seen().back().headers.at("content-type"));
}

TEST_F(CurlHttpClient, AnswersEveryDigestAlgorithmAndKeepsTheNonce) {
  for (const std::string algorithm : {"MD5", "SHA-256", "MD5-sess", "SHA-256-sess"}) {
    SCOPED_TRACE(algorithm);
    const DigestGuard guard(algorithm, "admin", "secret");
    TinyHttpServer server([&](const SeenRequest& request) {
      return guard.admits(request) ? http_answer(200, request.body) : guard.challenge();
    });
    auto client = make_curl_http_client(server.base_url(), HttpCredentials{"admin", "secret"});
    EXPECT_EQ("one", exchange(*client, server, put("/devices/x", "one")).value().body);
    ASSERT_EQ(2U, server.seen().size());
    EXPECT_FALSE(server.seen()[0].headers.contains("authorization")) << "the first request goes out bare";
    EXPECT_EQ("one", server.seen()[0].body) << "and whole: an old reader without passwords carries it out";
    EXPECT_EQ("two", exchange(*client, server, put("/devices/x", "two")).value().body);
    EXPECT_EQ(3U, server.seen().size()) << "the second needs no new challenge";
    EXPECT_NE(std::string::npos, server.seen()[2].headers.at("authorization").find("nc=00000002"));
  }
}

TEST_F(CurlHttpClient, TakesANewNonceWhenTheServerRestarted) {
  DigestGuard guard("MD5", "admin", "secret");
  TinyHttpServer server([&](const SeenRequest& request) {
    return guard.admits(request) ? http_answer(200, request.body) : guard.challenge();
  });
  auto client = make_curl_http_client(server.base_url(), HttpCredentials{"admin", "secret"});
  ASSERT_TRUE(exchange(*client, server, put("/a", "one")).has_value());
  guard.renew_nonce();
  const auto outcome = exchange(*client, server, put("/a", "two"));
  ASSERT_TRUE(outcome.has_value()) << describe(outcome.error());
  EXPECT_EQ("two", outcome->body);
}

TEST_F(CurlHttpClient, WrongPasswordIsAnAuthenticationErrorAndIsNotHammered) {
  const DigestGuard guard("MD5", "admin", "secret");
  TinyHttpServer server([&](const SeenRequest& request) {
    return guard.admits(request) ? http_answer(200, "") : guard.challenge();
  });
  auto client = make_curl_http_client(server.base_url(), HttpCredentials{"admin", "wrong"});
  const auto outcome = exchange(*client, server, get("/devices"));
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(ErrorCode::authentication, outcome.error().code);
  EXPECT_EQ("GET /devices", outcome.error().operation);
  EXPECT_NE(std::string::npos, outcome.error().detail.find("admin"));
  EXPECT_EQ(std::string::npos, describe(outcome.error()).find("wrong")) << "no password in messages";
  EXPECT_EQ(2U, server.seen().size());
}

TEST_F(CurlHttpClient, PasswordIsNeverSentReadable) {
  TinyHttpServer server([&](const SeenRequest&) {
    return http_answer(401, "", "WWW-Authenticate: Basic realm=\"reader\"\r\n");
  });
  auto client = make_curl_http_client(server.base_url(), HttpCredentials{"admin", "secret"});
  const auto outcome = exchange(*client, server, get("/devices"));
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(ErrorCode::authentication, outcome.error().code);
  for (const SeenRequest& request : server.seen()) EXPECT_FALSE(request.headers.contains("authorization"));
}

TEST_F(CurlHttpClient, MissingCredentialsAreAnAuthenticationError) {
  const DigestGuard guard("MD5", "admin", "secret");
  TinyHttpServer server([&](const SeenRequest&) { return guard.challenge(); });
  auto client = make_curl_http_client(server.base_url());
  const auto outcome = exchange(*client, server, get("/devices"));
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(ErrorCode::authentication, outcome.error().code);
  EXPECT_FALSE(outcome.error().mend.empty());
}

TEST_F(CurlHttpClient, SilenceEndsAtTheDeadlineOfTheCallersTimeLine) {
  TinyHttpServer server([](const SeenRequest&) { return std::string(); });
  auto client = make_curl_http_client(server.base_url());
  const Instant start(1000s);
  ASSERT_TRUE(client->start(get("/devices"), start).has_value());
  ASSERT_TRUE(eventually([&] {
    server.serve();
    EXPECT_FALSE(client->poll(start + 5s - 1ns).value().has_value());
    return !server.seen().empty();
  }));
  const auto outcome = client->poll(start + 5s);
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(ErrorCode::timeout, outcome.error().code);
  EXPECT_NE(std::string::npos, outcome.error().detail.find("5 s"));
  EXPECT_EQ(ErrorCode::invalid_state, client->poll(start + 6s).error().code);
}

TEST_F(CurlHttpClient, LateAnswerToAnAbandonedRequestIsNotMistakenForTheNext) {
  int count = 0;
  TinyHttpServer server([&](const SeenRequest& request) {
    return ++count == 1 ? std::string() : http_answer(200, "answer to " + request.target);
  });
  auto client = make_curl_http_client(server.base_url());
  ASSERT_TRUE(client->start(get("/first"), clock_->now()).has_value());
  ASSERT_TRUE(eventually([&] {
    server.serve();
    return client->poll(clock_->now()).has_value() && count == 1;
  }));
  client->cancel();
  EXPECT_EQ("answer to /second", exchange(*client, server, get("/second")).value().body);
  EXPECT_EQ(2, server.connections());
}

TEST_F(CurlHttpClient, OneRequestAtATime) {
  TinyHttpServer server([](const SeenRequest&) { return http_answer(200, ""); });
  auto client = make_curl_http_client(server.base_url());
  EXPECT_EQ(ErrorCode::invalid_state, client->poll(clock_->now()).error().code);
  ASSERT_TRUE(client->start(get("/a"), clock_->now()).has_value());
  EXPECT_EQ(ErrorCode::busy, client->start(get("/b"), clock_->now()).error().code);
  client->cancel();
  EXPECT_TRUE(exchange(*client, server, get("/c")).has_value());
  EXPECT_EQ(ErrorCode::invalid_argument, client->start(get("relative"), clock_->now()).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument,
            client->start({HttpMethod::get, "/a", "", "", 0s}, clock_->now()).error().code);
}

TEST_F(CurlHttpClient, NobodyListeningIsRefused) {
  auto idle = std::make_unique<TinyHttpServer>([](const SeenRequest&) { return std::string(); });
  auto client = make_curl_http_client(idle->base_url());
  TinyHttpServer other([](const SeenRequest&) { return std::string(); });
  idle.reset();
  const auto outcome = exchange(*client, other, get("/devices"));
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(ErrorCode::refused, outcome.error().code);
  EXPECT_FALSE(outcome.error().mend.empty());
}

// A name with an empty label fails in the resolver itself; no name server is asked.
TEST_F(CurlHttpClient, NameThatDoesNotResolveIsNotPresent) {
  TinyHttpServer other([](const SeenRequest&) { return std::string(); });
  auto client = make_curl_http_client("http://no..such.host:3161");
  const auto outcome = exchange(*client, other, get("/devices"));
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(ErrorCode::not_present, outcome.error().code);
}

TEST_F(CurlHttpClient, HangingUpInTheMiddleIsDisconnected) {
  TinyHttpServer* running = nullptr;
  TinyHttpServer server([&](const SeenRequest&) {
    running->hang_up();
    return std::string();
  });
  running = &server;
  auto client = make_curl_http_client(server.base_url());
  EXPECT_EQ(ErrorCode::disconnected, exchange(*client, server, get("/devices")).error().code);
}

TEST_F(CurlHttpClient, WhatIsNotHttpIsAProtocolError) {
  TinyHttpServer server(
      [](const SeenRequest&) { return std::string("ADVANNET/1.1\r\nContent-Length:0\r\n\r\n"); });
  auto client = make_curl_http_client(server.base_url());
  EXPECT_EQ(ErrorCode::protocol, exchange(*client, server, get("/devices")).error().code);
}

TEST_F(CurlHttpClient, ConnectionClosedWhileIdleIsOpenedAgain) {
  TinyHttpServer server([](const SeenRequest&) { return http_answer(200, "ok"); });
  auto client = make_curl_http_client(server.base_url());
  ASSERT_TRUE(exchange(*client, server, get("/a")).has_value());
  server.hang_up();
  const auto outcome = exchange(*client, server, get("/b"));
  ASSERT_TRUE(outcome.has_value()) << describe(outcome.error());
  EXPECT_EQ(2, server.connections());
}

TEST_F(CurlHttpClient, GoesRoundTheProxyOfTheEnvironment) {
  ASSERT_EQ(0, ::setenv("http_proxy", "http://127.0.0.1:9", 1));
  TinyHttpServer server([](const SeenRequest&) { return http_answer(200, "direct"); });
  auto client = make_curl_http_client(server.base_url());
  const auto outcome = exchange(*client, server, get("/a"));
  ::unsetenv("http_proxy");
  ASSERT_TRUE(outcome.has_value()) << describe(outcome.error());
  EXPECT_EQ("direct", outcome->body);
}

}  // namespace
}  // namespace forager::hal
