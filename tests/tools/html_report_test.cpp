#include "tools/html_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "hal/random.hpp"
#include "hal/units.hpp"
#include "tools/report_markup.hpp"
#include "tools/report_style.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using flight::DecisionKind;

// A run up and down an aisle with a decision every two seconds and a path sample every tenth.
ReportData sample_run(int seconds = 120) {
  hal::Random random(3);
  ReportData data;
  data.scene = "1C";
  data.title = "330 tags, straight aisle";
  data.policy = "stigmergy";
  data.seed = 42;
  data.end_reason = "no_new_tags";
  data.started = hal::Instant(1000s);
  data.ended = data.started + 1s * seconds;
  data.boxes = {{{0, 1.75, 0}, {12, 2.75, 2.5}}, {{0, -2.75, 0}, {12, -1.75, 2.5}}};
  for (int i = 0; i < 330; ++i)
    data.tags.push_back({{random.uniform(0, 12), random.chance(0.5) ? 2.2 : -2.2, 1.7}, i % 10 != 0});
  data.ports = {{4, "front", 0, 0}, {3, "left", 0, 0}};
  std::uint32_t count = 0;
  for (int tenth = 0; tenth <= 10 * seconds; ++tenth) {
    const hal::Instant at = data.started + 100ms * tenth;
    const double x = 6.0 - 5.5 * std::cos(tenth * 0.01);
    data.path.push_back({at, x, 0.1 * std::sin(tenth * 0.05), 0.0});
    if (tenth % 20 != 0) continue;
    const auto kind = kDecisionKinds[random.below(6)];
    data.decisions.push_back({at, kind, {{x, 0.0, 1.8}, 0, 0, 0}, random.uniform(-3, 3), 1.0, 2});
    count += 2;
    data.tags_over_time.push_back({at, count, {count / 2, count / 2}});
  }
  data.ports[0].new_tags = data.ports[1].new_tags = count / 2;
  data.facts = {{"Window", "2.0 s"}};
  data.events = {{data.started + 12s, "reader lost"}};
  return data;
}

pugi::xml_document parse(const std::string& page) {
  pugi::xml_document document;
  const auto result = document.load_string(page.c_str(), pugi::parse_default | pugi::parse_doctype);
  EXPECT_TRUE(result) << result.description()
                      << " near: " << page.substr(static_cast<std::size_t>(result.offset), 80);
  return document;
}

std::size_t count_of(const pugi::xml_document& document, const char* xpath) {
  return document.select_nodes(xpath).size();
}

TEST(HtmlReport, IsWellFormedAndLoadsNothing) {
  const std::string page = render_html_report(sample_run());
  const auto document = parse(page);
  EXPECT_EQ(count_of(document, "/html/body/main"), 1U);
  EXPECT_EQ(count_of(document, "//script | //link | //img | //iframe | //@src | //@href | //@onload"), 0U);
  // The namespace of XHTML is a name, not a place to load from.
  std::string rest = page;
  const std::string name = "http://www.w3.org/1999/xhtml";
  rest.erase(rest.find(name), name.size());
  for (const char* loads : {"http:", "https:", "url(", "@import"})
    EXPECT_EQ(rest.find(loads), std::string::npos) << loads;
  EXPECT_EQ(report_style().find_first_of("<&"), std::string_view::npos);
}

TEST(HtmlReport, ShowsEveryTagBoxAndDecisionOnce) {
  const ReportData data = sample_run();
  const auto document = parse(render_html_report(data));
  const std::string map = "//svg[@class='map']";
  EXPECT_EQ(count_of(document, (map + "//rect[@class='box']").c_str()), 2U);
  EXPECT_EQ(count_of(document, (map + "/g[@class='read']/circle").c_str()), 297U);
  EXPECT_EQ(count_of(document, (map + "/g[@class='unread']/circle").c_str()), 33U);
  EXPECT_EQ(count_of(document, (map + "/g[@class='decisions']/g").c_str()), data.decisions.size());
  EXPECT_EQ(count_of(document, "//path[contains(@class,'tick ')]"), data.decisions.size());
  EXPECT_EQ(count_of(document, "//rect[contains(@class,'bar')]"), 2U);
  EXPECT_EQ(count_of(document, "//polyline[contains(@class,'curve')]"), 3U) << "two ports and their sum";
  EXPECT_EQ(count_of(document, "//ol[@class='events']/li"), 1U);
  EXPECT_EQ(document.select_node("//table[@class='closing']//tr[3]/td").node().text().get(),
            std::string("90.0 %"));
}

