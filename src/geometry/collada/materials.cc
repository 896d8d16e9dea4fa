// Effects of COLLADA's common profile (<phong>, <blinn>, <lambert>, <constant>) in OpenPBR's terms.
// Colours are what a display shows, as viewers of these files take them: sRGB. Shininess is Phong's
// or Blinn's exponent n: alpha² = 2 / (n + 2), roughness = sqrt(alpha).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/path_readings.h"
#include "base/srgb.h"
#include "geometry/collada/document.h"

namespace gloam {
namespace {

constexpr float kEmissionOfOne = 100;  // [cd/m²], as of MTL's Ke

Vec3f color_of(const std::vector<float>& rgb) {
  const auto decode = [](float v) { return srgb_decode(std::clamp(v, 0.0f, 1.0f)); };
  return {decode(rgb[0]), decode(rgb[1]), decode(rgb[2])};
}

class EffectReader {
 public:
  EffectReader(ColladaDocument* document, const pugi::xml_node& effect, ModelFile* model)
      : document_(document), effect_(effect), model_(model) {
    profile_ = effect.child("profile_COMMON");
  }

  Result<ImportedMaterial> read(const std::string& name) {
    ImportedMaterial out;
    out.name = name.substr(0, kMaxName);
    out.double_sided = true;  // the common profile has no sides
    const pugi::xml_node technique = profile_.child("technique");
    pugi::xml_node shader;
    for (const char* kind : {"phong", "blinn", "lambert", "constant"})
      if (!shader) shader = technique.child(kind);
    if (!shader) {
      add_note(
          model_,
          fmt::format("the effect of material '{:.80}' has an unsupported shading model", name));
      return out;
    }
    std::vector<float> color;
    GLOAM_TRY_STATUS(read_color(shader.child("diffuse"), &color, &out.base_color_texture));
    if (color.size() >= 3) out.base_color = color_of(color);
    if (color.size() >= 4) out.opacity = std::clamp(color[3], 0.0f, 1.0f);
    GLOAM_TRY_STATUS(read_color(shader.child("emission"), &color, &out.emission_texture));
    if (color.size() >= 3) out.emission = color_of(color) * kEmissionOfOne;
    if (out.emission_texture.ok()) out.emission = {kEmissionOfOne, kEmissionOfOne, kEmissionOfOne};
    GLOAM_TRY_STATUS(read_specular(shader, &out));
    GLOAM_TRY_STATUS(read_transparency(shader, &out));
    if (std::string_view(shader.name()) == "constant" && !shader.child("diffuse")) {
      out.base_color = {0, 0, 0};
      out.specular_weight = 0;
    }
    return out;
  }

 private:
  Status read_specular(const pugi::xml_node& shader, ImportedMaterial* out) {
    const pugi::xml_node specular = shader.child("specular");
    std::vector<float> color;
    TextureRef unused;
    if (const pugi::xml_node texture = specular.child("texture"); !texture)
      GLOAM_TRY_STATUS(read_color(specular, &color, &unused));
    if (std::string_view(shader.name()) == "lambert" ||
        (color.size() >= 3 && std::max({color[0], color[1], color[2]}) <= 0))
      out->specular_weight = 0;
    float exponent = 0;
    GLOAM_TRY(const bool has_exponent, read_float(shader.child("shininess"), &exponent));
    if (!has_exponent) return {};
    // Some programs write Blinn's exponent as a fraction of 128.
    if (exponent > 0 && exponent <= 1) exponent *= 128;
    out->roughness = std::pow(2 / (std::max(exponent, 0.0f) + 2), 0.25f);
    return {};
  }

  // The specification's 7.1.1: A_ONE takes the transparent colour's alpha, RGB_ZERO one minus its
  // luminance, times the transparency. Programs that write A_ONE with a transparency of 0 for what
  // is opaque (old SketchUp, Google Earth) would make the whole model vanish: it is drawn.
  Status read_transparency(const pugi::xml_node& shader, ImportedMaterial* out) {
    const pugi::xml_node transparent = shader.child("transparent");
    float transparency = 1;
    GLOAM_TRY(const bool has_number, read_float(shader.child("transparency"), &transparency));
    transparency = std::clamp(transparency, 0.0f, 1.0f);
    std::vector<float> color;
    TextureRef texture;
    GLOAM_TRY_STATUS(read_color(transparent, &color, &texture));
    const std::string_view mode = transparent.attribute("opaque").as_string("A_ONE");
    float opacity = 1;
    if (color.size() >= 3 && mode.starts_with("RGB")) {
      const float light = luminance(Vec3f{color[0], color[1], color[2]}) * transparency;
      opacity = mode == "RGB_ONE" ? light : 1 - light;
    } else if (color.size() >= 4) {
      const float alpha = color[3] * transparency;
      opacity = mode == "A_ZERO" ? 1 - alpha : alpha;
    } else if (has_number && !texture.ok()) {
      opacity = transparency;
    }
    if (!(opacity > 0)) opacity = 1;
    out->opacity *= std::clamp(opacity, 0.0f, 1.0f);
    if (texture.ok()) {
      texture.channel = mode.starts_with("RGB") ? TextureChannel::kRed : TextureChannel::kAlpha;
      texture.color_space = ColorSpace::kLinear;
      out->opacity_texture = texture;
    }
    if (out->opacity < 1 || texture.ok()) out->alpha_mode = AlphaMode::kBlend;
    return {};
  }

