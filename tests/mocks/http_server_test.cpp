// The HTTP server of the emulated reader, byte for byte.
#include "mocks/http_server.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <map>

#include "mocks/md5.hpp"
#include "tests/mocks/sim_reader_bench.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

// Says back what it was asked.
class Echo final : public HttpHandler {
 public:
  std::uint32_t submit(hal::HttpMethod method, std::string_view path, std::string_view body,
                       hal::Instant) override {
    replies_[++last_] = {
        200, fmt::format("{} {} [{}]", method == hal::HttpMethod::get ? "GET" : "PUT", path, body)};
    return last_;
  }
  std::optional<HttpReply> take(std::uint32_t request, hal::Instant) override {
    const auto found = replies_.find(request);
    if (found == replies_.end() || slow) return std::nullopt;
    HttpReply reply = found->second;
    replies_.erase(found);
    return reply;
  }
  void forget(std::uint32_t request) override { replies_.erase(request); }
  bool knows(std::uint32_t request) const override { return replies_.contains(request); }
  HttpReach reach(hal::Instant) override { return HttpReach::listening; }
  std::uint32_t requests() const { return last_; }
  bool slow = false;

 private:
  std::map<std::uint32_t, HttpReply> replies_;
  std::uint32_t last_ = 0;
};

struct Session : testing::Test {
  std::string say(std::string_view text) {
    session.take_in(std::as_bytes(std::span(text)), hal::Instant{});
    return output();
  }
  std::string output() {
    std::string out(session.output());
    session.sent(out.size());
    return out;
  }
  Echo echo;
  HttpServerLimits limits{.header_bytes = 500, .body_bytes = 1000};
  HttpServerSession session{echo, nullptr, limits};
};

TEST_F(Session, AGetAndItsAnswer) {
  EXPECT_EQ(
      say("GET /devices/a/readModes%5B0%5D HTTP/1.1\r\nHost: reader\r\nAccept: */*\r\n\r\n"),
      "HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nContent-Length: 34\r\nConnection: keep-alive\r\n\r\n"
      "GET /devices/a/readModes%5B0%5D []");
}

TEST_F(Session, APutByteByByte) {
  std::string answer;
  for (const char c : std::string_view("PUT /x HTTP/1.1\r\ncontent-length:  5 \r\n\r\nS1\r\n!")) {
    EXPECT_EQ(answer, "");
    answer += say({&c, 1});
  }
  EXPECT_THAT(answer, EndsWith("PUT /x [S1\r\n!]"));
}

TEST_F(Session, OldClientsGetTheirAnswerAndAClose) {
  EXPECT_THAT(say("PUT /x HTTP/1.0\r\nContent-Length: 10\r\n\r\nAutonomous"),
              HasSubstr("Connection: close\r\n\r\nPUT /x [Autonomous]"));
  EXPECT_TRUE(session.finished());
  EXPECT_EQ(session.room(), 0U);
}

TEST_F(Session, PipelinedRequestsAreAnsweredInOrderOneByOne) {
  echo.slow = true;
  EXPECT_EQ(say("GET /1 HTTP/1.1\r\n\r\nGET /2 HTTP/1.1\r\nConnection: close\r\n\r\nGET /3 HTTP/1.1\r\n\r\n"),
            "");
  EXPECT_EQ(echo.requests(), 1U);
  echo.slow = false;
  session.update(hal::Instant{});
  const std::string out = output();
  EXPECT_LT(out.find("GET /1"), out.find("GET /2"));
  EXPECT_EQ(echo.requests(), 2U) << "nothing after a close";
}

TEST_F(Session, ExpectContinueIsAnsweredOnce) {
  EXPECT_EQ(say("PUT /x HTTP/1.1\r\nExpect: 100-continue\r\nContent-Length: 2\r\n\r\n"),
            "HTTP/1.1 100 Continue\r\n\r\n");
  EXPECT_EQ(say("S"), "");
  EXPECT_THAT(say("1"), EndsWith("PUT /x [S1]"));
}

TEST_F(Session, OtherMethodsAreNotAllowed) {
  EXPECT_THAT(say("DELETE /x HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 405 Method Not Allowed\r\n"));
  EXPECT_THAT(say("POST /x HTTP/1.1\r\nContent-Length: 1\r\n\r\nx"), HasSubstr("Allow: GET, PUT\r\n"));
  EXPECT_EQ(echo.requests(), 0U);
  EXPECT_FALSE(session.finished());
}

