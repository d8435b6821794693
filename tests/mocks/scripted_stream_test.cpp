#include "mocks/scripted_stream.hpp"

#include <gmock/gmock.h>

#include <memory>

#include "mocks/scripted_http_client.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Script : testing::Test {
  ScriptFailure collect() {
    return [this](const std::string& why) { complaints.push_back(why); };
  }
  static std::size_t say(hal::ByteStream& stream, std::string_view text) {
    return stream.write(std::as_bytes(std::span(text))).value();
  }
  static std::string hear(hal::ByteStream& stream) {
    std::string text(64, '\0');
    text.resize(stream.read(std::as_writable_bytes(std::span(text))).value());
    return text;
  }
  static void open(hal::ByteStream& stream) {
    ASSERT_TRUE(stream.open().has_value());
    ASSERT_EQ(stream.poll().value(), hal::StreamState::open);
  }
  std::vector<std::string> complaints;
};

TEST_F(Script, FollowedToTheEndSaysNothing) {
  {
    ScriptedStream stream("line", collect());
    stream.expect("HELLO").answer("WORLD").expect("BYE").fail(
        {hal::ErrorCode::disconnected, "line", "read", "gone", "", 0});
    open(stream);
    EXPECT_EQ(hear(stream), "") << "no answer before the question";
    EXPECT_EQ(say(stream, "HEL"), 3U);
    EXPECT_EQ(say(stream, "LO"), 2U);
    EXPECT_EQ(hear(stream), "WORLD");
    EXPECT_EQ(say(stream, "BYE"), 3U);
    std::byte byte{};
    EXPECT_EQ(stream.read({&byte, 1}).error().code, hal::ErrorCode::disconnected);
    EXPECT_TRUE(stream.done());
  }
  EXPECT_THAT(complaints, IsEmpty());
}

TEST_F(Script, WrongExtraAndMissingBytesAreReported) {
  {
    ScriptedStream stream("line", collect());
    stream.expect("ab").answer("c");
    open(stream);
    say(stream, "ax");
    EXPECT_THAT(complaints, ElementsAre(HasSubstr("wrote 6178 where the script wants 6162")));
    say(stream, "ab");
    say(stream, "!");
    EXPECT_THAT(complaints.back(), HasSubstr("unexpected write of 21"));
  }
  EXPECT_THAT(complaints.back(), HasSubstr("1 steps of the script were never reached"));
}

TEST_F(Script, ReconnectsMustBeInTheScript) {
  ScriptedStream stream("line", collect());
  stream.expect_open();
  open(stream);
  stream.close();
  open(stream);
  EXPECT_THAT(complaints, ElementsAre(HasSubstr("opened again")));
}

struct HttpScript : Script {
  static hal::HttpRequest request(hal::HttpMethod method, std::string path, std::string body = {}) {
    return {method, std::move(path), std::move(body), {}, 1s};
  }
  hal::Instant now;
};

TEST_F(HttpScript, AnswersInOrderAfterTheLatency) {
  {
    ScriptedHttpClient client("http", collect());
    client.latency(100ms).expect(hal::HttpMethod::get, "/devices").answer(200, "<devices/>");
    client.expect(hal::HttpMethod::put, "/power", "30")
        .fail({hal::ErrorCode::refused, "http", "", "", "", 0});
    ASSERT_TRUE(client.start(request(hal::HttpMethod::get, "/devices"), now).has_value());
    EXPECT_EQ(client.start(request(hal::HttpMethod::get, "/devices"), now).error().code,
              hal::ErrorCode::busy);
    EXPECT_FALSE(client.poll(now + 99ms).value().has_value());
    EXPECT_EQ(client.poll(now + 100ms).value()->body, "<devices/>");
    EXPECT_EQ(client.poll(now + 100ms).error().code, hal::ErrorCode::invalid_state);
    ASSERT_TRUE(client.start(request(hal::HttpMethod::put, "/power", "30"), now).has_value());
    EXPECT_EQ(client.poll(now + 100ms).error().code, hal::ErrorCode::refused);
  }
  EXPECT_THAT(complaints, IsEmpty());
}

TEST_F(HttpScript, WrongRequestsAndForgottenOnesAreReported) {
  {
    ScriptedHttpClient client("http", collect());
    client.expect(hal::HttpMethod::put, "/power", "30").expect(hal::HttpMethod::get, "/start");
    ASSERT_TRUE(client.start(request(hal::HttpMethod::put, "/power", "31"), now).has_value());
    EXPECT_THAT(complaints, ElementsAre(HasSubstr("came with body '31', the script wants '30'")));
  }
  EXPECT_THAT(complaints.back(), HasSubstr("1 requests never came, the next was GET /start"));
}

TEST_F(HttpScript, ALateAnswerIsATimeout) {
  ScriptedHttpClient client("http", collect());
  client.latency(5s).expect(hal::HttpMethod::get, "/devices").answer(200, "late");
  ASSERT_TRUE(client.start(request(hal::HttpMethod::get, "/devices"), now).has_value());
  EXPECT_EQ(client.poll(now + 5s).error().code, hal::ErrorCode::timeout);
}

}  // namespace
}  // namespace forager::mocks
