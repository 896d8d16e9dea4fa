#include "schema_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>

#include "gloam/mjcf.h"
#include "interrupt.h"
#include "json_text.h"
#include "print.h"

namespace gloam::cli {
namespace {

using Json = nlohmann::ordered_json;
using mjcf::SchemaCoverage;

struct Count {
  size_t total = 0;
  std::vector<std::string> missing;
  size_t mirrored() const { return total - missing.size(); }
};

template <class Rows, class Mirrored>
Count count_of(const Rows& rows, Mirrored&& mirrored) {
  Count count;
  for (const auto& row : rows) {
    ++count.total;
    if (!mirrored(row)) count.missing.push_back(row.name);
  }
  return count;
}

Json json_of(const Count& count) {
  return {{"total", count.total}, {"mirrored", count.mirrored()}, {"missing", count.missing}};
}

void print_json(const SchemaCoverage& coverage, const Count& attributes, const Count& fields) {
  Count all = attributes;
  all.total += fields.total;
  all.missing.insert(all.missing.end(), fields.missing.begin(), fields.missing.end());
  Json json = json_of(all);
  json["elements"] = coverage.elements;
  json["attributes"] = json_of(attributes);
  json["fields"] = json_of(fields);
  Json& by_field = json["field_attributes"] = Json::object();
  for (const auto& field : coverage.fields) {
    by_field[field.name] = field.attributes.empty() ? Json{{"follows_from", field.follows_from}}
                                                    : Json(field.attributes);
  }
  Json& by_attribute = json["attribute_fields"] = Json::object();
  for (const auto& attribute : coverage.attributes) by_attribute[attribute.name] = attribute.fields;
  put_json(json, 1);
}

// "mujoco/actuator/motor/gear" of thirty elements as "gear of actuator/motor, actuator/position …".
std::string in_short(const std::vector<std::string>& attributes) {
  constexpr size_t kMaxDocWords = 3;
  std::vector<std::string> first;
  for (const std::string& attribute : attributes) {
    if (first.size() == kMaxDocWords) break;
    first.push_back(attribute.substr(attribute.find('/') + 1));
  }
  const size_t more = attributes.size() - first.size();
  return fmt::format("{}{}", fmt::join(first, ", "),
                     more == 0 ? "" : fmt::format(" and {} more", more));
}

void print_text(const SchemaCoverage& coverage, const Count& attributes, const Count& fields) {
  const auto of_mjcf = static_cast<size_t>(
      std::ranges::count(coverage.attributes, false, &SchemaCoverage::Attribute::is_spec_only));
  say("attributes: {} of {} mirrored: {} of MJCF's {} elements, {} that exist only in mjSpec\n",
      attributes.mirrored(), attributes.total, of_mjcf, coverage.elements,
      coverage.attributes.size() - of_mjcf);
  say("fields of mjSpec: {} of {} mirrored\n\n", fields.mirrored(), fields.total);
  for (const auto& field : coverage.fields) {
    say("  {:<34} {}\n", field.name,
        !field.attributes.empty()    ? in_short(field.attributes)
        : field.follows_from.empty() ? "MISSING"
                                     : "(" + field.follows_from + ")");
  }
  for (const Count* count : {&attributes, &fields}) {
    for (const std::string& name : count->missing) say("missing: {}\n", name);
  }
  say("\nuse --json for the complete table in both directions\n");
}

}  // namespace

int report_schema(const Globals& globals) {
  const auto start = std::chrono::steady_clock::now();
  std::mutex mutex;  // the work is done on several threads
  const ProgressCallback show = progress_display(globals);
  const SchemaCoverage coverage = mjcf::find_schema_coverage([&](double done) {
    const std::lock_guard lock(mutex);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return show({"finding the fields that each attribute sets", done, seconds.count()});
  });
  finish_progress();
  if (interrupted()) return fail({ErrorKind::kInterrupted, "interrupted"});
  const Count attributes =
      count_of(coverage.attributes, [](const auto& attribute) { return attribute.is_mirrored; });
  const Count fields =
      count_of(coverage.fields, [](const auto& field) { return field.is_mirrored(); });
  globals.json ? print_json(coverage, attributes, fields)
               : print_text(coverage, attributes, fields);
  return attributes.missing.empty() && fields.missing.empty() ? 0 : 1;
}

}  // namespace gloam::cli
