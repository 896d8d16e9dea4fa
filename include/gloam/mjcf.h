#pragma once
// Models by hand: a document of MJCF elements that is made, read, changed and written. Element is
// one of them by name; gloam/mjcf_elements.h has a class for each with a property for each
// attribute (generated when Gloam is built, from MuJoCo's own library and manual). What a document
// holds is what MuJoCo's parser reads; MuJoCo's manual says what it means.

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

/// One element of a document, by reference: copies are the same element. An element that was
/// removed lives as long as something refers to it.
class Element {
 public:
  explicit Element(std::shared_ptr<Node> node) : node_(std::move(node)) {}

  std::string_view tag() const;   ///< as written: "joint", "worldbody"
  std::string_view path() const;  ///< in the grammar: "mujoco/body/joint"
  SourceLoc loc() const;          ///< place where it was read; empty for a new element

  /// As written; empty where it is not given. Errors: the element has no such attribute.
  Result<std::optional<std::string>> get(std::string_view attribute) const;
  /// Errors: the element has no such attribute (the nearest is named), it does not take this value.
  Status set(std::string_view attribute, std::string_view value);
  /// MuJoCo's default, or the class's, holds again. Errors: the element has no such attribute.
  Status clear(std::string_view attribute);
  std::vector<std::string> given() const;  ///< attributes that it gives, in order

  std::vector<Element> children() const;
  std::vector<Element> children(std::string_view tag) const;
  std::optional<Element> parent() const;
  /// Adds an element below, behind those that are there. Errors: it may not stand here, or
  /// not twice.
  Result<Element> add(std::string_view tag);
  /// Takes it out of its document.
  void remove();

  bool operator==(const Element& other) const { return node_ == other.node_; }

 protected:
  // Accessors for the generated classes, which know that the attribute exists and its type.
  std::optional<std::string> text_of(std::string_view attribute) const;
  std::optional<double> real_of(std::string_view attribute) const;
  std::optional<int> int_of(std::string_view attribute) const;
  std::vector<double> reals_of(std::string_view attribute) const;  ///< empty where not given
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

/// The elements below `above`, however deep, that are of a generated class.
template <class E>
std::vector<E> all(const Element& above) {
  std::vector<E> list;
  for (const Element& child : above.children()) {
    if (child.path() == E::kPath) list.emplace_back(child);
    for (E& deeper : all<E>(child)) list.push_back(std::move(deeper));
  }
  return list;
}

/// A whole model: the element <mujoco> and what is below it.
class Document {
 public:
  /// An empty model.
  static Document make(std::string_view model_name);
  /// Reads MJCF (.xml) or its TOML form (.toml, docs/models.md). Of what it includes or names,
  /// nothing is read. Errors: with file and line; an element or attribute that MJCF does not have.
  static Result<Document> load(const std::filesystem::path& file);
  static Result<Document> from_xml(std::string_view text, const std::string& file = {});
  static Result<Document> from_toml(std::string_view text, const std::string& file = {});

  const Element& root() const { return root_; }
  /// Elements of one tag, in document order, whose name fits `pattern` (* stands for any text).
  std::vector<Element> find(std::string_view tag, std::string_view pattern = "*") const;

  /// Does every element have what the parser requires? Errors: the first that does not.
  Status check() const;
  /// Without what MJCF has no attribute for ("not of MJCF" in gloam/mjcf_elements.h).
  std::string to_xml() const;
  std::string to_toml() const;
  /// As .xml or .toml, by the name; replaces the file at once or not at all. Errors: those of
  /// check(); something that only .toml can hold.
  Status save(const std::filesystem::path& file) const;

 private:
  explicit Document(Element root) : root_(std::move(root)) {}
  Element root_;
};

}  // namespace gloam::mjcf
