#include "report/metric_names.h"

#include <algorithm>
#include <array>
#include <utility>

namespace gloam {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 27> kUnits = {{
    {"_radps2", "rad/s²"}, {"_radps", "rad/s"}, {"_mps2", "m/s²"}, {"_mps", "m/s"},
    {"_per_m", "1/m"},     {"_per_s", "1/s"},   {"_percent", "%"}, {"_rad", "rad"},
    {"_deg", "°"},         {"_Nm", "N m"},      {"_nm", "N m"},    {"_lx", "lx"},
    {"_hz", "Hz"},         {"_Hz", "Hz"},       {"_kg", "kg"},     {"_px", "px"},
    {"_db", "dB"},         {"_m", "m"},         {"_s", "s"},       {"_N", "N"},
    {"_n", "N"},           {"_J", "J"},         {"_j", "J"},       {"_W", "W"},
    {"_w", "W"},           {"_k", "K"},         {"_K", "K"},
}};

// Parts of names, by the built-in metrics of Gloam.
constexpr std::array kLowerIsBetter = {"error",         "falls",  "fallen",       "collision",
                                       "slip",          "energy", "time_to_goal", "cost",
                                       "goal_distance", "drift"};
constexpr std::array kHigherIsBetter = {"success", "goals_reached", "spl", "sct"};

bool has_word(const std::string& text, const char* word) {
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const size_t end = at + std::char_traits<char>::length(word);
    const bool starts = at == 0 || text[at - 1] == '_' || text[at - 1] == '.';
    if (starts && (end == text.size() || text[end] == '_' || text[end] == 's')) return true;
  }
  return false;
}

}  // namespace

MetricName split_metric_name(const std::string& name) {
  MetricName out;
  std::string rest = name;
  if (const size_t point = name.rfind('.'); point != std::string::npos && point > 0) {
    out.subject = name.substr(0, point);
    rest = name.substr(point + 1);
  }
  for (const auto& [ending, unit] : kUnits) {
    const std::string end = ending;
    if (rest.size() > end.size() && rest.ends_with(end)) {
      out.unit = unit;
      rest.resize(rest.size() - end.size());
      break;
    }
  }
  std::replace(rest.begin(), rest.end(), '_', ' ');
  out.text = rest;
  return out;
}

Better better_of(const std::string& name) {
  const size_t point = name.rfind('.');
  const std::string own = point == std::string::npos ? name : name.substr(point + 1);
  for (const char* word : kHigherIsBetter)
    if (has_word(own, word)) return Better::kMore;
  for (const char* word : kLowerIsBetter)
    if (has_word(own, word)) return Better::kLess;
  return Better::kUnknown;
}

}  // namespace gloam
