#include "world/materials/authored_material.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "geometry/image/image_file.h"
#include "scene/options/pattern_names.h"

namespace gloam {
namespace {

constexpr float kBumpScale = 1e-3f;  // [m] unless given

Vec3f color_of(const Vec3& c) {
  return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
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

/// Rows of RenderDescription::textures that a table brings.
struct OwnTextures {
  int bump = -1, coat_weight = -1, coat_roughness = -1, transmission = -1;
};

Result<int> add_texture(const std::filesystem::path& file, RenderDescription* out) {
  if (file.empty()) return -1;
  GLOAM_TRY(Image8 image, read_image(file));
  image.color_space = ColorSpace::kLinear;
  out->textures.push_back({file.filename().string(), {std::move(image)}});
  return static_cast<int>(out->textures.size()) - 1;
}

Result<OwnTextures> add_textures(const MaterialOptions& in, RenderDescription* out) {
  OwnTextures own;
  GLOAM_TRY(own.bump, add_texture(in.bump, out));
  GLOAM_TRY(own.coat_weight, add_texture(in.coat_weight_map, out));
  GLOAM_TRY(own.coat_roughness, add_texture(in.coat_roughness_map, out));
  GLOAM_TRY(own.transmission, add_texture(in.transmission_weight_map, out));
  return own;
}

bool has_own_texture(const MaterialOptions& in) {
  return !(in.bump.empty() && in.coat_weight_map.empty() && in.coat_roughness_map.empty() &&
           in.transmission_weight_map.empty());
}

void apply(const MaterialOptions& in, int pattern, int wear, const OwnTextures& own,
           MaterialDescription* out) {
  const auto number = [](const std::optional<double>& from, float* to) {
    if (from) *to = static_cast<float>(*from);
  };
  const auto color = [](const std::optional<Vec3>& from, Vec3f* to) {
    if (from) *to = color_of(*from);
  };
  color(in.base_color, &out->base_color);
  number(in.metallic, &out->metallic);
  number(in.roughness, &out->roughness);
  color(in.emission, &out->emission);
  number(in.ior, &out->ior);
  number(in.ior, &out->own_ior);
  number(in.anisotropy, &out->anisotropy);
  number(in.anisotropy_rotation, &out->anisotropy_rotation);
  number(in.transmission_weight, &out->transmission_weight);
  color(in.transmission_color, &out->transmission_color);
  number(in.transmission_depth, &out->transmission_depth);
  if (in.thin_walled) out->thin_walled = *in.thin_walled;
  number(in.subsurface_weight, &out->subsurface_weight);
  color(in.subsurface_color, &out->subsurface_color);
  number(in.coat_weight, &out->coat_weight);
  number(in.coat_roughness, &out->coat_roughness);
  number(in.coat_ior, &out->coat_ior);
  color(in.coat_color, &out->coat_color);
  number(in.coat_darkening, &out->coat_darkening);
  number(in.fuzz_weight, &out->fuzz_weight);
  number(in.fuzz_roughness, &out->fuzz_roughness);
  color(in.fuzz_color, &out->fuzz_color);
  if (pattern >= 0) out->pattern = pattern;
  if (wear >= 0) out->wear = wear;
  number(in.wetness, &out->wetness);
  number(in.porosity, &out->porosity);
  number(in.dust, &out->dust);
  number(in.snow, &out->snow);
  if (has_own_texture(in)) out->mapping = TextureMapping::kUv;
  if (own.bump >= 0) {
    out->textures.bump = own.bump;
    out->bump_scale = kBumpScale;
  }
  if (own.coat_weight >= 0) out->textures.coat_weight = own.coat_weight;
  if (own.coat_roughness >= 0) out->textures.coat_roughness = own.coat_roughness;
  if (own.transmission >= 0) out->textures.transmission = own.transmission;
  number(in.bump_scale, &out->bump_scale);
}

/// Reason why the table cannot be applied to a material, or "".
std::string why_not(const MaterialOptions& in, const MaterialDescription& material) {
  if (!material.imported && (in.base_color || in.metallic || in.roughness || in.emission))
    return "comes from the model: set its colour, metalness, roughness and emission there";
  if (has_own_texture(in) && material.mapping == TextureMapping::kCube)
    return "has a cube texture, which cannot be combined with a bump map or layer maps";
  return {};
}

}  // namespace

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
    GLOAM_TRY(const OwnTextures own, add_textures(*o, out));
    bool found = false;
    for (MaterialDescription& material : out->materials) {
      if (material.name.empty() || !fits_pattern(o->name, material.name)) continue;
      if (const std::string why = why_not(*o, material); !why.empty())
        return Error{ErrorKind::kInput, fmt::format("material '{}' {}", material.name, why),
                     o->loc};
      apply(*o, pattern, wear, own, &material);
      found = true;
    }
    if (found) continue;
    std::vector<std::string> names;
    for (const MaterialDescription& material : out->materials) names.push_back(material.name);
    return Error{ErrorKind::kInput, fmt::format("no material '{}' is used in this scene", o->name),
                 o->loc, suggest_name(o->name, names)};
  }
  return {};
}

}  // namespace gloam
