#include "base/nesting.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace gloam {
namespace {

/// First byte behind the next `end` from `at` on, or the text's end.
size_t behind(std::string_view text, std::string_view end, size_t at) {
  const size_t found = text.find(end, std::min(at, text.size()));
  return found == std::string_view::npos ? text.size() : found + end.size();
}

/// First byte behind a <!DOCTYPE …>, which may hold declarations in brackets.
size_t behind_declaration(std::string_view text, size_t at) {
  int open = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"' || c == '\'') at = behind(text, text.substr(at, 1), at + 1) - 1;
    if (c == '<') ++open;
    if (c == '>' && --open == 0) return at + 1;
  }
  return text.size();
}

struct XmlTag {
  size_t end = 0;  ///< first byte behind it
  int attributes = 0;
  bool is_empty = false;  ///< <name/>
};
XmlTag read_tag(std::string_view text, size_t at) {
  XmlTag tag;
  for (; at < text.size() && text[at] != '>'; ++at) {
    if (text[at] == '"' || text[at] == '\'') at = behind(text, text.substr(at, 1), at + 1) - 1;
    if (at < text.size() && text[at] == '=' && ++tag.attributes > kMostXmlAttributes) break;
  }
  tag.end = std::min(at + 1, text.size());
  tag.is_empty = at > 0 && at < text.size() && text[at - 1] == '/';
  return tag;
}

class TomlScan {
 public:
  explicit TomlScan(std::string_view text) : text_(text) {}

  std::optional<Excess> run() {
    while (at_ < text_.size() && is_within_) read_expression();
    if (is_within_) return {};
    return Excess{at_, fmt::format("keys and tables are nested more than {} deep", kDeepestToml)};
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool starts(std::string_view with) const { return text_.substr(at_).starts_with(with); }
  bool go_to(int depth) { return is_within_ = depth <= kDeepestToml; }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }

  void skip_blanks(bool with_lines) {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        skip_line();
      } else if (c == ' ' || c == '\t' || c == '\r' || (with_lines && c == '\n')) {
        ++at_;
      } else {
        return;
      }
    }
  }

  /// A string of any of the four kinds; one of a single line ends with it at the latest.
  void skip_string() {
    const char quote = peek();
    const std::string_view three = quote == '"' ? "\"\"\"" : "'''";
    const bool is_long = starts(three);
    for (at_ += is_long ? 3 : 1; at_ < text_.size(); ++at_) {
      if (quote == '"' && text_[at_] == '\\') {
        ++at_;
      } else if (is_long ? starts(three) : text_[at_] == quote || text_[at_] == '\n') {
        break;
      }
    }
    at_ = std::min(at_ + (is_long ? 3 : 1), text_.size());
    // Up to two quotes more belong to a long string that they end.
    for (int i = 0; is_long && i < 2 && peek() == quote; ++i) ++at_;
  }

  /// Parts of a key that ends before one of `ends` or with its line.
  int count_parts(std::string_view ends) {
    int parts = 1;
    while (at_ < text_.size() && ends.find(text_[at_]) == std::string_view::npos &&
           text_[at_] != '\n') {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string();
        continue;
      }
      if (c == '.' && !go_to(++parts)) break;
      ++at_;
    }
    return parts;
  }

  void read_expression() {
    skip_blanks(true);
    if (at_ >= text_.size()) return;
    if (peek() == '[') {
      while (peek() == '[') ++at_;
      header_ = count_parts("]");
      if (is_within_) skip_line();
      return;
    }
    const int depth = header_ + count_parts("=");
    if (go_to(depth) && peek() == '=') read_value(depth);
  }

  /// A value and the rest of its line; arrays and tables within each other by a list, not a call.
  void read_value(int depth) {
    struct Open {
      bool is_table;
      int depth;  ///< outside of its brackets
    };
    std::vector<Open> open;
    ++at_;
    while (at_ < text_.size() && is_within_) {
      skip_blanks(!open.empty());
      const char c = peek();
      if (c == '"' || c == '\'') {
        skip_string();
        continue;
      }
      if (c == '\n') return;
      if (c == '[' || c == '{') {
        open.push_back({c == '{', depth});
        if (!go_to(++depth)) return;
      } else if ((c == ']' || c == '}') && !open.empty()) {
        depth = open.back().depth;
        open.pop_back();
      }
      ++at_;
      // A key comes next.
      if (!open.empty() && open.back().is_table && (c == '{' || c == ',')) {
        skip_blanks(true);
        if (peek() != '}' && !go_to(depth = open.back().depth + 1 + count_parts("=}"))) return;
      }
    }
  }

  std::string_view text_;
  size_t at_ = 0;
  int header_ = 0;
  bool is_within_ = true;
};

}  // namespace

std::optional<Excess> xml_excess(std::string_view text) {
  int depth = 0;
  for (size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      at = behind(text, "-->", at + 4);
    } else if (rest.starts_with("<![CDATA[")) {
      at = behind(text, "]]>", at + 9);
    } else if (rest.starts_with("<?")) {
      at = behind(text, "?>", at + 2);
    } else if (rest.starts_with("<!")) {
      at = behind_declaration(text, at);
    } else if (rest.starts_with("</")) {
      depth = std::max(depth - 1, 0);
      at = behind(text, ">", at);
    } else {
      const XmlTag tag = read_tag(text, at + 1);
      if (tag.attributes > kMostXmlAttributes)
        return Excess{at,
                      fmt::format("an element has more than {} attributes", kMostXmlAttributes)};
      if (depth + 1 > kDeepestXml)
        return Excess{at, fmt::format("elements are nested more than {} deep", kDeepestXml)};
      if (!tag.is_empty) ++depth;
      at = tag.end;
    }
  }
  return {};
}

std::optional<Excess> toml_excess(std::string_view text) { return TomlScan(text).run(); }

std::optional<Excess> json_excess(std::string_view text, uint64_t most_values) {
  int depth = 0;
  uint64_t values = 1;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '}' || c == ']') --depth;
    const bool opens = c == '{' || c == '[';
    if (opens && ++depth > kDeepestJson)
      return Excess{i, fmt::format("it is nested more than {} levels deep", kDeepestJson)};
    if ((opens || c == ',') && ++values > most_values)
      return Excess{i, fmt::format("it has too many values; the limit is {}", most_values)};
  }
  return {};
}

int line_at(std::string_view text, size_t at) {
  const std::string_view before = text.substr(0, at);
  return static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1;
}

Status check_excess(const std::optional<Excess>& excess, std::string_view text,
                    const std::string& file) {
  if (!excess) return {};
  return Error{ErrorKind::kInput, excess->what, {file, line_at(text, excess->at), 0}};
}

}  // namespace gloam
