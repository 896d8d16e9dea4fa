#pragma once
// MJCF models as documents of elements that can be created, read, changed and written. Element
// gives access by name. gloam/mjcf_elements.h has a class for each element with a property for each
// attribute (generated when Gloam is built, from MuJoCo's own library and manual). A document may
// contain everything that MuJoCo's parser reads; MuJoCo's manual documents the meaning.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/mjcf_schema.h"
#include "gloam/result.h"

namespace gloam::mjcf {

struct Node;  // src/scene/mjcf/node.h

/// Reference to one element of a document: copies refer to the same element. A removed element
/// lives as long as there is a reference to it.
class Element {
 public:
  explicit Element(std::shared_ptr<Node> node) : node_(std::move(node)) {}

  std::string_view tag() const;   ///< as written: "joint", "worldbody"
  std::string_view path() const;  ///< path in the grammar: "mujoco/body/joint"
  SourceLoc loc() const;          ///< location in the file; empty for a new element

  /// Returns the value as written; empty if it is not given. Errors: the element has no such
  /// attribute.
  Result<std::optional<std::string>> get(std::string_view attribute) const;
  /// Errors: the element has no such attribute (the message names the nearest one); invalid value.
  Status set(std::string_view attribute, std::string_view value);
  /// Restores the default of MuJoCo or of the class. Errors: the element has no such attribute.
  Status clear(std::string_view attribute);
  std::vector<std::string> given() const;  ///< attributes with a given value, in order

  std::vector<Element> children() const;
  std::vector<Element> children(std::string_view tag) const;
  std::optional<Element> parent() const;
  /// Appends a child element. Errors: the element is not allowed here, or not more than once.
  Result<Element> add(std::string_view tag);
  /// Removes the element from its document.
  void remove();

  bool operator==(const Element& other) const { return node_ == other.node_; }

 protected:
  // Accessors for the generated classes, which know that the attribute exists and its type.
  std::optional<std::string> text_of(std::string_view attribute) const;
  std::optional<double> real_of(std::string_view attribute) const;
  std::optional<int> int_of(std::string_view attribute) const;
  std::vector<double> reals_of(std::string_view attribute) const;  ///< empty if not given
  std::vector<int> ints_of(std::string_view attribute) const;
  void put(std::string_view attribute, std::string_view value);
  void put(std::string_view attribute, std::span<const double> values);
  void put(std::string_view attribute, std::span<const int> values);
  std::optional<bool> flag_of(std::string_view attribute) const;
  Element add_known(std::string_view tag);
  Element find_or_add(std::string_view tag);
  // Keywords of a generated enum E: words_of(E{}) lists them.
  template <class E>
  std::vector<E> keywords_of(std::string_view attribute) const {
    std::vector<E> list;
    for (const int place : places_of(attribute, words_of(E{})))
      list.push_back(static_cast<E>(place));
    return list;
  }
  template <class E>
  std::optional<E> keyword_of(std::string_view attribute) const {
    const std::vector<E> list = keywords_of<E>(attribute);
    return list.empty() ? std::optional<E>() : list[0];
  }
  template <class E>
  void put_keywords(std::string_view attribute, std::span<E> values) {
    std::string text;
    for (const E value : values)
      text += (text.empty() ? "" : " ") + std::string(words_of(value)[static_cast<size_t>(value)]);
    put(attribute, text);
  }

 private:
  friend class Document;
  // Positions of the attribute's words in a list.
  std::vector<int> places_of(std::string_view attribute,
                             std::span<const std::string_view> words) const;
  std::shared_ptr<Node> node_;
};

/// All descendants of `above` that belong to a generated class.
template <class E>
std::vector<E> all(const Element& above) {
  std::vector<E> list;
  for (const Element& child : above.children()) {
    if (child.path() == E::kPath) list.emplace_back(child);
    for (E& deeper : all<E>(child)) list.push_back(std::move(deeper));
  }
  return list;
}

/// A whole model: the element <mujoco> and its descendants.
class Document {
 public:
  /// An empty model.
  static Document make(std::string_view model_name);
  /// Reads MJCF (.xml) or its TOML form (.toml, docs/models.md). Included or referenced files are
  /// not read. Errors, with file and line: an element or attribute that MJCF does not have.
  static Result<Document> load(const std::filesystem::path& file);
  static Result<Document> from_xml(std::string_view text, const std::string& file = {});
  static Result<Document> from_toml(std::string_view text, const std::string& file = {});

  const Element& root() const { return root_; }
  /// Elements of one tag, in document order, whose name matches `pattern` (* matches any text).
  std::vector<Element> find(std::string_view tag, std::string_view pattern = "*") const;

  /// Checks that every element has the attributes that the parser requires. Error: the first
  /// element that does not.
  Status check() const;
  /// Omits values for which MJCF has no attribute ("not of MJCF" in gloam/mjcf_elements.h).
  std::string to_xml() const;
  std::string to_toml() const;
  /// Writes .xml or .toml, depending on the extension; replaces the file atomically. Errors: as for
  /// check(); a value that only .toml can represent.
  Status save(const std::filesystem::path& file) const;

 private:
  explicit Document(Element root) : root_(std::move(root)) {}
  Element root_;
};

}  // namespace gloam::mjcf
