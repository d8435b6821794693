#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace forager::reader::advannet {

// Walks a small XML document in place, without a tree, an allocation or a copy: event bodies are on the hot
// path, and a tree costs several times the scan (tests/bench/advannet_bench.cpp). Knows elements, attributes
// (skipped), text, CDATA, comments and processing instructions, and checks nesting. Refuses what no reader
// sends and attackers do: document types (so no entity can be defined), nesting beyond kMaxDepth, NUL bytes.
// Anything it accepts, pugixml accepts with the same content (tested).
class XmlScanner {
 public:
  static constexpr std::size_t kMaxDepth = 32;
  enum class Token : std::uint8_t {
    open,   // name() is the element's; an empty element gives open and close
    close,  // name() is the element's
    text,   // text(), not blank, entities as they stand
    end,    // the document was well-formed
    error,  // problem() says why; final
  };

  explicit XmlScanner(std::string_view document);

  Token next();
  // Right after open: the element's text, entities as they stand and blanks at both ends removed; the scan
  // goes on behind its close. Of an element with children or several pieces of text, the first piece. On
  // error the next next() answers it.
  std::string_view leaf_text();
  // Right after open: if the element holds nothing but text, steps behind its close and is true; else does
  // nothing. Quick, for elements nobody wants to look at.
  bool skip_leaf();

  [[nodiscard]] std::string_view name() const { return name_; }
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] std::size_t depth() const { return depth_; }  // open elements
  [[nodiscard]] std::string_view problem() const { return problem_; }

 private:
  Token fail(std::string_view problem);
  Token markup();
  Token open_tag();
  Token close_tag();
  Token close_top();
  bool take_leaf(std::string_view& text);
  Token cdata();
  bool skip_past(std::string_view end, std::string_view problem);
  bool skip_attributes(bool& empty_element);
  void skip_blanks();
  std::string_view take_name();

  const char* at_;
  const char* end_;
  std::string_view name_;
  std::string_view text_;
  std::string_view problem_;
  std::array<std::string_view, kMaxDepth> stack_;
  std::size_t depth_ = 0;
  bool empty_element_ = false;  // the open just given still owes its close
  bool root_seen_ = false;
};

// Text with the five predefined entities and character references replaced (as UTF-8), control characters
// turned into blanks, at most `limit` bytes of it; unknown entities stay as they are. Reuses out's memory.
void decode_text(std::string_view raw, std::size_t limit, std::string& out);
// The other way round, for request bodies: & < > " ' replaced.
[[nodiscard]] std::string escape_text(std::string_view raw);

}  // namespace forager::reader::advannet
