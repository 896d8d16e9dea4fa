// Materials of glTF 2.0 and its ratified KHR_materials_* extensions in OpenPBR's terms.

#include <fmt/format.h>

#include <algorithm>

#include "base/path_readings.h"
#include "geometry/gltf/document.h"

namespace gloam {
namespace {

// Parts of a texture that a material uses.
struct TextureUse {
  TextureChannel channel = TextureChannel::kColor;
  ColorSpace color_space = ColorSpace::kLinear;
};
constexpr TextureUse kSrgbColor{TextureChannel::kColor, ColorSpace::kSrgb};
constexpr TextureUse kLinearColor{};
constexpr TextureUse kRed{TextureChannel::kRed}, kGreen{TextureChannel::kGreen},
    kBlue{TextureChannel::kBlue}, kAlpha{TextureChannel::kAlpha};

TextureWrap wrap_of(const JsonNode& node) {
  switch (node.integer(10497, 1 << 16)) {  // the numbers are OpenGL's
    case 33071:
      return TextureWrap::kClamp;
    case 33648:
      return TextureWrap::kMirror;
    case 10497:
      return TextureWrap::kRepeat;
    default:
      node.fail("must be one of 10497, 33071, 33648");
      return TextureWrap::kRepeat;
  }
}

class MaterialReader {
 public:
  MaterialReader(GltfDocument* document, ModelFile* model) : document_(document), model_(model) {}

  ImportedMaterial read(const JsonNode& node) const {
    ImportedMaterial out;
    out.name = node["name"].text().substr(0, kMaxName);
    read_core(node, &out);
    const JsonNode extensions = node["extensions"];
    read_surface(extensions, &out);
    read_layers(extensions, &out);
    read_volume(extensions, &out);
    out.unlit = extensions["KHR_materials_unlit"].exists();
    const float strength =
        extensions["KHR_materials_emissive_strength"]["emissiveStrength"].number(1, 0);  // [cd/m²]
    out.emission = out.emission * strength;
    return out;
  }

 private:
  TextureRef texture(const JsonNode& info, TextureUse use) const {
    TextureRef out;
    if (!info.exists()) return out;
    const JsonNode textures = document_->root()["textures"];
    const int index = info["index"].required_index(textures.size(), "texture");
    if (index < 0) return out;
    const JsonNode texture = textures.at(static_cast<size_t>(index));
    if (!texture["source"].exists()) {
      add_note(model_, fmt::format("{}: the image format of the texture is not supported",
                                   texture.pointer()));
      return out;
    }
    out.image = texture["source"].index(model_->images.size(), "image");
    out.channel = use.channel;
    out.color_space = use.color_space;
    out.uv_set = static_cast<int>(info["texCoord"].integer(0, 1));
    const JsonNode samplers = document_->root()["samplers"];
    if (const int s = texture["sampler"].index(samplers.size(), "sampler"); s >= 0) {
      const JsonNode sampler = samplers.at(static_cast<size_t>(s));
      out.wrap_u = wrap_of(sampler["wrapS"]);
      out.wrap_v = wrap_of(sampler["wrapT"]);
      out.nearest = sampler["magFilter"].integer(9729, 1 << 16) == 9728;
    }
    const JsonNode transform = info["extensions"]["KHR_texture_transform"];
    if (!transform.exists()) return out;
    float v[2];
    if (transform["offset"].numbers(v, 2)) out.transform.offset = {v[0], v[1]};
    if (transform["scale"].numbers(v, 2)) out.transform.scale = {v[0], v[1]};
    out.transform.rotation = transform["rotation"].number(0);
    if (transform["texCoord"].exists())
      out.uv_set = static_cast<int>(transform["texCoord"].integer(0, 1));
    return out;
  }

  void read_core(const JsonNode& node, ImportedMaterial* out) const {
    const JsonNode pbr = node["pbrMetallicRoughness"];
    float color[4];
    if (pbr["baseColorFactor"].numbers(color, 4)) {
      for (size_t i = 0; i < 4; ++i) (void)pbr["baseColorFactor"].at(i).number(0, 0, 1);
      out->base_color = {color[0], color[1], color[2]};
      out->opacity = color[3];
    }
    out->base_color_texture = texture(pbr["baseColorTexture"], kSrgbColor);
    out->metallic = pbr["metallicFactor"].number(1, 0, 1);
    out->metallic_texture = texture(pbr["metallicRoughnessTexture"], kBlue);
    out->roughness = pbr["roughnessFactor"].number(1, 0, 1);
    out->roughness_texture = texture(pbr["metallicRoughnessTexture"], kGreen);
    out->normal_texture = texture(node["normalTexture"], kLinearColor);
    out->normal_scale = node["normalTexture"]["scale"].number(1);
    out->occlusion_texture = texture(node["occlusionTexture"], kRed);
    out->occlusion_strength = node["occlusionTexture"]["strength"].number(1, 0, 1);
    out->emission = node["emissiveFactor"].vec3({0, 0, 0}, 0);
    out->emission_texture = texture(node["emissiveTexture"], kSrgbColor);
    out->double_sided = node["doubleSided"].flag(false);
    const std::string mode = node["alphaMode"].text("OPAQUE");
    if (mode == "MASK") out->alpha_mode = AlphaMode::kMask;
    if (mode == "BLEND") out->alpha_mode = AlphaMode::kBlend;
    if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
      node["alphaMode"].fail("must be one of OPAQUE, MASK, BLEND");
    out->alpha_cutoff = node["alphaCutoff"].number(0.5f, 0);
    if (out->alpha_mode != AlphaMode::kOpaque)
      out->opacity_texture = texture(pbr["baseColorTexture"], kAlpha);
  }

