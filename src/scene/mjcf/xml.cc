// MJCF as XML.

#include <fmt/format.h>

#include "scene/files/xml_text.h"
#include "scene/mjcf/node.h"

namespace gloam::mjcf {
namespace {

class XmlReader {
 public:
  XmlReader(std::string_view text, const std::string& file) : file_(file), lines_(text) {}

  SourceLoc loc(const pugi::xml_node& node) const {
    return {file_, lines_.at(node.offset_debug()), 0};
  }

  Status read(const pugi::xml_node& from, Node* to, int depth) const {
    if (depth > kDeepestXml)
      return Error{ErrorKind::kInput,
                   fmt::format("elements are nested more than {} deep", kDeepestXml), to->loc};
    for (const pugi::xml_attribute& attribute : from.attributes()) {
      if (std::string_view(attribute.name()).starts_with("xmlns") ||
          std::string_view(attribute.name()).starts_with("xsi:"))
        continue;  // place where an editor finds MJCF's schema
      GLOAM_TRY(const MjcfAttribute* known, attribute_of(*to->element, attribute.name(), to->loc));
      if (known->is_spec_only())
        return to->refused({ErrorKind::kInput,
                            fmt::format("has '{}', which is not in MJCF", attribute.name()),
                            {},
                            "it is available in TOML models"});
      if (Status status = check_mjcf_value(*known, attribute.value()); !status.ok())
        return to->refused(status.error());
      to->set(*known, attribute.value());
    }
    std::string comment;
    for (const pugi::xml_node& node : from.children()) {
      if (node.type() == pugi::node_comment) {
        comment += (comment.empty() ? "" : "\n") + std::string(node.value());
      } else if (node.type() == pugi::node_cdata && to->element->path == kTextPath) {
        to->content += node.value();
      } else if (node.type() == pugi::node_element) {
        GLOAM_TRY(const std::shared_ptr<Node> child, to->add(node.name(), loc(node)));
        child->comment = std::exchange(comment, {});
        GLOAM_TRY_STATUS(read(node, child.get(), depth + 1));
      }
    }
    to->last_comment = std::move(comment);
    return {};
  }

 private:
  std::string file_;
  XmlLines lines_;
};

void write_element(const Node& from, pugi::xml_node above) {
  if (!from.comment.empty()) above.append_child(pugi::node_comment).set_value(from.comment.c_str());
  pugi::xml_node to = above.append_child(std::string(from.tag()).c_str());
  for (const auto& [attribute, value] : from.values) {
    if (!attribute->is_spec_only())
      to.append_attribute(std::string(attribute->name).c_str()) = value.c_str();
  }
  if (!from.content.empty()) to.append_child(pugi::node_cdata).set_value(from.content.c_str());
  for (const std::shared_ptr<Node>& child : from.children) write_element(*child, to);
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
  GLOAM_TRY_STATUS(parse_xml(text, file, pugi::parse_default | pugi::parse_comments, &document));
  const XmlReader reader(text, file);
  const pugi::xml_node top = document.document_element();
  if (root->element->name != top.name())
    return Error{ErrorKind::kInput,
                 fmt::format("the root element is <{:.40}>, but MJCF starts with <{}>", top.name(),
                             root->element->name),
                 reader.loc(top)};
  root->loc = reader.loc(top);
  return reader.read(top, root, 1);
}

std::string write_xml(const Node& root) {
  pugi::xml_document document;
  write_element(root, document);
  StringWriter out;
  document.save(out, "  ", pugi::format_default | pugi::format_no_declaration, pugi::encoding_utf8);
  return out.text;
}

}  // namespace gloam::mjcf