TEST(HttpServerRequest, GarbageIsRejectedWithItsReason) {
  const HttpServerLimits limits{.header_bytes = 200, .body_bytes = 100};
  const auto status_of = [&](std::string bytes) {
    const HttpParse parsed = take_http_request(bytes, limits);
    const auto* rejected = std::get_if<HttpRejected>(&parsed);
    return rejected == nullptr ? 0 : rejected->status;
  };
  for (const char* bad :
       {"\x16\x03\x01 tls\n\n", "GET\n\n", "GET /\n\n", "GET  HTTP/1.1\n\n", "GET x HTTP/1.1\n\n",
        "GET /a b HTTP/1.1\n\n", "G(T / HTTP/1.1\n\n", "GET /%5 HTTP/1.1\n\n", "GET /%zz HTTP/1.1\n\n",
        "GET /\x80 HTTP/1.1\n\n", "GET / HTTPS/1.1\n\n", "GET / HTTP/1.1\nno colon\n\n",
        "GET / HTTP/1.1\nspace : x\n\n", "GET / HTTP/1.1\n folded: x\n\n",
        "PUT / HTTP/1.1\nContent-Length: -1\n\n", "PUT / HTTP/1.1\nContent-Length: 1x\n\n",
        "PUT / HTTP/1.1\nContent-Length: 1\nContent-Length: 2\n\n"})
    EXPECT_EQ(status_of(bad), 400) << bad;
  EXPECT_EQ(status_of("GET / HTTP/2.0\n\n"), 505);
  EXPECT_EQ(status_of("PUT / HTTP/1.1\nTransfer-Encoding: chunked\n\n"), 501);
  EXPECT_EQ(status_of("PUT / HTTP/1.1\nContent-Length: 101\n\n"), 413);
  EXPECT_EQ(status_of("PUT / HTTP/1.1\nContent-Length: 99999999999999999999999\n\n"), 413);
  EXPECT_EQ(status_of("GET /" + std::string(300, 'a')), 431);
  EXPECT_EQ(status_of("GET / HTTP/1.1\nX: " + std::string(300, 'a') + "\n\n"), 431);
  EXPECT_EQ(status_of("GET / HTTP/1.1\nX: y"), 0) << "only not finished yet";
}

TEST_F(Session, AfterGarbageTheConnectionEnds) {
  EXPECT_THAT(say("hello\r\n\r\nGET / HTTP/1.1\r\n\r\n"),
              testing::AllOf(StartsWith("HTTP/1.1 400 Bad Request\r\n"), HasSubstr("Connection: close\r\n")));
  EXPECT_TRUE(session.finished());
  EXPECT_EQ(echo.requests(), 0U);
}

RC_GTEST_PROP(HttpServerRequestProperty, CuttingTheBytesAnywhereChangesNothing, ()) {
  const std::string bytes = "PUT /a%20b HTTP/1.1\r\nContent-Length: 8\r\n\r\n<a>1</a>GET / HTTP/1.0\r\n\r\n";
  const auto cut = *rc::gen::inRange<std::size_t>(0, bytes.size());
  const auto answers = [](std::initializer_list<std::string_view> pieces) {
    Echo echo;
    const HttpServerLimits limits;
    HttpServerSession session(echo, nullptr, limits);
    for (const std::string_view piece : pieces)
      session.take_in(std::as_bytes(std::span(piece)), hal::Instant{});
    return std::string(session.output());
  };
  RC_ASSERT(answers({bytes}) ==
            answers({std::string_view(bytes).substr(0, cut), std::string_view(bytes).substr(cut)}));
}

// --- digest --------------------------------------------------------------------------------------------

std::string field_of(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(fmt::format("{}=\"", key));
  if (at == std::string_view::npos) return {};
  const std::size_t start = at + key.size() + 2;
  return std::string(header.substr(start, header.find('"', start) - start));
}

std::string credentials(std::string_view challenge, std::string_view method, std::string_view uri, int count,
                        std::string_view user = "admin", std::string_view password = "admin") {
  const std::string nonce = field_of(challenge, "nonce");
  const std::string realm = field_of(challenge, "realm");
  const std::string ha1 = md5_hex(fmt::format("{}:{}:{}", user, realm, password));
  const std::string ha2 = md5_hex(fmt::format("{}:{}", method, uri));
  const std::string response = md5_hex(fmt::format("{}:{}:{:08x}:0a4f113b:auth:{}", ha1, nonce, count, ha2));
  return fmt::format(
      R"(Digest username="{}", realm="{}", nonce="{}", uri="{}", cnonce="0a4f113b", nc={:08x}, )"
      R"(qop=auth, response="{}", algorithm=MD5)",
      user, realm, nonce, uri, count, response);
}

