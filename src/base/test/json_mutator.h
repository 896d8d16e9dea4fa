#pragma once
// Damaged JSON that is JSON: values, keys and lists change, the text around them does not, so that
// damage gets behind the parser.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/test/mutator.h"

namespace gloam {

class JsonMutator {
 public:
  explicit JsonMutator(uint64_t seed) : random_(seed) {}

  void mutate(nlohmann::json* document) {
    for (uint32_t times = 1 + random_.draw(4); times > 0; --times) {
      std::vector<nlohmann::json*> values;
      collect(document, &values);
      change(values[random_.draw(values.size())], values);
    }
  }

 private:
  using Json = nlohmann::json;

  static void collect(Json* value, std::vector<Json*>* out, int depth = 0) {
    out->push_back(value);
    if (!value->is_structured() || depth >= kDeepest) return;
    for (Json& child : *value) collect(&child, out, depth + 1);
  }

  void change(Json* value, const std::vector<Json*>& others) {
    if (value->is_object() && !value->empty()) return change_object(value, others);
    if (value->is_array() && !value->empty()) return change_list(value, others);
    if (value->is_number() && random_.draw(4) != 0) {
      *value = number(*value);
    } else if (value->is_string() && random_.draw(4) != 0) {
      *value = random_.mutate(value->get<std::string>());
    } else {
      *value = small_copy(*others[random_.draw(others.size())]);
    }
  }

  void change_object(Json* object, const std::vector<Json*>& others) {
    auto at = object->begin();
    std::advance(at, random_.draw(object->size()));
    const std::string key = at.key();
    switch (random_.draw(4)) {
      case 0:
        object->erase(key);
        break;
      case 1: {  // its value under another key of the document
        const Json value = at.value();
        const std::string other = other_key(others, key);  // `others` may lie in the value
        object->erase(key);
        (*object)[other] = value;
        break;
      }
      case 2:  // one more
        (*object)[other_key(others, key)] = small_copy(*others[random_.draw(others.size())]);
        break;
      default:
        *at = small_copy(*others[random_.draw(others.size())]);
    }
  }

  void change_list(Json* list, const std::vector<Json*>& others) {
    const size_t i = random_.draw(list->size()), k = random_.draw(list->size());
    switch (random_.draw(4)) {
      case 0:
        list->erase(i);
        break;
      case 1:
        list->push_back(Json((*list)[i]));
        break;
      case 2:
        std::swap((*list)[i], (*list)[k]);
        break;
      default:
        (*list)[i] = small_copy(*others[random_.draw(others.size())]);
    }
  }

  std::string other_key(const std::vector<Json*>& others, const std::string& otherwise) {
    std::vector<std::string> keys = {otherwise};
    for (const Json* value : others)
      if (value->is_object())
        for (const auto& [key, child] : value->items()) keys.push_back(key);
    return keys[random_.draw(keys.size())];
  }

  // Copies of copies would grow without end.
  static Json small_copy(const Json& value) {
    constexpr size_t kLargest = 4096;
    if (!value.is_structured()) return value;
    const size_t size = value.dump(-1, ' ', false, Json::error_handler_t::replace).size();
    return size > kLargest ? Json() : value;
  }

  Json number(const Json& value) {
    static const double kNumbers[] = {0,    1,    2,   -1,    255,  65535, 2147483647, 4294967295.0,
                                      1e15, 9e15, 0.5, 1e-30, 1e39, -1e39};
    const auto whole = value.is_number_integer() ? value.get<int64_t>() : int64_t{7};
    switch (random_.draw(4)) {
      case 0:
        return whole + 1;
      case 1:
        return whole - 1;
      default: {
        const size_t i = random_.draw(std::size(kNumbers));
        constexpr size_t kWhole = 10;  // the first of them
        return i < kWhole ? Json(static_cast<int64_t>(kNumbers[i])) : Json(kNumbers[i]);
      }
    }
  }

  static constexpr int kDeepest = 50;  // below it nothing changes
  Mutator random_;
};

/// The document with damage; text that is no JSON stays.
inline std::string mutate_json(const std::string& text, uint64_t seed) {
  constexpr int kDeepest = 200;  // the JSON library writes by recursion
  int depth = 0, deepest = 0;
  for (const char c : text) {
    depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    deepest = std::max(deepest, depth);
  }
  if (deepest > kDeepest) return text;
  nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
  if (document.is_discarded()) return text;
  JsonMutator(seed).mutate(&document);
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace gloam