  Result<bool> read_float(const pugi::xml_node& node, float* out) {
    pugi::xml_node number = node.child("float");
    if (const pugi::xml_node param = node.child("param"))
      number = find_param(param.attribute("ref").value()).child("float");
    if (!number) return false;
    std::vector<float> values;
    GLOAM_TRY_STATUS(document_->read_floats(number, &values));
    if (values.empty() || !std::isfinite(values[0])) return false;
    *out = values[0];
    return true;
  }

  pugi::xml_node find_param(std::string_view sid) const {
    for (const pugi::xml_node& scope : {profile_.child("technique"), profile_, effect_})
      for (const pugi::xml_node& param : scope.children("newparam"))
        if (param.attribute("sid").value() == sid) return param;
    return {};
  }

  Status read_color(const pugi::xml_node& node, std::vector<float>* color, TextureRef* texture) {
    color->clear();
    if (const pugi::xml_node picture = node.child("texture")) return read_texture(picture, texture);
    pugi::xml_node plain = node.child("color");
    if (const pugi::xml_node param = node.child("param")) {
      const pugi::xml_node found = find_param(param.attribute("ref").value());
      plain = found.child("float4") ? found.child("float4") : found.child("float3");
    }
    if (!plain) return {};
    GLOAM_TRY_STATUS(document_->read_floats(plain, color));
    for (const float v : *color)
      if (!std::isfinite(v)) return document_->bad(plain, "is not finite");
    return {};
  }

  // <texture> names a sampler, that a surface, that an image; or an image at once.
  Status read_texture(const pugi::xml_node& picture, TextureRef* out) {
    std::string name = picture.attribute("texture").value();
    pugi::xml_node sampler = find_param(name).child("sampler2D");
    if (sampler) {
      name = sampler.child("source").text().get();
      if (const char* url = sampler.child("instance_image").attribute("url").value(); *url != 0)
        name = url;
      const pugi::xml_node surface = find_param(name).child("surface");
      if (surface) name = surface.child("init_from").text().get();
      out->wrap_u = wrap_named(sampler.child("wrap_s"));
      out->wrap_v = wrap_named(sampler.child("wrap_t"));
    }
    const pugi::xml_node image = document_->find(name);
    if (!image) {
      add_note(model_, fmt::format("image '{:.80}' is not defined", name));
      return {};
    }
    pugi::xml_node from = image.child("init_from");
    if (from.child("ref")) from = from.child("ref");  // 1.5
    out->color_space = ColorSpace::kSrgb;
    return find_image(image, from.text().get(), &out->image);
  }

  static TextureWrap wrap_named(const pugi::xml_node& node) {
    const std::string_view word = node.text().get();
    if (word == "CLAMP" || word == "BORDER" || word == "NONE") return TextureWrap::kClamp;
    return word == "MIRROR" ? TextureWrap::kMirror : TextureWrap::kRepeat;
  }

  Status find_image(const pugi::xml_node& place, std::string_view written, int* image) {
    while (!written.empty() && static_cast<unsigned char>(written.back()) <= ' ')
      written.remove_suffix(1);
    while (!written.empty() && static_cast<unsigned char>(written.front()) <= ' ')
      written.remove_prefix(1);
    std::string name = with_slashes(written);
    if (name.starts_with("file:///")) name = name.substr(7);
    if (name.starts_with("./")) name = name.substr(2);
    name = without_foreign_folder(name);
    const auto known = std::find_if(model_->images.begin(), model_->images.end(),
                                    [&](const ImportedImage& i) { return i.name == name; });
    if (known != model_->images.end()) {
      *image = static_cast<int>(known - model_->images.begin());
      return {};
    }
    const ModelSource& source = document_->source();
    if (source.folder == nullptr) {
      add_note(model_,
               fmt::format("image '{:.200}' was not loaded: the model has no folder", name));
      return {};
    }
    Result<std::vector<uint8_t>> bytes =
        source.folder->read(name, document_->loc_of(place), source.options->limits);
    if (!bytes.ok() && bytes.error().kind == ErrorKind::kIo) {
      add_note(model_, fmt::format("image '{:.200}' is missing", name));
      return {};
    }
    if (!bytes.ok()) return std::move(bytes).error();
    if (!document_->budget().take(bytes->size(), 1))
      return document_->bad(place, "exceeds the memory limit for images");
    *image = static_cast<int>(model_->images.size());
    model_->images.push_back({name, std::move(*bytes)});
    return {};
  }

  ColladaDocument* document_;
  const pugi::xml_node effect_;
  pugi::xml_node profile_;
  ModelFile* model_;
};

}  // namespace

Result<int> ColladaMaterials::row(const std::string& url) {
  const auto [known, is_new] = rows_.try_emplace(url, -1);
  if (!is_new) return known->second;
  const pugi::xml_node material = document_->find(url);
  if (!material) {
    add_note(model_, fmt::format("material '{:.80}' is not defined", url));
    return -1;
  }
  const pugi::xml_node effect =
      document_->find(material.child("instance_effect").attribute("url").value());
  if (model_->materials.size() >= document_->source().options->limits.materials)
    return document_->bad(material, "exceeds the limit on materials");
  std::string name = material.attribute("name").value();
  if (name.empty()) name = material.attribute("id").value();
  GLOAM_TRY(ImportedMaterial made, EffectReader(document_, effect, model_).read(name));
  known->second = static_cast<int>(model_->materials.size());
  model_->materials.push_back(std::move(made));
  return known->second;
}

}  // namespace gloam
