#pragma once
// As much of JSON Schema (draft 7) as Gloam's own schemas use, and TOML as JSON.

#include <fmt/format.h>
#include <toml++/toml.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace gloam::schema_test {

using Json = nlohmann::json;

/// Dates and times are strings, as editors have them.
inline Json to_json(const toml::node& node) {
  Json json;
  if (const auto* table = node.as_table()) {
    json = Json::object();
    for (const auto& [key, value] : *table) json[std::string(key.str())] = to_json(value);
  } else if (const auto* array = node.as_array()) {
    json = Json::array();
    for (const toml::node& item : *array) json.push_back(to_json(item));
  } else {
    node.visit([&](const auto& value) {
      std::ostringstream text;
      if constexpr (toml::is_date<decltype(value)> || toml::is_time<decltype(value)> ||
                    toml::is_date_time<decltype(value)>) {
        text << value.get();
        json = text.str();
      } else if constexpr (toml::is_value<decltype(value)>) {
        json = value.get();
      }
    });
  }
  return json;
}

class Checker {
 public:
  explicit Checker(const std::string& schema) : root_(Json::parse(schema)) {}
  const Json& root() const { return root_; }

  /// "" or the first thing that is wrong. Throws at a word that is not known here.
  std::string check(const Json& value) const { return check(root_, value, ""); }
  std::string check_toml(std::string_view text) const { return check(to_json(toml::parse(text))); }

 private:
  static bool has_type(const Json& v, const std::string& type) {
    if (type == "integer")
      return v.is_number_integer() ||
             (v.is_number() && v.get<double>() == std::floor(v.get<double>()));
    return (type == "object" && v.is_object()) || (type == "array" && v.is_array()) ||
           (type == "string" && v.is_string()) || (type == "boolean" && v.is_boolean()) ||
           (type == "number" && v.is_number());
  }

  std::string check(const Json& schema, const Json& v, const std::string& at) const {
    if (schema.is_boolean()) return schema.get<bool>() ? "" : at + " may not be there";
    if (schema.contains("$ref"))
      return check(root_.at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1))), v,
                   at);
    for (const auto& [word, rule] : schema.items()) {
      std::string wrong = check_word(schema, word, rule, v, at);
      if (!wrong.empty()) return wrong;
    }
    return "";
  }

  std::string check_word(const Json& schema, const std::string& word, const Json& rule,
                         const Json& v, const std::string& at) const {
    const auto fails = [&] {
      return fmt::format("{} is {}: {} {}", at, v.dump(), word, rule.dump());
    };
    const auto complain_unless = [&](bool good) { return good ? std::string() : fails(); };
    if (word == "type") {
      bool fits = false;
      for (const Json& type : rule.is_array() ? rule : Json::array({rule}))
        fits = fits || has_type(v, type);
      return complain_unless(fits);
    }
    if (word == "enum")
      return complain_unless(std::find(rule.begin(), rule.end(), v) != rule.end());
    if (word == "anyOf") {
      bool fits = false;
      for (const Json& one : rule) fits = fits || check(one, v, at).empty();
      return complain_unless(fits);
    }
    if (word == "pattern")
      return complain_unless(
          !v.is_string() ||
          std::regex_search(v.get<std::string>(), std::regex(rule.get<std::string>())));
    if (word == "minLength")
      return complain_unless(!v.is_string() || !v.get<std::string>().empty());
    if (word == "minimum") return complain_unless(!v.is_number() || v >= rule);
    if (word == "maximum") return complain_unless(!v.is_number() || v <= rule);
    if (word == "exclusiveMinimum") return complain_unless(!v.is_number() || v > rule);
    if (word == "exclusiveMaximum") return complain_unless(!v.is_number() || v < rule);
    if (word == "minItems") return complain_unless(!v.is_array() || v.size() >= rule);
    if (word == "maxItems") return complain_unless(!v.is_array() || v.size() <= rule);
    if (word == "required") {
      for (const Json& key : rule)
        if (v.is_object() && !v.contains(key)) return fmt::format("{} lacks {}", at, key.dump());
      return "";
    }
    if (word == "items") {
      for (size_t i = 0; v.is_array() && i < v.size(); ++i) {
        std::string wrong = check(rule, v[i], fmt::format("{}[{}]", at, i));
        if (!wrong.empty()) return wrong;
      }
      return "";
    }
    if (word == "properties" || word == "additionalProperties") {
      if (!v.is_object()) return "";
      for (const auto& [key, value] : v.items()) {
        const bool is_named = schema.contains("properties") && schema["properties"].contains(key);
        if (is_named != (word == "properties")) continue;
        std::string wrong = check(is_named ? rule.at(key) : rule, value, at + "." + key);
        if (!wrong.empty()) return wrong;
      }
      return "";
    }
    for (const char* known : {"$schema", "title", "description", "default", "definitions"})
      if (word == known) return "";
    throw std::runtime_error("not known here: " + word);
  }

  Json root_;
};

}  // namespace gloam::schema_test
