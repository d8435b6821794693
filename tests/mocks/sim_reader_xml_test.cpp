#include "mocks/sim_reader_xml.hpp"

#include <gtest/gtest.h>

namespace forager::mocks {
namespace {

TEST(SimReaderXml, TakesElementsOneAfterAnother) {
  std::string_view rest = "<?xml?><a>1</a> <b/> <a><a>2</a></a>";
  EXPECT_EQ(next_element(rest)->inner, "1");
  EXPECT_EQ(next_element(rest)->name, "b");
  EXPECT_EQ(next_element(rest)->inner, "<a>2</a>");
  EXPECT_FALSE(next_element(rest).has_value());
}

TEST(SimReaderXml, ATagWithoutANameIsNoElement) {
  for (std::string_view text : {"<><>/</>", "<conf<></conf>", "< >/", "<>", "<"}) {
    std::string_view rest = text;
    while (const auto element = next_element(rest)) EXPECT_FALSE(element->name.empty()) << text;
  }
  EXPECT_EQ(find_element("<><a>1</a></>", "a"), "1");
}

TEST(SimReaderXml, AnElementThatIsNotClosedEndsTheText) {
  std::string_view rest = "<a><b>1</b>";
  EXPECT_FALSE(next_element(rest).has_value());
  EXPECT_TRUE(rest.empty());
}

}  // namespace
}  // namespace forager::mocks
