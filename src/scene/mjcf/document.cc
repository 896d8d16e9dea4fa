#include <fmt/format.h>

#include <functional>

#include "base/files.h"
#include "base/plain_text.h"
#include "base/text.h"
#include "scene/files/model_path.h"
#include "scene/mjcf/node.h"
#include "scene/mjcf/spec_only.h"

namespace gloam::mjcf {
namespace fs = std::filesystem;
namespace {

std::shared_ptr<Node> fresh_root() {
  auto root = std::make_shared<Node>();
  root->element = &MjcfSchema::get().root();
  return root;
}

bool is_toml(const fs::path& file) { return lower_extension(file) == ".toml"; }

Status check_node(const Node& node) {
  for (const MjcfAttribute& attribute : node.element->attributes) {
    const std::string* value = node.value_of(attribute);
    Status status;
    if (value != nullptr) {
      status = check_mjcf_value(attribute, *value);
    } else if (attribute.is_required) {
      status = Error{ErrorKind::kInput,
                     fmt::format("is missing '{}': {}", attribute.name, describe_type(attribute))};
    }
    if (status.ok()) continue;
    Error error = status.error();
    const MjcfAttribute* named = node.element->find("name");
    const std::string* name = named == nullptr ? nullptr : node.value_of(*named);
    if (name != nullptr) error.message = fmt::format("'{}' {}", *name, error.message);
    return node.refused(error);
  }
  for (const std::shared_ptr<Node>& child : node.children) GLOAM_TRY_STATUS(check_node(*child));
  return {};
}

}  // namespace

Document Document::make(std::string_view model_name) {
  std::shared_ptr<Node> root = fresh_root();
  root->set(*root->element->find("model"), model_name);
  return Document(Element(std::move(root)));
}

Result<Document> Document::load(const fs::path& file) {
  GLOAM_TRY(const std::string text, read_plain_text(file, kLargestModelText));
  return is_toml(file) ? from_toml(text, file.string()) : from_xml(text, file.string());
}

Result<Document> Document::from_xml(std::string_view text, const std::string& file) {
  std::shared_ptr<Node> root = fresh_root();
  GLOAM_TRY_STATUS(read_xml(text, file, root.get()));
  return Document(Element(std::move(root)));
}

Result<Document> Document::from_toml(std::string_view text, const std::string& file) {
  std::shared_ptr<Node> root = fresh_root();
  GLOAM_TRY_STATUS(read_toml(text, file, root.get()));
  return Document(Element(std::move(root)));
}

std::vector<Element> Document::find(std::string_view tag, std::string_view pattern) const {
  std::vector<Element> found;
  const std::function<void(const Element&)> visit = [&](const Element& element) {
    if (element.tag() == tag) {
      const Result<std::optional<std::string>> name = element.get("name");
      if (fits_pattern(pattern, name.ok() ? name->value_or("") : "")) found.push_back(element);
    }
    for (const Element& child : element.children()) visit(child);
  };
  visit(root_);
  return found;
}

Status Document::check() const { return check_node(*root_.node_); }

std::string Document::to_xml() const { return write_xml(*root_.node_); }
std::string Document::to_toml() const { return write_toml(*root_.node_); }

Status Document::save(const fs::path& file) const {
  GLOAM_TRY_STATUS(check());
  if (!is_toml(file)) GLOAM_TRY_STATUS(check_fits_xml(root_));
  return write_text_file_atomic(file, is_toml(file) ? to_toml() : to_xml());
}

}  // namespace gloam::mjcf
