// Skins of glTF, drawn in the pose of the file's nodes.

#include <gmock/gmock.h>

#include "geometry/test/gltf_builder.h"
#include "geometry/test/read_helper.h"

namespace gloam {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::vector<Vec3f> kSkinnedTriangle = {{-50, 0, 0}, {50, 0, 0}, {0, 100, 0}};

// Column by column.
std::vector<float> scale_and_shift(float scale, Vec3f p) {
  return {scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, p.x, p.y, p.z, 1};
}

class GltfSkin : public ::testing::Test {
 protected:
  // A triangle whose vertices follow the joints in `joints`, of two for each vertex half each.
  int add_skinned_mesh(const std::vector<uint8_t>& joints, json more = json::object()) {
    std::vector<uint8_t> all;
    std::vector<float> weights;
    for (size_t i = 0; i < 3; ++i) {
      all.insert(all.end(), {joints[2 * i], joints[2 * i + 1], 0, 0});
      weights.insert(weights.end(), {0.5f, 0.5f, 0, 0});
    }
    more["POSITION"] = file_.add_positions(kSkinnedTriangle);
    more["JOINTS_0"] = file_.add_accessor(all, "VEC4", 5121, 3);
    more["WEIGHTS_0"] = file_.add_accessor(weights, "VEC4", 5126, 3);
    return file_.add_mesh({{"attributes", more}});
  }

  int add_skin(const std::vector<int>& joints, const std::vector<std::vector<float>>& matrices) {
    json skin = {{"joints", joints}};
    std::vector<float> all;
    for (const std::vector<float>& m : matrices) all.insert(all.end(), m.begin(), m.end());
    if (!all.empty())
      skin["inverseBindMatrices"] = file_.add_accessor(all, "MAT4", 5126, matrices.size());
    return file_.push("skins", skin);
  }

  ModelFile read() {
    Result<ModelFile> model = read_text(file_.gltf(), "test.gltf");
    EXPECT_TRUE(model.ok()) << error_of(model);
    return model.ok() ? std::move(*model) : ModelFile{};
  }

  // The corners of an instance in the file's frame: x, -z, y of glTF's.
  static std::vector<Vec3f> corners(const ModelFile& model, size_t instance) {
    const ImportedInstance& in = model.instances.at(instance);
    const TriangleMesh& mesh = model.meshes[static_cast<size_t>(in.mesh)];
    std::vector<Vec3f> out;
    for (const uint32_t i : mesh.indices)
      out.push_back(transform_point(in.X_FI, mesh.positions[i]));
    return out;
  }