TEST(HttpServerDigest, LetsInWhoKnowsThePassword) {
  using Verdict = HttpServerDigest::Verdict;
  HttpServerDigest digest("AdvanNet", "admin", "admin", 1);
  const std::string challenge = digest.challenge(false);
  EXPECT_THAT(challenge, StartsWith(R"(Digest realm="AdvanNet", qop="auth", nonce=")"));
  EXPECT_EQ(digest.check(credentials(challenge, "GET", "/devices", 1), "GET", "/devices"), Verdict::accepted);
  EXPECT_EQ(digest.check(credentials(challenge, "GET", "/devices", 1), "GET", "/devices"), Verdict::stale)
      << "a replay";
  EXPECT_EQ(digest.check(credentials(challenge, "PUT", "/x", 2), "PUT", "/x"), Verdict::accepted);
  EXPECT_EQ(digest.check(credentials(challenge, "GET", "/x", 3), "PUT", "/x"), Verdict::refused);
  EXPECT_EQ(digest.check(credentials(challenge, "GET", "/y", 3), "GET", "/x"), Verdict::refused);
  EXPECT_EQ(digest.check(credentials(challenge, "GET", "/x", 3, "admin", "wrong"), "GET", "/x"),
            Verdict::refused);
  EXPECT_EQ(digest.check(credentials(challenge, "GET", "/x", 3, "root"), "GET", "/x"), Verdict::refused);
  EXPECT_EQ(digest.check("", "GET", "/x"), Verdict::refused);
  EXPECT_EQ(digest.check("Basic YWRtaW46YWRtaW4=", "GET", "/x"), Verdict::refused);
  EXPECT_EQ(digest.check("Digest username=\"admin", "GET", "/x"), Verdict::refused);
  for (int k = 0; k < 64; ++k) (void)digest.challenge(false);
  EXPECT_EQ(digest.check(credentials(challenge, "GET", "/x", 4), "GET", "/x"), Verdict::stale) << "forgotten";
}

// The worked example of RFC 7616 section 3.9.1 (MD5), checked against our client-side arithmetic.
TEST(HttpServerDigest, AgreesWithTheExampleOfTheRfc) {
  const std::string ha1 = md5_hex("Mufasa:http-auth@example.org:Circle of Life");
  const std::string ha2 = md5_hex("GET:/dir/index.html");
  EXPECT_EQ(md5_hex(ha1 +
                    ":7ypf/xlj9XXwfDPEoM4URrv/xwf94BcCAzFZH4GiTo0v:00000001:"
                    "f2/wE4q74E6zIJEtWaHKaf5wv/H5QzzpXusqGemxURZJ:auth:" +
                    ha2),
            "8ca523f5e9506fed4657c9700eebdbec");
}

// --- the whole way to an emulated reader ---------------------------------------------------------------

struct Served : testing::Test {
  void SetUp() override {
    server.attach(line);
    ASSERT_TRUE(line.near().open().has_value());
    ASSERT_TRUE(line.near().poll().has_value());
  }
  static HttpServerConfig with_digest() {
    HttpServerConfig config;
    config.digest = true;
    return config;
  }
  std::string exchange(std::string_view text) {
    if (!text.empty()) {
      EXPECT_TRUE(line.near().write(std::as_bytes(std::span(text))).has_value());
    }
    bench.reader.update(bench.now);
    server.update(bench.now);
    std::string heard(65536, '\0');
    const auto count = line.near().read(std::as_writable_bytes(std::span(heard)));
    heard.resize(count.value_or(0));
    return heard;
  }
  SimReaderBench bench;
  HttpServer server{with_digest(), bench.reader};
  MemoryStreamPair line{"tcp sim-reader:3161", MemoryStreamKind::bytes};
};

TEST_F(Served, AReaderStartsOnlyForItsOwner) {
  const std::string uri = "/devices/AdvanReader-m4-160/start";
  const std::string challenge = exchange("GET " + uri + " HTTP/1.1\r\nHost: r\r\n\r\n");
  EXPECT_THAT(challenge, StartsWith("HTTP/1.1 401 Unauthorized\r\n"));
  EXPECT_THAT(challenge, HasSubstr("WWW-Authenticate: Digest "));
  EXPECT_FALSE(bench.field.on());
  const std::string answer = exchange(fmt::format("GET {} HTTP/1.1\r\nAuthorization: {}\r\n\r\n", uri,
                                                  credentials(challenge, "GET", uri, 1)));
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK\r\nContent-Type: text/xml; charset=UTF-8\r\n"));
  EXPECT_THAT(answer, HasSubstr("<op>start</op>"));
  EXPECT_TRUE(bench.field.on());
  EXPECT_THAT(exchange(fmt::format("GET {} HTTP/1.1\r\nAuthorization: {}\r\n\r\n", uri,
                                   credentials(challenge, "GET", uri, 1))),
              HasSubstr(", stale=true\r\n"));
}

TEST_F(Served, IdleConnectionsAreClosedAndARebootClosesToo) {
  exchange("GET / HTTP/1.1\r\n\r\n");
  EXPECT_EQ(server.connections(), 1U);
  bench.now += 61s;
  server.update(bench.now);
  EXPECT_EQ(server.connections(), 0U);
  EXPECT_EQ(exchange(""), "");
  EXPECT_EQ(line.near().state(), hal::StreamState::closed);
  bench.reader.reboot(bench.now);
  server.update(bench.now);
  ASSERT_TRUE(line.near().open().has_value());
  EXPECT_EQ(line.near().poll().error().code, hal::ErrorCode::refused);
}

TEST_F(Served, WithoutPowerTheLineIsSilent) {
  exchange("GET / HTTP/1.1\r\n\r\n");
  bench.reader.power_cut(bench.now);
  EXPECT_EQ(exchange("GET /status HTTP/1.1\r\n\r\n"), "");
  EXPECT_EQ(line.near().state(), hal::StreamState::open);
  bench.reader.power_on(bench.now);
  bench.now += 30s;
  EXPECT_EQ(exchange(""), "");
  EXPECT_EQ(line.near().state(), hal::StreamState::closed)
      << "the new boot knows nothing of the old connection";
}

}  // namespace
}  // namespace forager::mocks
