#pragma once
// Node that an Element of gloam/mjcf.h refers to.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gloam/mjcf.h"
#include "scene/mjcf/schema.h"

namespace gloam::mjcf {

struct Node : std::enable_shared_from_this<Node> {
  const MjcfElement* element = nullptr;
  Node* parent = nullptr;
  std::vector<std::pair<const MjcfAttribute*, std::string>> values = {};  // as written, in order
  std::vector<std::shared_ptr<Node>> children = {};
  std::string comment = {};       // comment before it
  std::string last_comment = {};  // comment behind its children
  std::string content = {};       // CDATA of a <text>
  SourceLoc loc = {};

  const std::string* value_of(const MjcfAttribute& attribute) const;
  void set(const MjcfAttribute& attribute, std::string_view value);
  /// An element below. Errors: it may not stand here, or not twice; with `place`.
  Result<std::shared_ptr<Node>> add(std::string_view tag, const SourceLoc& place);
  std::string_view tag() const;
  /// The error of one of its attributes, with the element's tag and place.
  Error refused(Error error) const;
};

inline constexpr std::string_view kTextPath = "mujoco/custom/text";

/// The attribute, or an Error that names the nearest.
Result<const MjcfAttribute*> attribute_of(const MjcfElement& element, std::string_view name,
                                          const SourceLoc& loc);

/// A number so that it is read back bit by bit, in as few digits as that takes.
std::string number_text(double value);

/// Into `root`, which is a fresh <mujoco>.
Status read_xml(std::string_view text, const std::string& file, Node* root);
Status read_toml(std::string_view text, const std::string& file, Node* root);
std::string write_xml(const Node& root);
std::string write_toml(const Node& root);

}  // namespace gloam::mjcf