  static void expect_near(const std::vector<Vec3f>& got, const std::vector<Vec3f>& wanted) {
    ASSERT_EQ(got.size(), wanted.size());
    for (size_t i = 0; i < got.size(); ++i)
      EXPECT_LT(max_component(abs(got[i] - wanted[i])), 1e-4f)
          << i << ": " << got[i].x << ' ' << got[i].y << ' ' << got[i].z;
  }
  static Vec3f abs(Vec3f v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

  GltfBuilder file_;
};

TEST_F(GltfSkin, FollowsTheJointsAndIgnoresThePlaceOfItsOwnNode) {
  const int mesh = add_skinned_mesh({0, 0, 0, 0, 0, 0});
  file_.push("nodes", {{"scale", {0.01, 0.01, 0.01}}, {"children", {1}}});  // centimetres
  file_.push("nodes", {{"translation", {0, 50, 0}}});
  file_.push("nodes", {{"mesh", mesh},
                       {"skin", add_skin({1}, {scale_and_shift(1, {0, -50, 0})})},
                       {"translation", {7, 7, 7}}});
  const ModelFile model = read();
  ASSERT_EQ(model.instances.size(), 1u);
  expect_near(corners(model, 0), {{-0.5f, 0, 0}, {0.5f, 0, 0}, {0, 0, 1}});
}

TEST_F(GltfSkin, TakesIdentityWhereNoMatricesAreGivenAndBlendsByWeights) {
  const int mesh = add_skinned_mesh({0, 0, 1, 1, 0, 1});
  file_.push("nodes", {{"translation", {0, 0, 2}}});
  file_.push("nodes", {{"translation", {0, 0, 4}}});
  file_.push("nodes", {{"mesh", mesh}, {"skin", add_skin({0, 1}, {})}});
  expect_near(corners(read(), 0), {{-50, -2, 0}, {50, -4, 0}, {0, -3, 100}});
}

TEST_F(GltfSkin, BendsASharedMeshByEachSkinOfItsNodes) {
  const int mesh = add_skinned_mesh({0, 0, 0, 0, 0, 0});
  file_.push("nodes", {{"translation", {1, 0, 0}}});
  file_.push("nodes", {{"scale", {2, 2, 2}}});
  file_.push("nodes", {{"mesh", mesh}, {"skin", add_skin({0}, {})}});
  file_.push("nodes", {{"mesh", mesh}, {"skin", add_skin({1}, {})}});
  file_.push("nodes", {{"mesh", mesh}});  // and once without: at its node
  const ModelFile model = read();
  ASSERT_EQ(model.instances.size(), 3u);
  expect_near(corners(model, 0), {{-49, 0, 0}, {51, 0, 0}, {1, 0, 100}});
  expect_near(corners(model, 1), {{-100, 0, 0}, {100, 0, 0}, {0, 0, 200}});
  expect_near(corners(model, 2), {{-50, 0, 0}, {50, 0, 0}, {0, 0, 100}});
}

TEST_F(GltfSkin, TurnsNormalsAndKeepsTheOutsideOut) {
  const int normals = file_.add_positions({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
  const int mesh = add_skinned_mesh({0, 0, 0, 0, 0, 0}, {{"NORMAL", normals}});
  file_.push("nodes", {{"scale", {-1, 1, 1}}});  // mirrored
  file_.push("nodes", {{"mesh", mesh}, {"skin", add_skin({0}, {})}});
  const ModelFile model = read();
  const std::vector<Vec3f> c = corners(model, 0);
  const Vec3f outside = cross(c[1] - c[0], c[2] - c[0]);
  EXPECT_LT(outside.y, 0);  // glTF's +z
  const TriangleMesh& bent = model.meshes[static_cast<size_t>(model.instances[0].mesh)];
  for (const Vec3f n : bent.normals) EXPECT_NEAR(n.y, -1, 1e-5f);
}

TEST_F(GltfSkin, KeepsVertexColours) {
  const std::vector<float> colors = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const int accessor = file_.add_accessor(colors, "VEC3", 5126, 3);
  const int mesh = add_skinned_mesh({0, 0, 1, 1, 1, 1}, {{"COLOR_0", accessor}});
  file_.push("nodes", {{"translation", {0, 0, 2}}});
  file_.push("nodes", {{"translation", {0, 0, 4}}});
  file_.push("nodes", {{"mesh", mesh}, {"skin", add_skin({0, 1}, {})}});
  const ModelFile model = read();
  expect_near(corners(model, 0), {{-50, -2, 0}, {50, -4, 0}, {0, -4, 100}});
  EXPECT_EQ(model.images.size(), 1u);
}

TEST_F(GltfSkin, RefusesJointsAndMatricesThatAreNotThere) {
  const int mesh = add_skinned_mesh({0, 3, 0, 0, 0, 0});
  file_.push("nodes", json::object());
  file_.push("nodes", {{"mesh", mesh}, {"skin", add_skin({0}, {})}});
  EXPECT_THAT(error_of(read_text(file_.gltf(), "a.gltf")),
              HasSubstr("refers to a joint that is out of range; there are 1"));
  file_.json["skins"][0]["joints"] = {0, 1};
  file_.json["skins"][0]["inverseBindMatrices"] =
      file_.add_accessor(scale_and_shift(1, {}), "MAT4", 5126, 1);
  EXPECT_THAT(error_of(read_text(file_.gltf(), "a.gltf")), HasSubstr("1 matrices for 2 joints"));
  file_.json["skins"][0]["joints"] = {0, 9};
  EXPECT_FALSE(read_text(file_.gltf(), "a.gltf").ok());
}

}  // namespace
}  // namespace gloam