  void read_surface(const JsonNode& extensions, ImportedMaterial* out) const {
    const JsonNode ior = extensions["KHR_materials_ior"]["ior"];
    out->ior = ior.number(1.5f, 0);
    if (out->ior != 0 && out->ior < 1) ior.fail("must be 0 or at least 1");
    const JsonNode specular = extensions["KHR_materials_specular"];
    out->specular_weight = specular["specularFactor"].number(1, 0, 1);
    out->specular_weight_texture = texture(specular["specularTexture"], kAlpha);
    out->specular_color = specular["specularColorFactor"].vec3({1, 1, 1}, 0);
    out->specular_color_texture = texture(specular["specularColorTexture"], kSrgbColor);
    const JsonNode anisotropy = extensions["KHR_materials_anisotropy"];
    out->anisotropy = anisotropy["anisotropyStrength"].number(0, 0, 1);
    out->anisotropy_rotation = anisotropy["anisotropyRotation"].number(0);
    out->anisotropy_texture = texture(anisotropy["anisotropyTexture"], kLinearColor);
  }

  void read_layers(const JsonNode& extensions, ImportedMaterial* out) const {
    const JsonNode coat = extensions["KHR_materials_clearcoat"];
    out->coat_weight = coat["clearcoatFactor"].number(0, 0, 1);
    out->coat_weight_texture = texture(coat["clearcoatTexture"], kRed);
    out->coat_roughness = coat["clearcoatRoughnessFactor"].number(0, 0, 1);
    out->coat_roughness_texture = texture(coat["clearcoatRoughnessTexture"], kGreen);
    out->coat_normal_texture = texture(coat["clearcoatNormalTexture"], kLinearColor);
    out->coat_normal_scale = coat["clearcoatNormalTexture"]["scale"].number(1);
    const JsonNode sheen = extensions["KHR_materials_sheen"];
    if (!sheen.exists()) return;
    out->fuzz_color = sheen["sheenColorFactor"].vec3({0, 0, 0}, 0, 1);
    out->fuzz_weight = max_component(out->fuzz_color) > 0 ? 1.0f : 0.0f;
    out->fuzz_color_texture = texture(sheen["sheenColorTexture"], kSrgbColor);
    out->fuzz_roughness = sheen["sheenRoughnessFactor"].number(0, 0, 1);
    out->fuzz_roughness_texture = texture(sheen["sheenRoughnessTexture"], kAlpha);
  }

  void read_volume(const JsonNode& extensions, ImportedMaterial* out) const {
    const JsonNode transmission = extensions["KHR_materials_transmission"];
    out->transmission_weight = transmission["transmissionFactor"].number(0, 0, 1);
    out->transmission_texture = texture(transmission["transmissionTexture"], kRed);
    const JsonNode volume = extensions["KHR_materials_volume"];
    const float thickness = volume["thicknessFactor"].number(0, 0);
    out->thin_walled = transmission.exists() && thickness == 0;
    out->transmission_color = volume["attenuationColor"].vec3({1, 1, 1}, 0, 1);
    out->transmission_depth = volume["attenuationDistance"].number(0, 0);
  }

  GltfDocument* document_;
  ModelFile* model_;
};

}  // namespace

void read_gltf_images(GltfDocument* document, ModelFile* model) {
  const JsonNode images = document->root()["images"];
  for (size_t i = 0; i < images.size() && document->errors().ok(); ++i) {
    const JsonNode image = images.at(i);
    ImportedImage out;
    out.name = image["name"].text().substr(0, kMaxName);
    if (image["uri"].exists()) {
      const std::string uri = image["uri"].text();
      if (out.name.empty() && !uri.starts_with("data:"))
        out.name = decode_percent(uri).substr(0, kMaxName);
      Result<std::vector<uint8_t>> bytes = document->fetch(uri, image.pointer());
      if (!bytes.ok()) return document->errors().add(std::move(bytes).error());
      out.bytes = std::move(*bytes);
    } else {
      const JsonNode views = document->root()["bufferViews"];
      const int view = image["bufferView"].required_index(views.size(), "buffer view");
      if (view < 0) return;
      const std::span<const uint8_t> bytes = document->view(view);
      out.bytes.assign(bytes.begin(), bytes.end());
    }
    if (!document->budget().take(out.bytes.size(), 1))
      return image.fail("makes the model exceed the size limit when decoded", "use smaller images");
    model->images.push_back(std::move(out));
  }
}

void read_gltf_materials(GltfDocument* document, ModelFile* model) {
  const JsonNode materials = document->root()["materials"];
  const uint64_t limit = document->source().options->limits.materials;
  if (materials.size() > limit)
    materials.fail(fmt::format("there are more than {} materials", limit));
  const MaterialReader reader(document, model);
  for (size_t i = 0; i < materials.size() && document->errors().ok(); ++i)
    model->materials.push_back(reader.read(materials.at(i)));
}

}  // namespace gloam