TEST(HtmlReport, LetteredMarksNeverOverlapAndStayOnTheMap) {
  const auto document = parse(render_html_report(sample_run(600)));
  double width = 0.0;
  double height = 0.0;
  double zero = 0.0;
  std::istringstream(document.select_node("//svg[@class='map']/@viewBox").attribute().value()) >> zero >>
      zero >> width >> height;
  std::vector<std::pair<double, double>> letters;
  for (const auto& node :
       document.select_nodes("//svg[@class='map']//g[starts-with(@class,'decision ')][text]")) {
    const auto circle = node.node().select_node("circle[last()]").node();
    letters.emplace_back(circle.attribute("cx").as_double(), circle.attribute("cy").as_double());
  }
  ASSERT_GT(letters.size(), 20U);
  for (std::size_t i = 0; i < letters.size(); ++i) {
    EXPECT_GT(letters[i].first, 0.0);
    EXPECT_LT(letters[i].first, width);
    EXPECT_LT(letters[i].second, height);
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GE(std::hypot(letters[i].first - letters[j].first, letters[i].second - letters[j].second), 15.0);
  }
}

TEST(HtmlReport, TheMapHasEqualScalesAndTurnsTheWorldTheRightWayUp) {
  ReportData data;
  data.boxes = {{{1, 1, 0}, {4, 3, 2}}};
  data.tags = {{{0, 5, 1}, true}, {{0, 0, 1}, true}, {{5, 0, 1}, true}};
  const auto document = parse(render_html_report(data));
  const auto box = document.select_node("//rect[@class='box']").node();
  EXPECT_NEAR(box.attribute("width").as_double() / box.attribute("height").as_double(), 1.5, 0.01);
  const auto tags = document.select_nodes("//svg[@class='map']/g[@class='read']/circle");
  const auto at = [&](std::size_t i, const char* axis) { return tags[i].node().attribute(axis).as_double(); };
  EXPECT_LT(at(0, "cy"), at(1, "cy")) << "left of the start is up";
  EXPECT_GT(at(2, "cx"), at(1, "cx")) << "ahead is to the right";
  EXPECT_NEAR(at(1, "cy") - at(0, "cy"), at(2, "cx") - at(1, "cx"), 0.15);
}

TEST(HtmlReport, TextFromOutsideCannotBecomeMarkup) {
  const std::string nasty = "</title><script>alert('x')</script>\"&amp;\x01\xff\xed\xa0\x80";
  ReportData data = sample_run();
  data.scene = data.title = data.policy = data.end_reason = nasty;
  data.ports[0].name = nasty;
  data.facts = {{nasty, nasty}};
  data.events = {{data.started, nasty}};
  const auto document = parse(render_html_report(data));
  EXPECT_EQ(count_of(document, "//script"), 0U);
  const std::string shown = document.select_node("//ol[@class='events']/li/p").node().text().get();
  EXPECT_EQ(shown.substr(0, 41), nasty.substr(0, 41));
  EXPECT_EQ(shown.find('\xff'), std::string::npos);
}

TEST(HtmlReport, AnEmptyRunIsStillAPage) {
  const auto document = parse(render_html_report(ReportData{}));
  EXPECT_EQ(count_of(document, "//svg[@class='map' or @class='plot']"), 0U);
  EXPECT_EQ(count_of(document, "//table[@class='closing']"), 1U);
}

TEST(HtmlReport, ValuesThatAreNotFiniteAreLeftOut) {
  ReportData data = sample_run();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  data.path[5].x = nan;
  data.tags[0].position.y = std::numeric_limits<double>::infinity();
  data.decisions[0].from.position.x = nan;
  data.decisions[1].heading_rad = nan;
  const std::string page = render_html_report(data);
  const auto document = parse(page);
  EXPECT_EQ(count_of(document, "//svg[@class='map']//circle[@cx='nan' or @cx='inf' or @cy='inf']"), 0U);
  EXPECT_EQ(page.find("nan,"), std::string::npos);
  EXPECT_EQ(count_of(document, "//svg[@class='map']/g[@class='decisions']/g"), data.decisions.size() - 1);
}

