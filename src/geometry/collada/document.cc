#include "geometry/collada/document.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/nesting.h"
#include "geometry/mesh/text_lines.h"

namespace gloam {
namespace {

constexpr size_t kMostElements = size_t{4} << 20;

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

// The next word of an element's text, which may run over lines.
std::string_view next_word(std::string_view* text) {
  size_t begin = 0;
  while (begin < text->size() && is_space((*text)[begin])) ++begin;
  size_t end = begin;
  while (end < text->size() && !is_space((*text)[end])) ++end;
  const std::string_view word = text->substr(begin, end - begin);
  text->remove_prefix(end);
  return word;
}

// Exporters of languages with a decimal comma and of Windows write such numbers.
bool parse_float(std::string_view word, float* out) {
  if (parse_number(word, out)) return true;
  std::string lower(word);
  std::replace(lower.begin(), lower.end(), ',', '.');
  return parse_number(lower, out);
}

}  // namespace

Result<std::unique_ptr<ColladaDocument>> ColladaDocument::open(const ModelSource& source) {
  std::unique_ptr<ColladaDocument> out(new ColladaDocument(source));
  const auto refuse = [&](std::string message, ptrdiff_t offset) {
    const std::string_view text = as_text(source.bytes);
    return Error{ErrorKind::kInput,
                 std::move(message),
                 {source.name, line_at(text, static_cast<size_t>(offset)), 0},
                 "the file may be truncated; export the model again"};
  };
  if (const auto excess = xml_excess(as_text(source.bytes)))
    return refuse(excess->what, static_cast<ptrdiff_t>(excess->at));
  // A document type and the entities that it declares are skipped, so nothing else is opened.
  const pugi::xml_parse_result parsed = out->document_.load_buffer(
      source.bytes.data(), source.bytes.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed)
    return refuse(fmt::format("is not well-formed XML: {}", parsed.description()), parsed.offset);
  if (!out->root()) return refuse("is not a COLLADA file: its root element is not <COLLADA>", 0);
  size_t count = 0;
  for (pugi::xml_node node = out->root(); node;) {
    if (++count > kMostElements) return refuse("has too many elements", 0);
    if (const char* id = node.attribute("id").value(); *id != 0) out->ids_.emplace(id, node);
    if (node.first_child()) {
      node = node.first_child();
      continue;
    }
    while (node && !node.next_sibling() && node != out->root()) node = node.parent();
    node = node == out->root() ? pugi::xml_node() : node.next_sibling();
  }
  return out;
}

pugi::xml_node ColladaDocument::find(std::string_view url) const {
  if (url.starts_with('#')) url.remove_prefix(1);
  const auto found = ids_.find(url);
  return found == ids_.end() ? pugi::xml_node() : found->second;
}

SourceLoc ColladaDocument::loc_of(const pugi::xml_node& node) const {
  return {source_.name, line_at(as_text(source_.bytes), static_cast<size_t>(node.offset_debug())),
          0};
}

Error ColladaDocument::bad(const pugi::xml_node& node, std::string_view message) const {
  const std::string id = node.attribute("id").value();
  const std::string named = id.empty() ? "" : fmt::format(" '{:.80}'", id);
  return {ErrorKind::kInput, fmt::format("<{:.40}>{} {}", node.name(), named, message),
          loc_of(node), "repair the file or export it again"};
}

Status ColladaDocument::read_floats(const pugi::xml_node& node, std::vector<float>* out) {
  std::string_view text = node.text().get();
  if (!budget_.take(text.size() / 2 + 1, sizeof(float)))
    return bad(node, "exceeds the size limit when decoded");
  out->clear();
  for (std::string_view word; !(word = next_word(&text)).empty();) {
    float value;
    if (!parse_float(word, &value))
      return bad(node, fmt::format("contains '{}', which is not a number", word.substr(0, 40)));
    out->push_back(value);
  }
  return {};
}

Status ColladaDocument::read_indices(const pugi::xml_node& node, std::vector<uint32_t>* out) {
  std::string_view text = node.text().get();
  if (!budget_.take(text.size() / 2 + 1, sizeof(uint32_t)))
    return bad(node, "exceeds the size limit when decoded");
  out->clear();
  for (std::string_view word; !(word = next_word(&text)).empty();) {
    uint32_t value = 0;
    if (!parse_integer(word, &value))
      return bad(node,
                 fmt::format("contains '{}', which is not a valid index", word.substr(0, 40)));
    out->push_back(value);
  }
  return {};
}

}  // namespace gloam
