#include <cmath>

#include "visual_test_model.h"
#include "world/shapes/visual_mesh.h"

namespace gloam {
namespace {

using visual_test::compile;
using visual_test::describe;
using visual_test::expect_near;

const char* kCube =
    R"(vertex="0 0 0  .4 0 0  .4 .2 0  0 .2 0  0 0 .1  .4 0 .1  .4 .2 .1  0 .2 .1")";

Affine3f pose_in_world(const CompiledWorld& world, const InstanceDescription& instance) {
  const std::unique_ptr<mjData, void (*)(mjData*)> data{mj_makeData(world.model.get()),
                                                        mj_deleteData};
  mj_kinematics(world.model.get(), data.get());
  const mjtNum* p = data->xpos + 3 * instance.body;
  const mjtNum* R = data->xmat + 9 * instance.body;
  const auto f = [](mjtNum x) { return static_cast<float>(x); };
  const Affine3f X_WB{{f(R[0]), f(R[3]), f(R[6])},
                      {f(R[1]), f(R[4]), f(R[7])},
                      {f(R[2]), f(R[5]), f(R[8])},
                      {f(p[0]), f(p[1]), f(p[2])}};
  return X_WB * instance.X_BG;
}

TEST(VisualMesh, VerticesLandWhereTheFilePutThem) {
  // MuJoCo moves a mesh to its inertial frame and the geom the other way. An irregular tetrahedron
  // has no symmetry to hide behind; refpos and scale move and stretch the file's vertices first.
  const CompiledWorld world = compile(R"(<mujoco><asset>
      <mesh name="m" vertex="1 0 0  0 2 0  0 0 3  .1 .2 -.3" scale="1 2 .5" refpos=".5 0 0"/></asset>
    <worldbody><body pos="1 2 3" quat="1 1 0 0"><geom type="mesh" mesh="m" pos=".1 .2 .3"
      quat="1 0 1 0"/></body></worldbody></mujoco>)");
  const RenderDescription out = describe(world);
  ASSERT_EQ(out.instances.size(), 1u);
  const TriangleMesh& mesh = out.meshes[static_cast<size_t>(out.instances[0].mesh)];
  EXPECT_EQ(mesh.triangle_count(), 4u);
  // File vertex f -> scaled (x, 2y, z/2), minus refpos; geom: about y by 90 degrees, then moved;
  // body: about x by 90 degrees, then moved.
  const Vec3f file[4] = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {.1f, .2f, -.3f}};
  bool hit[4] = {};
  const Affine3f X_WG = pose_in_world(world, out.instances[0]);
  for (const Vec3f& p : mesh.positions) {
    const Vec3f drawn = transform_point(X_WG, p);
    float nearest = 1;
    for (int i = 0; i < 4; ++i) {
      const Vec3f m{file[i].x - .5f, 2 * file[i].y, .5f * file[i].z};
      const Vec3f b{m.z + .1f, m.y + .2f, -m.x + .3f};
      const Vec3f w{b.x + 1, -b.z + 2, b.y + 3};
      const float distance = length(drawn - w);
      if (distance < 1e-6f) hit[i] = true;
      nearest = min(nearest, distance);
    }
    EXPECT_LT(nearest, 1e-6f);
  }
  for (const bool h : hit) EXPECT_TRUE(h);
}

TEST(VisualMesh, EdgesAreSharpAndFacesLookOutwards) {
  const RenderDescription out = describe(std::string("<mujoco><asset><mesh name='m' ") + kCube +
                                         "/></asset><worldbody><geom type='mesh' mesh='m'/>"
                                         "</worldbody></mujoco>");
  const TriangleMesh& mesh = out.meshes[0];
  EXPECT_EQ(mesh.triangle_count(), 12u);
  EXPECT_EQ(mesh.positions.size(), 24u) << "four corners of six faces, welded within each face";
  for (size_t f = 0; f < mesh.indices.size(); f += 3) {
    const Vec3f a = mesh.positions[mesh.indices[f]], b = mesh.positions[mesh.indices[f + 1]],
                c = mesh.positions[mesh.indices[f + 2]];
    const Vec3f normal = normalize(cross(b - a, c - a));
    EXPECT_GT(dot(normal, a + b + c), 0) << "the mesh is centred: outwards is away from zero";
    for (size_t k = f; k < f + 3; ++k)
      EXPECT_NEAR(dot(mesh.normals[mesh.indices[k]], normal), 1, 1e-5);
  }
}

TEST(VisualMesh, GivenNormalsAreKeptUpToTheEdgeAngle) {
  // A quad whose normals lean towards +x: MuJoCo draws 35 degrees smooth and 40 as an edge.
  for (const float degrees : {20.0f, 35.0f, 40.0f, 80.0f}) {
    const float s = std::sin(degrees * kPi / 180), c = std::cos(degrees * kPi / 180);
    const Vec3f positions[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const Vec3f normals[1] = {{s, 0, c}};
    const int face[6] = {0, 1, 2, 0, 2, 3}, normal[6] = {};
    const TriangleMesh mesh = split_corners({positions, normals, {}, face, normal, {}});
    ASSERT_EQ(mesh.positions.size(), 4u);
    for (const Vec3f& n : mesh.normals)
      expect_near(n, degrees < 37 ? Vec3f{s, 0, c} : Vec3f{0, 0, 1}, 1e-6f);
  }
}

TEST(VisualMesh, CornersSplitAtTextureSeamsOnly) {
  const Vec3f positions[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const Vec3f normals[1] = {{0, 0, 1}};
  const Vec2f uvs[5] = {{0, 0}, {1, 0}, {1, .25f}, {0, 1}, {.5f, .5f}};
  const int face[6] = {0, 1, 2, 0, 2, 3}, normal[6] = {}, uv[6] = {0, 1, 2, 4, 2, 3};
  const TriangleMesh mesh = split_corners({positions, normals, uvs, face, normal, uv});
  EXPECT_EQ(mesh.positions.size(), 5u) << "only corner 0 has two texture coordinates";
  ASSERT_EQ(mesh.uvs.size(), 5u);
  EXPECT_FLOAT_EQ(mesh.uvs[mesh.indices[2]].y, .75f) << "v grows upwards, MuJoCo's t downwards";
  EXPECT_FLOAT_EQ(mesh.uvs[mesh.indices[3]].x, .5f);
  EXPECT_EQ(mesh.indices[2], mesh.indices[4]);
}

TEST(VisualMesh, GeomsShareTheirMesh) {
  const RenderDescription out = describe(std::string("<mujoco><asset><mesh name='m' ") + kCube +
                                         R"(/><mesh name="unused" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>
      </asset><worldbody><geom type="mesh" mesh="m"/><geom type="mesh" mesh="m" pos="1 0 0"/>
      <geom size="1"/></worldbody></mujoco>)");
  ASSERT_EQ(out.instances.size(), 3u);
  EXPECT_EQ(out.meshes.size(), 1u);
  EXPECT_EQ(out.instances[0].mesh, out.instances[1].mesh);
  EXPECT_EQ(out.instances[2].shape, ShapeType::kSphere);
}

TEST(VisualMesh, HeightFieldIsTheOneThatRaysHit) {
  const CompiledWorld world = compile(R"(<mujoco><asset><hfield name="h" nrow="4" ncol="5"
      size=".8 .6 .5 .2" elevation="0 1 3 2 0  1 4 2 5 1  2 0 1 3 3  0 2 4 1 0"/></asset>
    <worldbody><geom type="hfield" hfield="h"/></worldbody></mujoco>)");
  const RenderDescription out = describe(world);
  ASSERT_EQ(out.height_fields.size(), 1u);
  const HeightFieldDescription& field = out.height_fields[0];
  EXPECT_EQ(field.rows, 4);
  EXPECT_EQ(field.columns, 5);
  const TriangleMesh& mesh = out.meshes[static_cast<size_t>(field.mesh)];
  EXPECT_EQ(mesh.triangle_count(), 2u * 3 * 4 + 2u * 2 * (3 + 4) + 2);

  // The last row of the XML is the first of the model, at -y. Data are scaled to 0..1 (max 5).
  bool corner = false;
  for (const Vec3f& p : mesh.positions) corner = corner || length(p - Vec3f{.4f, .2f, .5f}) < 1e-6f;
  EXPECT_TRUE(corner) << "the peak of 5 stands at column 3, second row from the top";

  // Closed: the volume inside is that of the surface over the base.
  double volume = 0, surface_area = 0;
  for (size_t f = 0; f < mesh.indices.size(); f += 3) {
    const Vec3f a = mesh.positions[mesh.indices[f]], b = mesh.positions[mesh.indices[f + 1]],
                c = mesh.positions[mesh.indices[f + 2]];
    volume += dot(a, cross(b, c)) / 6;
    if (mesh.normals[mesh.indices[f]].z > 0.01f) surface_area += 0.5 * cross(b - a, c - a).z;
  }
  EXPECT_NEAR(surface_area, 1.6 * 1.2, 1e-5);

  // Straight down through random points: the drawn height is the one MuJoCo's ray finds.
  const std::unique_ptr<mjData, void (*)(mjData*)> data{mj_makeData(world.model.get()),
                                                        mj_deleteData};
  mj_forward(world.model.get(), data.get());
  double mean = 0;
  int count = 0;
  for (double x = -.79; x < .8; x += .0337)
    for (double y = -.59; y < .6; y += .0271, ++count) {
      const mjtNum origin[3] = {x, y, 5}, down[3] = {0, 0, -1};
      const mjtNum distance = mj_rayHfield(world.model.get(), data.get(), 0, origin, down, nullptr);
      float height = -1;
      for (size_t f = 0; f < mesh.indices.size(); f += 3) {
        const Vec3f a = mesh.positions[mesh.indices[f]], b = mesh.positions[mesh.indices[f + 1]],
                    c = mesh.positions[mesh.indices[f + 2]];
        const double area = cross(b - a, c - a).z;
        if (area < 1e-9) continue;
        const Vec3f p{static_cast<float>(x), static_cast<float>(y), 0};
        const auto edge = [&](Vec3f u, Vec3f v) { return cross(v - u, p - u).z / area; };
        const double wc = edge(a, b), wa = edge(b, c), wb = edge(c, a);
        if (wa >= 0 && wb >= 0 && wc >= 0)
          height = max(height, static_cast<float>(wa * a.z + wb * b.z + wc * c.z));
      }
      EXPECT_NEAR(height, 5 - distance, 1e-5) << "at " << x << " " << y;
      mean += height;
    }
  EXPECT_NEAR(volume / (1.6 * 1.2), mean / count + .2, 2e-3);
}

}  // namespace
}  // namespace gloam
