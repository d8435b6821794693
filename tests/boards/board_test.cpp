#include "boards/board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::boards {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class BoardFile : public testing::Test {
 protected:
  hal::Result<Board> board_of(const std::string& text) {
    return load_board(folder_.write("robot.toml", text));
  }
  std::string complaint(const std::string& text) {
    const auto board = board_of(text);
    return board ? "accepted" : describe(board.error());
  }
  test::ScratchFolder folder_;
};

constexpr const char* kNamed = "[board]\nname = \"drone-2\"\n";

TEST_F(BoardFile, SimNeedsNoFileAndNoAddresses) {
  const auto board = load_board("sim");
  ASSERT_TRUE(board);
  EXPECT_EQ(board->kind, BoardKind::sim);
}

TEST_F(BoardFile, EveryKeyArrives) {
  const auto board = board_of(std::string(kNamed) +
                              "kind = \"socket\"\n"
                              "[reader]\nhost = \"192.168.1.50\"\nrest_port = 80\nstream_port = 3178\n"
                              "device_id = \"AdvanReader-m4-160\"\nuser = \"admin\"\n"
                              "password_env = \"READER_PASSWORD\"\n"
                              "[autopilot]\naddress = \"10.0.0.2:14551\"\n"
                              "[world]\ntruth = \"10.0.0.3:14600\"\n");
  ASSERT_TRUE(board) << describe(board.error());
  EXPECT_EQ(board->name, "drone-2");
  EXPECT_EQ(board->kind, BoardKind::socket);
  EXPECT_EQ(board->reader_host, "192.168.1.50");
  EXPECT_EQ(board->reader_rest_port, 80);
  EXPECT_EQ(board->reader_stream_port, 3178);
  EXPECT_EQ(board->reader_device_id, "AdvanReader-m4-160");
  EXPECT_EQ(board->reader_user, "admin");
  EXPECT_EQ(board->reader_password_env, "READER_PASSWORD");
  EXPECT_EQ(to_string(board->autopilot), "10.0.0.2:14551");
  EXPECT_EQ(to_string(board->truth), "10.0.0.3:14600");
}

TEST_F(BoardFile, TheShortestOneIsThePortsEverythingUsesByItself) {
  const auto board = board_of(kNamed);
  ASSERT_TRUE(board) << describe(board.error());
  EXPECT_EQ(board->kind, BoardKind::socket);
  EXPECT_EQ(board->reader_rest_port, 3161);
  EXPECT_EQ(board->reader_stream_port, 3177);
  EXPECT_EQ(board->autopilot.port, 14550);
  EXPECT_TRUE(board->reader_user.empty());
}

TEST_F(BoardFile, TheOneInTheProjectLoads) {
  const auto board = load_board(test::source_path("boards/emulated.toml"));
  ASSERT_TRUE(board) << describe(board.error());
  EXPECT_EQ(board->name, "emulated");
}

TEST_F(BoardFile, MistakesAreOneLineWithPlaceAndMend) {
  const std::string named = kNamed;
  EXPECT_THAT(complaint("[board]\nkind = \"socket\"\n"),
              HasSubstr("[board] name: is missing. Give a short name"));
  EXPECT_THAT(complaint(named + "kind = \"serial\"\n"),
              EndsWith("kind: is \"serial\". Allowed: sim, socket."));
  EXPECT_THAT(complaint(named + "[reader]\nhots = \"x\"\n"),
              EndsWith("robot.toml:4: reader.hots: is not a known key here. Did you mean 'host'?"));
  EXPECT_THAT(complaint(named + "[reader]\nrest_port = 0\n"),
              EndsWith("[reader] rest_port: is 0. Allowed: 1 to 65535."));
  EXPECT_THAT(complaint(named + "[reader]\nrest_port = 65536\n"), HasSubstr("rest_port: is 65536."));
  EXPECT_THAT(complaint(named + "[reader]\nhost = 7\n"), HasSubstr("host"));
  EXPECT_THAT(complaint(named + "[reader]\nuser = \"admin\"\n"),
              HasSubstr("user: and password_env go together"));
  EXPECT_THAT(complaint(named + "[reader]\npassword_env = \"X\"\n"), HasSubstr("Give both, or neither"));
  EXPECT_THAT(complaint(named + "[motor]\n"), HasSubstr("robot.toml:3: motor: is not a known key here."));
  EXPECT_THAT(complaint("[board\n"), HasSubstr("line 1, column"));
  for (const char* text : {"14550", ":14550", "host:", "host:0", "host:65536", "host:14550x", "host:-1", ""})
    EXPECT_THAT(complaint(named + "[autopilot]\naddress = \"" + text + "\"\n"),
                HasSubstr("is not HOST:PORT. Write for example 192.168.1.50:14550."))
        << text;
}

TEST_F(BoardFile, ASecretDoesNotBelongInTheFile) {
  EXPECT_THAT(complaint(std::string(kNamed) + "[reader]\npassword = \"admin\"\n"),
              HasSubstr("reader.password: is not a known key here."));
}

TEST_F(BoardFile, AMissingFileIsSaidToBeMissing) {
  const auto board = load_board("no/such/board.toml");
  ASSERT_FALSE(board);
  EXPECT_EQ(board.error().code, hal::ErrorCode::not_present);
}

TEST(Endpoint, IsSplitAtTheLastColon) {
  const auto endpoint = endpoint_from("robot.local:14550");
  ASSERT_TRUE(endpoint);
  EXPECT_EQ(endpoint->host, "robot.local");
  EXPECT_EQ(endpoint->port, 14550);
}

}  // namespace
}  // namespace forager::boards
