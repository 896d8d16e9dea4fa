#include "world/authored_material.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "scene/pattern_names.h"

namespace gloam {
namespace {

Vec3f color_of(const Vec3& c) {
  return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}

/// `pattern` with any text in the place of each *.
bool fits(std::string_view pattern, std::string_view name) {
  const size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == name;
  if (name.substr(0, star) != pattern.substr(0, star)) return false;
  const std::string_view rest = pattern.substr(star + 1);
  for (size_t at = star; at <= name.size(); ++at) {
    if (fits(rest, name.substr(at))) return true;
  }
  return false;
}

static_assert(kPatternKinds.size() == kProceduralKindCount);

/// The value of an enum from its name.
template <class Enum>
Enum named(std::string_view word, std::span<const std::string_view> names) {
  return static_cast<Enum>(place_of(word, names));
}

ProceduralDescription pattern_of(const PatternOptions& in) {
  ProceduralDescription out = default_procedural(named<ProceduralKind>(in.kind, kPatternKinds));
  const auto number = [](const std::optional<double>& from, float* to) {
    if (from) *to = static_cast<float>(*from);
  };
  const auto color = [](const std::optional<Vec3>& from, Vec3f* to) {
    if (from) *to = color_of(*from);
  };
  out.seed = static_cast<uint32_t>(in.seed);
  color(in.color_a, &out.color_a);
  color(in.color_b, &out.color_b);
  color(in.color_c, &out.color_c);
  number(in.scale, &out.scale);
  number(in.size_u, &out.size_u);
  number(in.size_v, &out.size_v);
  number(in.gap, &out.gap);
  number(in.depth, &out.depth);
  number(in.roughness, &out.roughness);
  number(in.coat, &out.coat);
  number(in.variation, &out.variation);
  number(in.amount, &out.amount);
  if (in.axis) {
    const Vec3f axis = color_of(*in.axis);
    if (length_squared(axis) > 1e-6f) out.axis = normalize(axis);
  }
  out.basis = named<NoiseBasis>(in.basis, kNoiseBases);
  out.bond = named<BrickBond>(in.bond, kBrickBonds);
  out.tile = named<TileShape>(in.tile, kTileShapes);
  out.weave = named<Weave>(in.weave, kWeaves);
  return out;
}

void apply(const MaterialOptions& in, int pattern, int wear, MaterialDescription* out) {
  const auto f = [](double x) { return static_cast<float>(x); };
  if (in.ior) out->ior = out->own_ior = f(*in.ior);
  out->anisotropy = f(in.anisotropy);
  out->anisotropy_rotation = f(in.anisotropy_rotation);
  out->transmission_weight = f(in.transmission_weight);
  out->transmission_color = color_of(in.transmission_color);
  out->transmission_depth = f(in.transmission_depth);
  out->thin_walled = in.thin_walled;
  out->subsurface_weight = f(in.subsurface_weight);
  out->subsurface_color = color_of(in.subsurface_color);
  out->coat_weight = f(in.coat_weight);
  out->coat_roughness = f(in.coat_roughness);
  out->coat_ior = f(in.coat_ior);
  out->coat_color = color_of(in.coat_color);
  out->fuzz_weight = f(in.fuzz_weight);
  out->fuzz_roughness = f(in.fuzz_roughness);
  out->fuzz_color = color_of(in.fuzz_color);
  out->pattern = pattern;
  out->wear = wear;
  out->wetness = f(in.wetness);
  out->porosity = f(in.porosity);
  out->dust = f(in.dust);
  out->snow = f(in.snow);
}

}  // namespace

Status author_materials(const std::vector<MaterialOptions>& options, RenderDescription* out) {
  // An exact name beats a pattern, a later table an earlier one.
  std::vector<const MaterialOptions*> order;
  for (const bool exact : {false, true}) {
    for (const MaterialOptions& o : options) {
      if ((o.name.find('*') == std::string::npos) == exact) order.push_back(&o);
    }
  }
  for (const MaterialOptions* o : order) {
    const auto row_of = [&](const std::optional<PatternOptions>& p) {
      if (!p) return -1;
      out->procedurals.push_back(pattern_of(*p));
      return static_cast<int>(out->procedurals.size()) - 1;
    };
    const int pattern = row_of(o->pattern), wear = row_of(o->wear);
    bool found = false;
    for (MaterialDescription& material : out->materials) {
      if (material.name.empty() || !fits(o->name, material.name)) continue;
      apply(*o, pattern, wear, &material);
      found = true;
    }
    if (found) continue;
    std::vector<std::string> names;
    for (const MaterialDescription& material : out->materials) names.push_back(material.name);
    return Error{ErrorKind::kInput, fmt::format("no material '{}' is drawn in this scene", o->name),
                 o->loc, suggest_name(o->name, names)};
  }
  return {};
}

}  // namespace gloam
