// Materials of glTF, each extension alone and value by value.

#include <gmock/gmock.h>

#include "geometry/test/gltf_builder.h"
#include "geometry/test/read_helper.h"

namespace gloam {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// The file has two pictures, a texture of each; the second has a sampler.
Result<ModelFile> read_material(const json& material) {
  GltfBuilder file;
  file.add_triangle();
  file.json["images"] = {{{"uri", "data:image/png;base64,AAEC"}},
                         {{"bufferView", 0}, {"mimeType", "image/png"}, {"name", "second"}}};
  file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  file.json["textures"] = {{{"source", 0}}, {{"source", 1}, {"sampler", 0}}};
  file.json["materials"] = json::array({material});
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  return read_text(file.glb(), "test.glb");
}

ImportedMaterial read_ok(const json& material) {
  const Result<ModelFile> model = read_material(material);
  EXPECT_TRUE(model.ok()) << error_of(model);
  if (!model.ok()) return {};
  EXPECT_EQ(model->instances.at(0).material, 0);
  return model->materials.at(0);
}

ImportedMaterial read_extension(const char* name, const json& value) {
  return read_ok({{"extensions", {{name, value}}}});
}

TEST(GltfMaterial, AnEmptyOneHasTheStandardsDefaults) {
  const ImportedMaterial m = read_ok(json::object());
  EXPECT_EQ(m.base_color, (Vec3f{1, 1, 1}));
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.specular_weight, 1);
  EXPECT_EQ(m.transmission_weight, 0);
  EXPECT_EQ(m.coat_weight, 0);
  EXPECT_EQ(m.fuzz_weight, 0);
  EXPECT_EQ(m.emission, (Vec3f{0, 0, 0}));
  EXPECT_EQ(m.alpha_mode, AlphaMode::kOpaque);
  EXPECT_FALSE(m.base_color_texture.ok());
  EXPECT_FALSE(m.double_sided || m.thin_walled || m.unlit);
}

TEST(GltfMaterial, TheCoreIsReadWithItsTextures) {
  const ImportedMaterial m = read_ok({{"name", "paint"},
                                      {"pbrMetallicRoughness",
                                       {{"baseColorFactor", {0.25, 0.5, 0.75, 0.5}},
                                        {"baseColorTexture", {{"index", 1}, {"texCoord", 1}}},
                                        {"metallicFactor", 0.25},
                                        {"roughnessFactor", 0.125},
                                        {"metallicRoughnessTexture", {{"index", 0}}}}},
                                      {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                                      {"occlusionTexture", {{"index", 0}, {"strength", 0.75}}},
                                      {"emissiveFactor", {1, 0.5, 0}},
                                      {"emissiveTexture", {{"index", 1}}},
                                      {"alphaMode", "MASK"},
                                      {"alphaCutoff", 0.75},
                                      {"doubleSided", true}});
  EXPECT_EQ(m.name, "paint");
  EXPECT_EQ(m.base_color, (Vec3f{0.25f, 0.5f, 0.75f}));
  EXPECT_EQ(m.opacity, 0.5f);
  EXPECT_EQ(m.metallic, 0.25f);
  EXPECT_EQ(m.roughness, 0.125f);
  EXPECT_EQ(m.normal_scale, 0.5f);
  EXPECT_EQ(m.occlusion_strength, 0.75f);
  EXPECT_EQ(m.emission, (Vec3f{1, 0.5f, 0}));
  EXPECT_EQ(m.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(m.alpha_cutoff, 0.75f);
  EXPECT_TRUE(m.double_sided);
  const TextureRef color{1,  TextureChannel::kColor, ColorSpace::kSrgb,    1,
                         {}, TextureWrap::kClamp,    TextureWrap::kMirror, true};
  EXPECT_EQ(m.base_color_texture, color);
  TextureRef opacity = color;
  opacity.channel = TextureChannel::kAlpha;
  opacity.color_space = ColorSpace::kLinear;
  EXPECT_EQ(m.opacity_texture, opacity);
  EXPECT_EQ(m.metallic_texture, (TextureRef{0, TextureChannel::kBlue, ColorSpace::kLinear}));
  EXPECT_EQ(m.roughness_texture, (TextureRef{0, TextureChannel::kGreen, ColorSpace::kLinear}));
  EXPECT_EQ(m.normal_texture, (TextureRef{0, TextureChannel::kColor, ColorSpace::kLinear}));
  EXPECT_EQ(m.occlusion_texture, (TextureRef{0, TextureChannel::kRed, ColorSpace::kLinear}));
  EXPECT_EQ(m.emission_texture.color_space, ColorSpace::kSrgb);
}

TEST(GltfMaterial, ExtensionsFillTheirOwnValues) {
  ImportedMaterial m = read_extension("KHR_materials_clearcoat",
                                      {{"clearcoatFactor", 0.5},
                                       {"clearcoatTexture", {{"index", 0}}},
                                       {"clearcoatRoughnessFactor", 0.25},
                                       {"clearcoatRoughnessTexture", {{"index", 0}}},
                                       {"clearcoatNormalTexture", {{"index", 0}, {"scale", 2}}}});
  EXPECT_EQ(m.coat_weight, 0.5f);
  EXPECT_EQ(m.coat_roughness, 0.25f);
  EXPECT_EQ(m.coat_weight_texture.channel, TextureChannel::kRed);
  EXPECT_EQ(m.coat_roughness_texture.channel, TextureChannel::kGreen);
  EXPECT_EQ(m.coat_normal_texture.image, 0);
  EXPECT_EQ(m.coat_normal_scale, 2);

  m = read_extension("KHR_materials_transmission",
                     {{"transmissionFactor", 0.75}, {"transmissionTexture", {{"index", 0}}}});
  EXPECT_EQ(m.transmission_weight, 0.75f);
  EXPECT_EQ(m.transmission_texture.channel, TextureChannel::kRed);
  EXPECT_TRUE(m.thin_walled);

  m = read_ok({{"extensions",
                {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                 {"KHR_materials_volume",
                  {{"thicknessFactor", 0.5},
                   {"attenuationColor", {0.5, 0.25, 1}},
                   {"attenuationDistance", 0.125}}}}}});
  EXPECT_FALSE(m.thin_walled);
  EXPECT_EQ(m.transmission_color, (Vec3f{0.5f, 0.25f, 1}));
  EXPECT_EQ(m.transmission_depth, 0.125f);

  EXPECT_EQ(read_extension("KHR_materials_ior", {{"ior", 1.25}}).ior, 1.25f);
  m = read_extension("KHR_materials_specular", {{"specularFactor", 0.5},
                                                {"specularTexture", {{"index", 0}}},
                                                {"specularColorFactor", {2, 1, 0.5}},
                                                {"specularColorTexture", {{"index", 0}}}});
  EXPECT_EQ(m.specular_weight, 0.5f);
  EXPECT_EQ(m.specular_color, (Vec3f{2, 1, 0.5f}));
  EXPECT_EQ(m.specular_weight_texture.channel, TextureChannel::kAlpha);
  EXPECT_EQ(m.specular_color_texture.color_space, ColorSpace::kSrgb);

  m = read_extension("KHR_materials_sheen",
                     {{"sheenColorFactor", {0.5, 0.25, 0.125}}, {"sheenRoughnessFactor", 0.75}});
  EXPECT_EQ(m.fuzz_weight, 1);
  EXPECT_EQ(m.fuzz_color, (Vec3f{0.5f, 0.25f, 0.125f}));
  EXPECT_EQ(m.fuzz_roughness, 0.75f);

  m = read_extension("KHR_materials_anisotropy",
                     {{"anisotropyStrength", 0.5}, {"anisotropyRotation", 1.25}});
  EXPECT_EQ(m.anisotropy, 0.5f);
  EXPECT_EQ(m.anisotropy_rotation, 1.25f);

  EXPECT_TRUE(read_extension("KHR_materials_unlit", json::object()).unlit);
  m = read_ok({{"emissiveFactor", {1, 0.5, 0}},
               {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 500}}}}}});
  EXPECT_EQ(m.emission, (Vec3f{500, 250, 0}));
}

