#pragma once
// Damaged XML that is XML: elements and attributes change, so that damage gets behind the parser.

#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/test/mutator.h"

namespace gloam {

class XmlMutator {
 public:
  explicit XmlMutator(uint64_t seed) : random_(seed) {}

  void mutate(pugi::xml_document* document) {
    for (uint32_t times = 1 + random_.draw(3); times > 0; --times) {
      nodes_.clear();
      collect(document->document_element());
      if (nodes_.empty()) return;
      change(any_node());
    }
  }

 private:
  void collect(const pugi::xml_node& node, int depth = 0) {
    if (node.type() != pugi::node_element || depth > kDeepest) return;
    nodes_.push_back(node);
    for (const pugi::xml_node& child : node.children()) collect(child, depth + 1);
  }

  pugi::xml_node any_node() { return nodes_[random_.draw(nodes_.size())]; }

  pugi::xml_attribute any_attribute(const pugi::xml_node& node) {
    std::vector<pugi::xml_attribute> all;
    for (const pugi::xml_attribute& a : node.attributes()) all.push_back(a);
    return all.empty() ? pugi::xml_attribute() : all[random_.draw(all.size())];
  }

  void change(pugi::xml_node node) {
    const bool is_top = node == nodes_[0];
    // Mostly of the same name, so that schemas allow the other's attributes.
    pugi::xml_node other = any_node();
    for (int i = 0; i < 8 && std::string_view(other.name()) != node.name(); ++i) other = any_node();
    pugi::xml_attribute attribute = any_attribute(node);
    const pugi::xml_attribute others = any_attribute(other);
    switch (random_.draw(16)) {
      case 0:
        if (!is_top) node.parent().remove_child(node);
        break;
      case 1:
        if (!is_top) node.parent().insert_copy_after(node, node).remove_attribute("name");
        break;
      case 2:  // into another element
        if (!is_top && other != nodes_[0] && nodes_.size() < kMostNodes)
          other.parent().insert_copy_after(node, other).remove_attribute("name");
        break;
      case 3:
        if (!is_top) node.set_name(other.name());
        break;
      case 4:
        node.remove_attribute(attribute);
        break;
      case 5:
        if (others && !node.attribute(others.name())) node.append_copy(others);
        break;
      case 6:
        if (attribute && other.attribute(attribute.name()))
          attribute.set_value(other.attribute(attribute.name()).value());
        break;
      default:
        if (attribute) attribute.set_value(value(attribute.value()).c_str());
    }
  }

  // Numbers among the words become others, the count of words may change.
  std::string value(const std::string& text) {
    static const char* const kNumbers[] = {"0",     "-1",         "1",          "1e-9", "1e9",
                                           "1e308", "-1e308",     "1e-300",     "0.5",  "nan",
                                           "inf",   "2147483647", "99999999999"};
    std::vector<std::string> words;
    std::istringstream in(text);
    for (std::string word; in >> word;) words.push_back(word);
    if (words.empty()) return "1";
    std::string& word = words[random_.draw(words.size())];
    const bool is_number = std::string_view("0123456789+-.").find(word[0]) < 13;
    switch (random_.draw(16)) {
      case 0:
        words.pop_back();
        break;
      case 1:
        words.push_back(words.back());
        break;
      default:
        // Names and keywords seldom change: unknown ones end at the parser.
        if (is_number)
          word = kNumbers[random_.draw(std::size(kNumbers))];
        else if (random_.draw(4) == 0)
          word = random_.mutate(word);
    }
    std::string out;
    for (const std::string& w : words) out += (out.empty() ? "" : " ") + w;
    return out;
  }

  static constexpr size_t kMostNodes = 200;
  static constexpr int kDeepest = 100;
  Mutator random_;
  std::vector<pugi::xml_node> nodes_;  // in document order
};

/// The document with damage; text that is no XML stays.
inline std::string mutate_xml(const std::string& text, uint64_t seed) {
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8))
    return text;
  XmlMutator(seed).mutate(&document);
  std::ostringstream out;
  document.save(out, " ");
  return out.str();
}

}  // namespace gloam
