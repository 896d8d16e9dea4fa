// Metadata of ONNX files as mjlab 1.6 and holosoma 0.1 write it. mjlab writes lists as text with
// commas (parts of an entry with semicolons), rounded to three decimals; holosoma writes JSON.

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/nesting.h"
#include "policy/policy_spec.h"

namespace gloam {
namespace {

using Json = nlohmann::ordered_json;
using Metadata = std::vector<std::pair<std::string, std::string>>;
constexpr size_t kMostEntries = 10'000;

std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  if (trimmed(text).empty()) return parts;
  for (size_t begin = 0; begin <= text.size() && parts.size() < kMostEntries;) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

/// Reads the metadata of one file; it keeps the first error.
class MetadataReader {
 public:
  MetadataReader(const Metadata& metadata, const std::string& file)
      : metadata_(metadata), file_(file) {}

  Result<toml::table> read() {
    toml::table settings;
    if (const std::string* joints = find("joint_names"))
      read_mjlab(*joints, &settings);
    else if (find("dof_names") != nullptr)
      read_holosoma(&settings);
    if (!status_.ok()) return status_.error();
    return settings;
  }

 private:
  const std::string* find(std::string_view key) const {
    for (const auto& [name, value] : metadata_)
      if (name == key) return &value;
    return nullptr;
  }
  void fail(std::string message, std::string hint = {}) {
    if (status_.ok())
      status_ = Error{ErrorKind::kInput, std::move(message), {file_, 0, 0}, std::move(hint)};
  }

  toml::array numbers(std::string_view text, std::string_view key, char separator) {
    toml::array values;
    for (std::string_view part : split(text, separator)) {
      double value = 0;
      if (part.starts_with('+')) part.remove_prefix(1);
      const auto read = std::from_chars(part.data(), part.data() + part.size(), value);
      if (read.ec != std::errc() || read.ptr != part.data() + part.size())
        fail(fmt::format("metadata '{}' is not a list of numbers: '{:.60}'", key, text));
      values.push_back(value);
    }
    return values;
  }
  /// Numbers of each observation term; empty if the file does not contain them.
  std::vector<toml::array> entries(std::string_view key, size_t count) {
    std::vector<toml::array> list;
    const std::string* text = find(key);
    if (text == nullptr) return list;
    for (const std::string_view part : split(*text, ',')) list.push_back(numbers(part, key, ';'));
    for (const toml::array& entry : list)
      if (entry.empty()) fail(fmt::format("metadata '{}' has an empty entry", key));
    if (list.size() != count)
      fail(fmt::format("metadata '{}' has {} entries for {} observation terms", key, list.size(),
                       count));
    return list;
  }

  void read_mjlab(const std::string& joints, toml::table* settings) {
    toml::table policy;
    toml::array names;
    for (const std::string_view name : split(joints, ',')) names.push_back(std::string(name));
    policy.insert("joints", std::move(names));
    constexpr std::pair<const char*, const char*> kKeys[] = {
        {"joint_stiffness", "kp"},
        {"joint_damping", "kd"},
        {"default_joint_pos", "default_positions"},
        {"action_scale", "action_scale"}};
    for (const auto& [key, name] : kKeys) {
      const std::string* text = find(key);
      if (text == nullptr) continue;
      toml::array values = numbers(*text, key, ',');
      if (values.size() == 1)
        policy.insert(name, values[0].value_or(0.0));
      else
        policy.insert(name, std::move(values));
    }
    settings->insert("policy", std::move(policy));
    if (const std::string* terms = find("observation_names"))
      settings->insert("observation", read_mjlab_terms(split(*terms, ',')));
  }

  toml::array read_mjlab_terms(const std::vector<std::string_view>& names) {
    const auto scales = entries("observation_terms_scale", names.size());
    const auto clips = entries("observation_terms_clip", names.size());
    const auto lengths = entries("observation_terms_history_length", names.size());
    const std::string* flat = find("observation_terms_flatten_history_dim");
    const auto flags = split(flat != nullptr ? std::string_view(*flat) : "", ',');
    toml::array terms;
    for (size_t i = 0; status_.ok() && i < names.size(); ++i) {
      toml::table term{{"term", std::string(names[i])}};
      if (!scales.empty()) term.insert("scale", scales[i]);
      if (!clips.empty()) term.insert("clip", clips[i]);
      const double length = lengths.empty() ? 1 : lengths[i][0].value_or(0.0);
      if (length != std::floor(length) || !(std::abs(length) < 1e6))
        fail(fmt::format("observation term '{:.80}' has an invalid history of {:g} observations",
                         names[i], length));
      // mjlab's 0 means none.
      term.insert("history", static_cast<int64_t>(std::max(1.0, length)));
      const bool is_flat =
          flags.empty() || (i < flags.size() && flags[i] != "0" && flags[i] != "0.000" &&
                            flags[i] != "false" && flags[i] != "False");
      if (length > 1 && !is_flat)
        fail(fmt::format("observation term '{:.80}' has a history that is not flattened", names[i]),
             "export the policy with flatten_history_dim");
      terms.push_back(std::move(term));
    }
    return terms;
  }

  std::optional<Json> json(std::string_view key) {
    const std::string* text = find(key);
    if (text == nullptr) return {};
    Json value = parse_bounded<Json>(*text);
    if (!value.is_discarded()) return value;
    fail(fmt::format("metadata '{}' is not valid JSON", key));
    return {};
  }
  /// Numbers, texts and lists of them; all else is left out, and its reader reports that.
  static toml::array list_of(const Json& json) {
    toml::array list;
    for (const Json& one : json) {
      if (one.is_string()) list.push_back(one.get<std::string>());
      if (one.is_number()) list.push_back(one.get<double>());
      if (list.size() == kMostEntries) break;
    }
    return list;
  }
  void insert(std::string_view key, const Json& json, toml::table* table) {
    if (json.is_number())
      table->insert(key, json.get<double>());
    else if (json.is_array())
      table->insert(key, list_of(json));
    else
      fail(fmt::format("metadata '{}' is neither a number nor a list", key));
  }

  void read_holosoma(toml::table* settings) {
    toml::table policy{{"history_start", "zeros"}};
    if (const auto joints = json("dof_names")) insert("joints", *joints, &policy);
    for (const char* key : {"kp", "kd", "action_scale"})
      if (const auto values = json(key)) insert(key, *values, &policy);
    const auto ranges = json("command_ranges");
    toml::table limits;
    constexpr std::pair<const char*, const char*> kAxes[] = {{"lin_vel_x", "vx"},
                                                             {"lin_vel_y", "vy"},
                                                             {"ang_vel_yaw", "yaw_rate"},
                                                             {"ang_vel_z", "yaw_rate"}};
    if (ranges && ranges->is_object())  // null: the policy takes no command
      for (const auto& [key, name] : kAxes)
        if (ranges->contains(key)) insert(name, (*ranges)[key], &limits);
    if (!limits.empty()) policy.insert("command_ranges", std::move(limits));
    settings->insert("policy", std::move(policy));
  }

  const Metadata& metadata_;
  const std::string& file_;
  Status status_;
};

}  // namespace

Result<toml::table> settings_of_metadata(const Metadata& metadata, const std::string& file) {
  return MetadataReader(metadata, file).read();
}

}  // namespace gloam
