// Tables [[observation]] of a policy's settings.

#include <fmt/format.h>

#include <algorithm>

#include "policy/policy_spec.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace {

constexpr std::string_view kCommonKeys[] = {"term",  "scale", "clip",  "history", "sensor",
                                            "input", "from",  "first", "count"};
constexpr int kLongestTermHistory = 1000, kMostElements = 1'000'000;
constexpr size_t kMostParts = 1000;

std::vector<std::string_view> keys_of(const TermKind& kind) {
  std::vector<std::string_view> keys(std::begin(kCommonKeys), std::end(kCommonKeys));
  for (size_t begin = 0; begin < kind.keys.size();) {
    const size_t end = std::min(kind.keys.find(' ', begin), kind.keys.size());
    keys.push_back(kind.keys.substr(begin, end - begin));
    begin = end + 1;
  }
  return keys;
}

void read_scale(const toml::table& table, Settings* s, ObservationPart* part) {
  const toml::node* node = table.get("scale");
  if (node == nullptr) return;
  const std::string name = fmt::format("observation term '{}': scale", part->kind->name);
  part->scale = s->numbers(*node, name);
  const size_t size = part->term->size();
  if (s->ok() && size != 0 && part->scale.size() != 1 && part->scale.size() != size)
    s->fail(node,
            fmt::format("{} has {} numbers, but the term has {}", name, part->scale.size(), size));
}

void read_output(const toml::table& table, Settings* s, ObservationPart* part) {
  const std::string from = s->text(table, "from");
  const size_t point = from.find('.');
  part->from = {from.substr(0, point), point == std::string::npos ? "" : from.substr(point + 1)};
  part->first = s->whole(table, "first", 0, 0, kMostElements);
  part->count = s->whole(table, "count", 0, 1, kMostElements);
  if (part->kind->reads_output != part->from.is_set())
    s->fail(&table,
            fmt::format("observation term '{}' {}", part->kind->name,
                        part->kind->reads_output ? "needs from = \"NETWORK\" or \"NETWORK.OUTPUT\""
                                                 : "does not read the output of a network"));
}

void read_part(const toml::node& node, Settings* s, const PolicySpec& spec, NetworkSpec* network) {
  const toml::table* table = node.as_table();
  if (table == nullptr || (!table->contains("term") && !table->contains("from")))
    return s->fail(&node, "an [[observation]] needs a term", "for example term = \"base_ang_vel\"");
  ObservationPart part;
  part.loc = loc_of(node, s->file());
  const toml::value<std::string> output("network_output");
  const toml::node* name = table->get("term");
  part.kind = find_term(name != nullptr ? *name : output, s);
  if (part.kind == nullptr) return;
  s->check_keys(*table, keys_of(*part.kind), fmt::format("observation term '{}'", part.kind->name));
  if (s->ok()) part.term = make_term(*part.kind, {table, s, &spec});
  if (!s->ok()) return;
  read_scale(*table, s, &part);
  if (const toml::node* clip = table->get("clip"))
    part.clip = s->range(*clip, fmt::format("observation term '{}': clip", part.kind->name));
  part.history = s->whole(*table, "history", 1, 1, kLongestTermHistory);
  part.sensor = s->text(*table, "sensor");
  part.input = s->text(*table, "input");
  read_output(*table, s, &part);
  if (s->ok()) network->parts.push_back(std::move(part));
}

}  // namespace

void read_observations(const toml::node& list, Settings* s, const PolicySpec& spec,
                       NetworkSpec* network) {
  const toml::array* array = list.as_array();
  if (array == nullptr || array->empty() || array->size() > kMostParts)
    return s->fail(&list, fmt::format("observation must be a list of 1 to {} tables: "
                                      "[[observation]]",
                                      kMostParts));
  for (size_t i = 0; s->ok() && i < array->size(); ++i) read_part((*array)[i], s, spec, network);
}

}  // namespace gloam
