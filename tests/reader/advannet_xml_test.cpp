#include "reader/advannet_xml.hpp"

#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>
#include <pugixml.hpp>

#include <vector>

#include "tests/reader/advannet_sample.hpp"

namespace forager::reader::advannet {
namespace {

using Token = XmlScanner::Token;

// The scan as one line: "(a (b 'text' ) )", or "error".
std::string scan(std::string_view document) {
  XmlScanner xml(document);
  std::string line;
  while (true) {
    switch (xml.next()) {
      case Token::open:
        line.append("(").append(xml.name()).append(" ");
        break;
      case Token::close:
        line += ") ";
        break;
      case Token::text:
        line.append("'").append(xml.text()).append("' ");
        break;
      case Token::end:
        return line;
      case Token::error:
        EXPECT_FALSE(xml.problem().empty());
        return "error";
    }
  }
}

// The same line from pugixml's tree.
void write_tree(const pugi::xml_node& node, std::string& line) {
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() == pugi::node_element) {
      line.append("(").append(child.name()).append(" ");
      write_tree(child, line);
      line += ") ";
    } else if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) {
      std::string_view text = child.value();
      const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
      while (!text.empty() && blank(text.front())) text.remove_prefix(1);
      while (!text.empty() && blank(text.back())) text.remove_suffix(1);
      line.append("'").append(text).append("' ");
    }
  }
}
std::string tree(const std::string& document) {
  pugi::xml_document doc;
  if (!doc.load_buffer(document.data(), document.size(), pugi::parse_cdata, pugi::encoding_utf8))
    return "error";
  std::string line;
  write_tree(doc, line);
  return line;
}

TEST(XmlScanner, WalksWhatReadersSend) {
  EXPECT_EQ(
      scan("<?xml version=\"1.0\"?>\n<a><b>x &amp; y</b> <c/><!-- - no -- >--><d k='>' l=\"'\" /></a>\n"),
      "(a (b 'x &amp; y' ) (c ) (d ) ) ");
  EXPECT_EQ(scan("\xEF\xBB\xBF<a><![CDATA[<raw>]]></a>"), "(a '<raw>' ) ");
}

TEST(XmlScanner, RefusesWhatIsNotWellFormedOrHostile) {
  const std::string deep = [] {
    std::string text;
    for (int i = 0; i < 100'000; ++i) text += "<a>";
    return text;
  }();
  for (const std::string& document : {
           std::string(),
           std::string("  "),
           std::string("text"),
           std::string("<a>"),
           std::string("<a></b>"),
           std::string("</a>"),
           std::string("<a></a><b/>"),
           std::string("<a></a>x"),
           std::string("<a"),
           std::string("<a b>x</a>"),
           std::string("<a b=c/>"),
           std::string("<a b='c/>"),
           std::string("<a><</a>"),
           std::string("<a>x"),
           std::string("<!-- "),
           std::string("<?xml "),
           std::string("<a><![CDATA[x</a>"),
           std::string("<a>\0</a>", 8),
           std::string("<a></a\0>", 8),
           deep,
           std::string("<!DOCTYPE a [<!ENTITY x \"xxxxxxxx\"><!ENTITY y \"&x;&x;&x;\">]><a>&y;</a>"),
       })
    EXPECT_EQ(scan(document), "error") << document.substr(0, 60);
}

TEST(XmlScanner, LeafTextIsTheElementsOwnFirstText) {
  XmlScanner xml("<a><b> one <i>two</i>three</b><c/><d><e>x</e></d><f>last</f></a>");
  ASSERT_EQ(xml.next(), Token::open);
  std::vector<std::string> texts;
  while (xml.next() == Token::open) texts.emplace_back(xml.leaf_text());
  EXPECT_EQ(texts, (std::vector<std::string>{"one", "", "", "last"}));
}

TEST(XmlText, DecodesKnownEntitiesAndLeavesTheRest) {
  std::string out;
  decode_text("a&lt;b&gt; &amp;amp; &#65;&#x20AC;&nope; &#0; &#xD800; &", 100, out);
  EXPECT_EQ(out, "a<b> &amp; A\xE2\x82\xAC&nope;   &#xD800; &");
  decode_text(std::string(1000, 'x'), 10, out);
  EXPECT_EQ(out.size(), 10U);
  EXPECT_EQ(escape_text("<a & \"b\">'"), "&lt;a &amp; &quot;b&quot;&gt;&apos;");
}

TEST(XmlScanner, AgreesWithPugixmlOnTheCaptures) {
  for (const char* file :
       {"inventory.xml", "inventory_folded.xml", "gpi_event.xml", "server_event.xml", "devices.xml"}) {
    const std::string document = test::advannet_file(file);
    std::string plain;
    pugi::xml_document doc;
    ASSERT_TRUE(doc.load_buffer(document.data(), document.size(), pugi::parse_cdata));
    write_tree(doc, plain);
    EXPECT_EQ(scan(document), plain) << file;
  }
}

// A document of random shape; each piece is replaced by stray markup now and then.
std::string random_document() {
  static const std::vector<std::string> kStray{"<",   ">",     "/",     "]]>",     "&amp;", "<a",   "</a>",
                                               "<b>", "<b/ >", "<b k>", "<b k=v>", "<!-- ", "<a/>", "<? ?>"};
  const auto stray = [] { return *rc::gen::inRange(0, 40) == 0; };
  const auto piece = [&](std::string sound) { return stray() ? *rc::gen::elementOf(kStray) : sound; };
  std::string document = "<r>";
  std::vector<std::string> open;
  for (int left = *rc::gen::inRange(0, 30); left > 0; --left) {
    const std::string name = *rc::gen::element<std::string>("a", "b-1", "ns:c", "item");
    switch (*rc::gen::inRange(0, 8)) {
      case 0:
      case 1:
        document += piece("<" + name + ">");
        open.push_back(name);
        break;
      case 2:
        document += piece("<" + name + " k='v>' l = \"<&'\">");
        open.push_back(name);
        break;
      case 3:
      case 4:
        if (open.empty()) break;
        document += piece("</" + open.back() + ">");
        open.pop_back();
        break;
      case 5:
        document += piece("<" + name + "/>");
        break;
      case 6:
        document += piece(" text &lt; more ");
        break;
      default:
        document += piece(*rc::gen::element<std::string>("<!--c-->", "<?p i?>", "<![CDATA[z>]]>", "\n "));
    }
  }
  for (; !open.empty(); open.pop_back()) document += "</" + open.back() + ">";
  return document + "</r>";
}

// What the scanner accepts, pugixml accepts with the same content; and of what pugixml accepts it refuses
// little: that is in RefusesWhatIsNotWellFormedOrHostile.
RC_GTEST_PROP(XmlScannerProperty, AcceptsNothingThatPugixmlRefuses, ()) {
  const std::string document = random_document();
  const std::string own = scan(document);
  RC_CLASSIFY(own != "error", "accepted");
  if (own != "error") RC_ASSERT(own == tree(document));
}

RC_GTEST_PROP(XmlScannerProperty, LeafTextEndsWhereTheElementEnds, ()) {
  const std::string document = "<o>" + random_document() + "<last>z</last></o>";
  XmlScanner xml(document);
  (void)xml.next();
  (void)xml.next();
  (void)xml.leaf_text();
  if (scan(document) == "error") return;
  RC_ASSERT(xml.next() == Token::open);
  RC_ASSERT(xml.name() == "last");
  RC_ASSERT(xml.skip_leaf());
  RC_ASSERT(xml.next() == Token::close);
  RC_ASSERT(xml.next() == Token::end);
}

}  // namespace
}  // namespace forager::reader::advannet