TEST(HtmlReport, EqualDataGiveEqualBytesAndLongRunsStaySmall) {
  const ReportData data = sample_run(3600);
  const std::string page = render_html_report(data);
  EXPECT_EQ(page, render_html_report(data));
  EXPECT_LT(page.size(), 700'000U) << "36000 path samples and 1800 decisions";
}

TEST(HtmlReport, ManyEventsAreCutWithANote) {
  ReportData data = sample_run();
  data.events.assign(2000, {data.started, "again"});
  const auto document = parse(render_html_report(data));
  EXPECT_EQ(count_of(document, "//ol[@class='events']/li"), 501U);
  EXPECT_NE(std::string(document.select_node("//ol[@class='events']/li[last()]/p").node().text().get())
                .find("1500"),
            std::string::npos);
}

TEST(ReportMarkup, AxisTicksAreRoundAndInside) {
  EXPECT_EQ(axis_ticks(0, 300, 6), (std::vector<double>{0, 50, 100, 150, 200, 250, 300}));
  EXPECT_EQ(axis_ticks(0, 1, 5).size(), 6U);
  EXPECT_EQ(tick_label(0.2, axis_ticks(0, 1, 5)), "0.2");
  EXPECT_EQ(tick_label(50, axis_ticks(0, 300, 6)), "50");
  EXPECT_TRUE(axis_ticks(1, 1, 5).empty());
  hal::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double low = random.uniform(-50, 50);
    const double high = low + std::pow(10.0, random.uniform(-2, 4));
    const auto ticks = axis_ticks(low, high, 8);
    ASSERT_GE(ticks.size(), 1U);
    ASSERT_LE(ticks.size(), 9U);
    for (const double tick : ticks) {
      ASSERT_GE(tick, low - 1e-6);
      ASSERT_LE(tick, high + 1e-6);
    }
  }
}

// WCAG 2 relative luminance and contrast of the colours that carry text or marks, in both themes.
double luminance(const std::string& hex) {
  const std::string full =
      hex.size() == 3 ? std::string{hex[0], hex[0], hex[1], hex[1], hex[2], hex[2]} : hex;
  double sum = 0.0;
  constexpr double kShare[] = {0.2126, 0.7152, 0.0722};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = std::stoi(full.substr(2 * i, 2), nullptr, 16) / 255.0;
    sum += kShare[i] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return sum;
}

double contrast(const std::string& a, const std::string& b) {
  const double brighter = std::max(luminance(a), luminance(b));
  const double darker = std::min(luminance(a), luminance(b));
  return (brighter + 0.05) / (darker + 0.05);
}

std::map<std::string, std::string> colours(std::string_view css, std::size_t from) {
  std::map<std::string, std::string> found;
  const std::size_t end = css.find('}', from);
  for (std::size_t at = css.find("--", from); at < end; at = css.find("--", at + 2)) {
    const std::size_t colon = css.find(":#", at);
    const std::size_t stop = css.find_first_of(";}", colon);
    found[std::string(css.substr(at + 2, colon - at - 2))] = css.substr(colon + 2, stop - colon - 2);
  }
  return found;
}

TEST(ReportStyle, ContrastIsEnoughInLightAndDark) {
  const std::string_view css = report_style();
  for (const std::size_t from : {css.find(":root"), css.find(":root", css.find("dark){"))}) {
    const auto colour = colours(css, from);
    ASSERT_GE(colour.size(), 20U);
    for (const char* text : {"ink", "soft", "unread", "p0", "p1", "p2", "p3", "p4", "p5", "p6", "p7"})
      EXPECT_GE(contrast(colour.at(text), colour.at("card")), 4.5) << text;
    for (const char* mark : {"f", "tl", "tr", "tb", "s", "l"})
      EXPECT_GE(contrast(colour.at(mark), colour.at("mark-text")), 4.5) << mark;
    EXPECT_GE(contrast(colour.at("soft"), colour.at("page")), 4.5);
    for (const char* line : {"path", "read"})
      EXPECT_GE(contrast(colour.at(line), colour.at(std::string(line) == "read" ? "box" : "card")), 3.0)
          << line;
  }
}

}  // namespace
}  // namespace forager::tools
