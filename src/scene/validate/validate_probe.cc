#include "scene/validate/validate_probe.h"

#include <fmt/format.h>

#include "scene/options/probe_quantities.h"

namespace gloam {
namespace {

/// Keys of a kind of place, and the remedy for wrong ones.
struct PlaceRule {
  ProbePlace place;
  bool position, body, agent, camera, normal;  ///< keys that it may have
  const char* remedy;
};
constexpr PlaceRule kPlaceRules[] = {
    {ProbePlace::kPoint, true, true, false, false, false,
     "specify 'position' in the world, or 'body' and 'position' in its frame"},
    {ProbePlace::kSurface, true, true, false, false, true,
     "specify 'position' in the world, or 'body' and 'position' in its frame, and a 'normal' if it "
     "is not +Z"},
    {ProbePlace::kBodies, false, true, true, false, false,
     "specify 'body', or 'agent' for all parts of a person or vehicle"},
    {ProbePlace::kBodiesOrPoint, true, true, true, false, false,
     "specify 'body' or 'agent' for sinking parts, or 'position' for the footprint at that point"},
    {ProbePlace::kCamera, false, false, false, true, false, "specify 'camera'"},
};

const PlaceRule& rule_of(ProbePlace place) {
  for (const PlaceRule& rule : kPlaceRules)
    if (rule.place == place) return rule;
  return kPlaceRules[0];
}

}  // namespace

Status validate_probe(const ProbeOptions& probe) {
  const ProbeQuantity& quantity = *find_probe_quantity(probe.quantity);
  const PlaceRule& rule = rule_of(quantity.place);
  const auto bad = [&](const std::string& what) {
    return Error{ErrorKind::kInput,
                 fmt::format("probe '{}' of '{}' {}", probe.name, quantity.word, what), probe.loc,
                 rule.remedy};
  };
  const struct {
    const char* key;
    bool is_given, may_be;
  } keys[] = {{"position", probe.position.has_value(), rule.position},
              {"body", !probe.body.empty(), rule.body},
              {"agent", !probe.agent.empty(), rule.agent},
              {"camera", !probe.camera.empty(), rule.camera},
              {"normal", probe.normal.has_value(), rule.normal}};
  int places = 0;
  for (const auto& key : keys) {
    if (key.is_given && !key.may_be) return bad(fmt::format("does not support '{}'", key.key));
    if (key.is_given && key.key != std::string_view("normal")) ++places;
  }
  if (places == 0) return bad("does not specify a place");
  const bool is_point =
      quantity.place == ProbePlace::kPoint || quantity.place == ProbePlace::kSurface;
  if (places > 1 && !is_point) return bad("specifies two places");
  if (const auto& n = probe.normal; n && !(n->x * n->x + n->y * n->y + n->z * n->z > 1e-12))
    return bad("has a 'normal' of length 0");
  return {};
}

}  // namespace gloam
