// MJCF as XML.

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>

#include "base/text.h"
#include "scene/mjcf/node.h"

namespace gloam::mjcf {
namespace {

class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : file_(file) {
    for (size_t i = text.find('\n'); i != std::string_view::npos; i = text.find('\n', i + 1))
      line_ends_.push_back(static_cast<ptrdiff_t>(i));
  }

  SourceLoc loc(ptrdiff_t offset) const {
    const auto end = std::ranges::lower_bound(line_ends_, offset);
    return {file_, static_cast<int>(end - line_ends_.begin()) + 1, 0};
  }

  Status read(const pugi::xml_node& from, Node* to, int depth) const {
    to->loc = loc(from.offset_debug());
    if (depth > kDeepestNode)
      return Error{ErrorKind::kInput,
                   fmt::format("elements are nested more than {} deep", kDeepestNode), to->loc};
    for (const pugi::xml_attribute& attribute : from.attributes()) {
      if (std::string_view(attribute.name()).starts_with("xmlns") ||
          std::string_view(attribute.name()).starts_with("xsi:"))
        continue;  // where an editor finds MJCF's schema
      GLOAM_TRY(const MjcfAttribute* known, attribute_of(*to->element, attribute.name(), to->loc));
      if (Status status = check_mjcf_value(*known, attribute.value()); !status.ok()) {
        Error error = std::move(status).error();
        error.message = fmt::format("<{}> {}", from.name(), error.message);
        error.loc = to->loc;
        return error;
      }
      to->set(*known, attribute.value());
    }
    std::string comment;
    for (const pugi::xml_node& node : from.children()) {
      if (node.type() == pugi::node_comment) {
        comment += (comment.empty() ? "" : "\n") + std::string(node.value());
      } else if (node.type() == pugi::node_cdata) {
        to->content += node.value();
      } else if (node.type() == pugi::node_element) {
        const std::shared_ptr<Node> child = to->add(node.name());
        if (child == nullptr) return wrong_tag(*to->element, node.name(), loc(node.offset_debug()));
        child->comment = std::exchange(comment, {});
        GLOAM_TRY_STATUS(read(node, child.get(), depth + 1));
      }
    }
    to->last_comment = std::move(comment);
    return {};
  }

 private:
  std::string file_;
  std::vector<ptrdiff_t> line_ends_;
};

void write(const Node& from, pugi::xml_node above) {
  if (!from.comment.empty()) above.append_child(pugi::node_comment).set_value(from.comment.c_str());
  pugi::xml_node to = above.append_child(std::string(from.tag()).c_str());
  for (const auto& [attribute, value] : from.values)
    to.append_attribute(std::string(attribute->name).c_str()) = value.c_str();
  if (!from.content.empty()) to.append_child(pugi::node_cdata).set_value(from.content.c_str());
  for (const std::shared_ptr<Node>& child : from.children) write(*child, to);
  if (!from.last_comment.empty())
    to.append_child(pugi::node_comment).set_value(from.last_comment.c_str());
}

struct StringWriter : pugi::xml_writer {
  std::string text;
  void write(const void* data, size_t size) override {
    text.append(static_cast<const char*>(data), size);
  }
};

}  // namespace

Status read_xml(std::string_view text, const std::string& file, Node* root) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(
      text.data(), text.size(), pugi::parse_default | pugi::parse_comments, pugi::encoding_utf8);
  const Reader reader(text, file);
  if (!parsed) {
    std::string what = parsed.description();
    if (!what.empty()) what[0] = static_cast<char>(std::tolower(what[0]));
    return Error{ErrorKind::kInput, fmt::format("is not well-formed XML: {}", what),
                 reader.loc(parsed.offset)};
  }
  const pugi::xml_node top = document.document_element();
  if (root->element->name != top.name())
    return Error{ErrorKind::kInput,
                 fmt::format("the top element is <{:.40}>, and MJCF's is <{}>", top.name(),
                             root->element->name),
                 reader.loc(top.offset_debug())};
  return reader.read(top, root, 1);
}

std::string write_xml(const Node& root) {
  pugi::xml_document document;
  write(root, document);
  StringWriter out;
  document.save(out, "  ", pugi::format_default | pugi::format_no_declaration, pugi::encoding_utf8);
  return out.text;
}

}  // namespace gloam::mjcf