TEST(GltfMaterial, TextureTransformsActAsTheStandardSays) {
  const ImportedMaterial m = read_ok({{"pbrMetallicRoughness",
                                       {{"baseColorTexture",
                                         {{"index", 0},
                                          {"extensions",
                                           {{"KHR_texture_transform",
                                             {{"offset", {0.5, 0.25}},
                                              {"rotation", 0.5},
                                              {"scale", {2, 3}},
                                              {"texCoord", 1}}}}}}}}}});
  const TextureRef& t = m.base_color_texture;
  EXPECT_EQ(t.uv_set, 1);
  EXPECT_EQ(t.transform.offset, (Vec2f{0.5f, 0.25f}));
  EXPECT_EQ(t.transform.rotation, 0.5f);
  EXPECT_EQ(t.transform.scale, (Vec2f{2, 3}));
  // KHR_texture_transform: translation * rotation * scale with rotation = (c s; -s c), on the
  // file's own uv, whose v grows downwards.
  const float u = 0.3f, v = 0.6f, c = std::cos(0.5f), s = std::sin(0.5f);
  const Vec2f file_uv = {c * 2 * u + s * 3 * v + 0.5f, -s * 2 * u + c * 3 * v + 0.25f};
  const Vec2f uv = transform_uv(t.transform, {u, 1 - v});
  EXPECT_NEAR(uv.x, file_uv.x, 1e-6);
  EXPECT_NEAR(1 - uv.y, file_uv.y, 1e-6);
}

TEST(GltfMaterial, EmbeddedPicturesAreKeptAsTheyAre) {
  const Result<ModelFile> model = read_material(json::object());
  ASSERT_TRUE(model.ok()) << error_of(model);
  EXPECT_EQ(model->images.at(0).bytes, (std::vector<uint8_t>{0, 1, 2}));
  EXPECT_EQ(model->images.at(1).name, "second");
  EXPECT_EQ(model->images.at(1).bytes.size(), 36u);
}

TEST(GltfMaterial, ReferencesToNothingAreRefused) {
  EXPECT_THAT(error_of(read_material({{"normalTexture", {{"index", 2}}}})),
              HasSubstr("/materials/0/normalTexture/index: refers to texture 2, but there are 2"));
  EXPECT_THAT(error_of(read_material({{"normalTexture", json::object()}})),
              HasSubstr("is missing"));
  EXPECT_THAT(error_of(read_material({{"alphaMode", "GLASS"}})), HasSubstr("one of OPAQUE"));
  EXPECT_THAT(error_of(read_material({{"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}})),
              HasSubstr("must be 0 or at least 1"));
}

}  // namespace
}  // namespace gloam
