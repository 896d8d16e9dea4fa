#include "scene/mjcf/schema.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "base/text.h"

namespace gloam {
namespace {

using namespace std::string_view_literals;  // suffix in the table: "text"sv

constexpr MjcfType kString = MjcfType::kString, kInt = MjcfType::kInt, kReal = MjcfType::kReal,
                   kKeyword = MjcfType::kKeyword;

#define GLOAM_ELEMENT(path, times, attributes)
#define GLOAM_ATTRIBUTE(...) {__VA_ARGS__},
constexpr MjcfAttribute kAttributes[] = {
#include "mjcf_schema_table.inc"
};
#undef GLOAM_ELEMENT
#undef GLOAM_ATTRIBUTE

struct ElementRow {
  std::string_view path;
  char times;
  int attributes;
};
#define GLOAM_ELEMENT(path, times, attributes) {path, times, attributes},
#define GLOAM_ATTRIBUTE(...)
constexpr ElementRow kElements[] = {
#include "mjcf_schema_table.inc"
};
#undef GLOAM_ELEMENT
#undef GLOAM_ATTRIBUTE

}  // namespace

std::vector<std::string_view> split_words(std::string_view text) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlank = " \t\r\n";
  for (size_t begin = text.find_first_not_of(kBlank); begin != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(kBlank, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(kBlank, end);
  }
  return words;
}

const MjcfAttribute* MjcfElement::find(std::string_view attribute) const {
  const auto found = std::ranges::find(attributes, attribute, &MjcfAttribute::name);
  return found == attributes.end() ? nullptr : &*found;
}

const MjcfSchema& MjcfSchema::get() {
  static const MjcfSchema schema;
  return schema;
}

MjcfSchema::MjcfSchema() {
  attribute_count_ = static_cast<int>(
      std::ranges::count(kAttributes, false, [](const auto& a) { return a.is_spec_only(); }));
  elements_.reserve(std::size(kElements));
  const MjcfAttribute* next = kAttributes;
  for (const ElementRow& row : kElements) {
    const size_t slash = row.path.rfind('/');
    MjcfElement element;
    element.path = row.path;
    element.name = row.path.substr(slash + 1);
    element.times = row.times;
    element.attributes = {next, static_cast<size_t>(row.attributes)};
    next += row.attributes;
    elements_.push_back(std::move(element));
    if (slash == std::string_view::npos) continue;
    MjcfElement* parent = const_cast<MjcfElement*>(find(row.path.substr(0, slash)));
    GLOAM_CHECK(parent != nullptr, "an element of the grammar precedes its parent");
    elements_.back().parent = parent;
    parent->children.push_back(&elements_.back());
  }
  body_ = find("mujoco/body");
  include_ = find("mujoco/include");
}

const MjcfElement* MjcfSchema::find(std::string_view path) const {
  const auto found = std::ranges::find(elements_, path, &MjcfElement::path);
  return found == elements_.end() ? nullptr : &*found;
}

const MjcfElement* MjcfSchema::child(const MjcfElement& above, std::string_view name) const {
  if (name == include_->name) return include_;
  // <frame>, <replicate>
  const bool is_group = body_ != nullptr && above.parent == body_ && above.times == 'R';
  const MjcfElement& holder = is_group ? *body_ : above;
  if (holder.times == 'R' && name == holder.name) return &holder;
  for (const MjcfElement* element : holder.children) {
    if (tag(*element, holder) == name) return element;
  }
  return nullptr;
}

std::string_view MjcfSchema::tag(const MjcfElement& element, const MjcfElement& above) {
  return element.path == "mujoco/body" && above.parent == nullptr ? "worldbody" : element.name;
}

std::vector<std::string> MjcfSchema::tags_in(const MjcfElement& above) const {
  std::vector<std::string> tags;
  for (const MjcfElement& element : elements_) {
    const std::string_view name = tag(element, above);
    if (child(above, name) == &element) tags.emplace_back(name);
  }
  return tags;
}

Status check_mjcf_value(const MjcfAttribute& attribute, std::string_view text) {
  if (attribute.type == kString) return {};
  const std::vector<std::string_view> words = split_words(text);
  const auto complain = [&](std::string_view what) {
    return Error{ErrorKind::kInput, fmt::format("{}=\"{:.60}\" {}; expected {}", attribute.name,
                                                text, what, describe_type(attribute))};
  };
  if (attribute.type == kKeyword) {
    const std::vector<std::string_view> known = split_words(attribute.keywords);
    for (const std::string_view word : words) {
      if (std::ranges::find(known, word) != known.end()) continue;
      Error error = complain("is not a valid keyword");
      const std::vector<std::string> names(known.begin(), known.end());
      if (const std::string near = nearest_name(word, names); !near.empty())
        error.hint = fmt::format("did you mean '{}'?", near);
      return error;
    }
  } else {
    for (const std::string_view word : words) {
      if (attribute.type == kInt ? !read_number<int>(word) : !read_number<double>(word))
        return complain(fmt::format("contains '{:.30}', which is not a {}number", word,
                                    attribute.type == kInt ? "whole " : ""));
    }
  }
  const int count = static_cast<int>(words.size());
  if (count < attribute.least) return complain("is too short");
  if (attribute.most != MjcfAttribute::kAnyLength && count > attribute.most)
    return complain("is too long");
  return {};
}

std::string describe_type(const MjcfAttribute& attribute) {
  const std::string unit =
      attribute.unit.empty() || attribute.unit == "1" ? "" : fmt::format(" [{}]", attribute.unit);
  if (attribute.type == kString) return "text";
  if (attribute.type == kKeyword) {
    std::string list(attribute.keywords);
    for (size_t i = list.find(' '); i != std::string::npos; i = list.find(' ', i + 2))
      list.replace(i, 1, ", ");
    return (attribute.most == 1 ? "one of " : "some of ") + list;
  }
  const std::string_view kind = attribute.type == kInt ? "whole number" : "number";
  if (attribute.most == MjcfAttribute::kAnyLength) return fmt::format("{}s{}", kind, unit);
  if (attribute.most == 1) return fmt::format("a {}{}", kind, unit);
  if (attribute.least == attribute.most) return fmt::format("{} {}s{}", attribute.most, kind, unit);
  return fmt::format("{} to {} {}s{}", attribute.least, attribute.most, kind, unit);
}

}  // namespace gloam
