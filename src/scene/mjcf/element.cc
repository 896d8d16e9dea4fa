#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/check.h"
#include "scene/mjcf/node.h"

namespace gloam::mjcf {
namespace {

const MjcfAttribute& known(const Node& node, std::string_view attribute) {
  const MjcfAttribute* found = node.element->find(attribute);
  GLOAM_CHECK(found != nullptr,
              "a generated class uses an attribute that its element does not have");
  return *found;
}

template <class T>
std::vector<T> numbers(const std::optional<std::string>& text) {
  return read_numbers<T>(text.value_or("")).value_or(std::vector<T>());
}

}  // namespace

std::string_view Element::tag() const { return node_->tag(); }
std::string_view Element::path() const { return node_->element->path; }
SourceLoc Element::loc() const { return node_->loc; }

Result<std::optional<std::string>> Element::get(std::string_view name) const {
  GLOAM_TRY(const MjcfAttribute* attribute, attribute_of(*node_->element, name, node_->loc));
  const std::string* value = node_->value_of(*attribute);
  return value == nullptr ? std::optional<std::string>() : *value;
}

Status Element::set(std::string_view name, std::string_view value) {
  GLOAM_TRY(const MjcfAttribute* attribute, attribute_of(*node_->element, name, node_->loc));
  if (Status status = check_mjcf_value(*attribute, value); !status.ok())
    return node_->refused(status.error());
  node_->set(*attribute, value);
  return {};
}

Status Element::clear(std::string_view name) {
  GLOAM_TRY(const MjcfAttribute* attribute, attribute_of(*node_->element, name, node_->loc));
  std::erase_if(node_->values, [&](const auto& pair) { return pair.first == attribute; });
  return {};
}

std::vector<std::string> Element::given() const {
  std::vector<std::string> names;
  for (const auto& [attribute, value] : node_->values) names.emplace_back(attribute->name);
  return names;
}

std::vector<Element> Element::children() const {
  std::vector<Element> list;
  for (const std::shared_ptr<Node>& child : node_->children) list.emplace_back(child);
  return list;
}

std::vector<Element> Element::children(std::string_view tag) const {
  std::vector<Element> list;
  for (const std::shared_ptr<Node>& child : node_->children) {
    if (child->tag() == tag) list.emplace_back(child);
  }
  return list;
}

std::optional<Element> Element::parent() const {
  if (node_->parent == nullptr) return {};
  return Element(node_->parent->shared_from_this());
}

Result<Element> Element::add(std::string_view tag) {
  GLOAM_TRY(std::shared_ptr<Node> child, node_->add(tag, node_->loc));
  return Element(std::move(child));
}

void Element::remove() {
  Node* const parent = std::exchange(node_->parent, nullptr);
  if (parent != nullptr) std::erase(parent->children, node_);
}

std::optional<std::string> Element::text_of(std::string_view attribute) const {
  const std::string* value = node_->value_of(known(*node_, attribute));
  return value == nullptr ? std::optional<std::string>() : *value;
}

std::optional<double> Element::real_of(std::string_view attribute) const {
  const std::vector<double> list = reals_of(attribute);
  return list.empty() ? std::optional<double>() : list[0];
}

std::optional<int> Element::int_of(std::string_view attribute) const {
  const std::vector<int> list = ints_of(attribute);
  return list.empty() ? std::optional<int>() : list[0];
}

std::vector<double> Element::reals_of(std::string_view attribute) const {
  return numbers<double>(text_of(attribute));
}

std::vector<int> Element::ints_of(std::string_view attribute) const {
  return numbers<int>(text_of(attribute));
}

void Element::put(std::string_view attribute, std::string_view value) {
  node_->set(known(*node_, attribute), value);
}

void Element::put(std::string_view attribute, std::span<const double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + number_text(value);
  put(attribute, text);
}

void Element::put(std::string_view attribute, std::span<const int> values) {
  put(attribute, fmt::format("{}", fmt::join(values, " ")));
}

std::optional<bool> Element::flag_of(std::string_view attribute) const {
  const std::optional<std::string> text = text_of(attribute);
  return text ? std::optional<bool>(*text == "true" || *text == "enable") : std::nullopt;
}

std::vector<int> Element::places_of(std::string_view attribute,
                                    std::span<const std::string_view> words) const {
  std::vector<int> places;
  const std::string text = text_of(attribute).value_or("");
  for (const std::string_view word : split_words(text)) {
    const auto found = std::ranges::find(words, word);
    if (found != words.end()) places.push_back(static_cast<int>(found - words.begin()));
  }
  return places;
}

Element Element::add_known(std::string_view tag) {
  Result<std::shared_ptr<Node>> child = node_->add(tag, node_->loc);
  GLOAM_CHECK(child.ok(), "a generated class uses an element that is not allowed there");
  return Element(std::move(child).value());
}

Element Element::find_or_add(std::string_view tag) {
  const std::vector<Element> there = children(tag);
  return there.empty() ? add_known(tag) : there.front();
}

}  // namespace gloam::mjcf
