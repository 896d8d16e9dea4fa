// glTF whose values, keys and lists are damaged, but not its JSON: damage behind the parser.

#include <gtest/gtest.h>

#include "base/test/json_mutator.h"
#include "geometry/gltf/json_node.h"
#include "geometry/test/glb_mutator.h"
#include "geometry/test/gltf_builder.h"
#include "geometry/test/largest_request.h"
#include "geometry/test/read_helper.h"

namespace gloam {
namespace {

// A skinned, instanced, textured and painted triangle, and a lamp.
GltfBuilder seed_file() {
  GltfBuilder file;
  const std::vector<Vec3f> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const int p = file.add_positions(corners);
  const int joints = file.add_accessor(std::vector<uint8_t>(12, 1), "VEC4", 5121, 3);
  const int weights = file.add_accessor(std::vector<float>(12, 0.25f), "VEC4", 5126, 3);
  const int color = file.add_accessor(
      std::vector<uint8_t>{255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9}, "VEC4", 5121, 3, true);
  std::vector<float> matrices(32, 0);
  for (const size_t i : {0, 5, 10, 15, 16, 21, 26, 31}) matrices[i] = 1;
  const int bind = file.add_accessor(matrices, "MAT4", 5126, 2);
  const int shift = file.add_positions({{0, 0, 0}, {5, 0, 0}});
  const int skinned = file.add_mesh(
      {{"attributes",
        {{"POSITION", p}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}, {"COLOR_0", color}}}});
  const int plain =
      file.add_mesh({{"attributes", {{"POSITION", p}, {"NORMAL", p}}}, {"material", 0}});
  file.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 1}}, {"roughnessFactor", 0.5}}},
       {"alphaMode", "MASK"}}};
  file.json["skins"] = {{{"joints", {2, 3}}, {"inverseBindMatrices", bind}}};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  file.json["nodes"] = {
      {{"mesh", skinned}, {"skin", 0}},
      {{"mesh", plain},
       {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", shift}}}}}}}},
      {{"name", "hip"}, {"scale", {0.01, 0.01, 0.01}}, {"children", {3}}},
      {{"name", "knee"}, {"rotation", {0, 0, 0, 1}}},
      {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  file.json["scenes"] = {{{"nodes", {0, 1, 2, 4}}}};
  return file;
}

void expect_answers(const std::string& seed, const std::string& name,
                    std::string (*mutate)(const std::string&, uint64_t)) {
  ModelFileOptions options;
  options.limits.decoded_bytes = 16 << 20;
  ASSERT_TRUE(read_text(seed, name, options).ok()) << error_of(read_text(seed, name, options));
  const size_t count = mutation_count();
  size_t refused = 0, unparsed = 0;
  for (size_t i = 0; i < count; ++i) {
    const std::string file = mutate(seed, i);
    largest_request = 0;
    const Result<ModelFile> model = read_text(file, name, options);
    ASSERT_LT(largest_request, size_t{16} << 20) << "file " << i;
    if (model.ok()) continue;
    ++refused;
    const std::string told = error_of(model);
    ASSERT_EQ(told.find('\n'), std::string::npos) << "file " << i << ": " << told;
    unparsed += told.find("JSON") != std::string::npos || told.find("GLB") != std::string::npos;
  }
  testing::Test::RecordProperty("past the parser", std::to_string(count - unparsed));
  testing::Test::RecordProperty("read to the end", std::to_string(count - refused));
  EXPECT_LT(unparsed, count / 20) << "the mutants are no longer " << name;
  EXPECT_GT(refused, count / 10) << "no harm is done";
  EXPECT_LT(refused, count * 9 / 10) << "hardly a file is read to its end";
}

TEST(StructureMutations, GltfDoesNoHarm) {
  expect_answers(seed_file().gltf(), "mutated.gltf", mutate_json);
}

TEST(StructureMutations, GlbDoesNoHarm) {
  expect_answers(seed_file().glb(), "mutated.glb", mutate_glb);
}

}  // namespace
}  // namespace gloam
