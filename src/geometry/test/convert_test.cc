#include "geometry/convert/convert.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "base/rng.h"
#include "geometry/convert/closest_point.h"
#include "geometry/convert/coarsen.h"
#include "geometry/convert/decompose.h"
#include "geometry/convert/fit.h"
#include "geometry/convert/hull.h"
#include "geometry/test/convert_shapes.h"

namespace gloam {
namespace {

using test::chair;
using test::l_shape;
using test::mug;
using test::torus;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Converted convert(const TriangleMesh& mesh, const std::string& colliders = "auto") {
  Result<Converted> made = convert_mesh(mesh, {.colliders = colliders});
  EXPECT_TRUE(made.ok()) << made.error().to_string();
  return made.ok() ? *made : Converted{};
}

const char* shape_of(const TriangleMesh& mesh) {
  const Converted made = convert(mesh);
  return made.colliders.size() == 1 ? word_of(made.colliders[0].type) : "parts";
}

TriangleMesh tilted(const Solid& solid) {
  return solid.turned(Axis::kX, 33).turned(Axis::kZ, 71).moved(3, -2, 0.5f).mesh();
}

std::vector<Vec3f> random_points(int count, bool on_sphere) {
  const RandomStream random{7, stream_id("hull")};
  std::vector<Vec3f> out;
  for (uint64_t i = 0; i < static_cast<uint64_t>(count); ++i) {
    Vec3f p{static_cast<float>(random.uniform(i, 0)) - 0.5f,
            static_cast<float>(random.uniform(i, 1)) - 0.5f,
            static_cast<float>(random.uniform(i, 2)) - 0.5f};
    out.push_back(on_sphere ? normalize(p) : p);
  }
  return out;
}

// Closed, and no point is outside.
void expect_hull(const std::vector<Vec3f>& points, const TriangleMesh& hull) {
  EXPECT_TRUE(count_edges(hull).is_closed());
  EXPECT_EQ(hull.triangle_count(), 2 * hull.positions.size() - 4);  // Euler
  MeshCollider collider;
  collider.hull = hull;
  const ColliderDistance distance(collider);
  double highest = -1;
  for (const Vec3f p : points) highest = std::max(highest, distance({p.x, p.y, p.z}));
  EXPECT_LT(highest, 1e-5);
}

TEST(Hull, HoldsAllPoints) {
  for (const bool on_sphere : {false, true}) {
    const std::vector<Vec3f> points = random_points(3000, on_sphere);
    const TriangleMesh hull = convex_hull(points);
    expect_hull(points, hull);
    EXPECT_TRUE(!on_sphere || hull.positions.size() == points.size());
  }
}

TEST(Hull, OfAGridIsItsEightCorners) {
  std::vector<Vec3f> points;
  for (int i = 0; i < 1000; ++i)
    points.push_back(
        {static_cast<float>(i % 10), static_cast<float>(i / 10 % 10), static_cast<float>(i / 100)});
  const TriangleMesh hull = convex_hull(points);
  EXPECT_EQ(hull.positions.size(), 8u);
  EXPECT_NEAR(mass_properties(hull).volume, 729, 1e-9);
}

TEST(Hull, OfFlatPointsIsEmpty) {
  EXPECT_TRUE(convex_hull({}).indices.empty());
  EXPECT_TRUE(convex_hull(std::vector<Vec3f>(9, Vec3f{1, 2, 3})).indices.empty());
  std::vector<Vec3f> line, plane;
  for (int i = 0; i < 50; ++i) {
    const auto t = static_cast<float>(i);
    line.push_back({t, 2 * t, 3 * t});
    plane.push_back({t, std::fmod(7 * t, 11.0f), t + 1});
  }
  EXPECT_TRUE(convex_hull(line).indices.empty());
  EXPECT_TRUE(convex_hull(plane).indices.empty());
}

TEST(Hull, LimitsTakeWhatSticksOutMost) {
  const std::vector<Vec3f> points = random_points(20000, true);
  const TriangleMesh few = convex_hull(points, {.vertices = 64});
  EXPECT_EQ(few.positions.size(), 64u);
  EXPECT_GT(mass_properties(few).volume, 0.85 * 4 * M_PI / 3);
  const TriangleMesh near = convex_hull(points, {.tolerance = 0.02});
  EXPECT_LT(near.positions.size(), 400u);
  EXPECT_GT(mass_properties(near).volume, 0.95 * 4 * M_PI / 3);
}

TEST(Mass, OfABoxAndATorus) {
  const MassProperties box = mass_properties(rounded_box({1, 2, 3}, 0).moved(100, 50, -20).mesh());
  EXPECT_NEAR(box.volume, 6, 1e-5);
  EXPECT_NEAR(box.center.x, 100, 1e-5);
  EXPECT_NEAR(box.inertia[0], 6 * (4 + 9) / 12.0, 1e-4);
  EXPECT_NEAR(box.inertia[1], 6 * (1 + 9) / 12.0, 1e-4);
  EXPECT_NEAR(box.inertia[2], 6 * (1 + 4) / 12.0, 1e-4);
  EXPECT_NEAR(box.inertia[3], 0, 1e-4);
  // Turned by 45 degrees about z the products come out.
  const MassProperties turned =
      mass_properties(rounded_box({1, 2, 3}, 0).turned(Axis::kZ, 45).mesh());
  EXPECT_NEAR(turned.inertia[3], 6 * (1 - 4) / 12.0 / 2 * -1, 2e-4);
  const MassProperties ring = mass_properties(torus(1, 0.25f, 200));
  const double volume = 2 * M_PI * M_PI * 0.25 * 0.25;
  EXPECT_NEAR(ring.volume, volume, 2e-3 * volume);
  EXPECT_NEAR(ring.inertia[2], volume * (1 + 0.75 * 0.0625), 4e-3 * volume);
}

TEST(Mass, EdgesTellClosedFromOpenAndTangled) {
  TriangleMesh box;
  box.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  box.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  EXPECT_TRUE(count_edges(box).is_closed());
  TriangleMesh open = box;
  open.indices.resize(9);
  EXPECT_EQ(count_edges(open).open, 3u);
  TriangleMesh fin = box;
  fin.indices.insert(fin.indices.end(), {0, 1, 4});
  EXPECT_EQ(count_edges(fin).tangled, 1u);
  EXPECT_EQ(count_edges(fin).open, 2u);
  std::swap(box.indices[0], box.indices[1]);  // one triangle looks inwards
  EXPECT_EQ(count_edges(box).tangled, 3u);
}

TEST(ClosestPoint, OfATorusIsItsFormula) {
  const TriangleMesh mesh = torus(1, 0.25f, 200);
  const MeshQueries queries(mesh);
  for (const Vec3f p : random_points(500, false)) {
    const Vec3d at{3.0 * p.x, 3.0 * p.y, 3.0 * p.z};
    const double d = std::hypot(std::hypot(at.x, at.y) - 1, at.z) - 0.25;
    EXPECT_NEAR(queries.distance(at), std::abs(d), 2e-3);
    EXPECT_TRUE(std::abs(d) < 2e-3 || queries.is_inside(at) == (d < 0));
  }
}

TEST(Fit, FindsTurnedSolidsAgain) {
  const auto hull = [](const Solid& s) { return convex_hull(tilted(s).positions); };
  const MeshCollider box = box_around(hull(rounded_box({0.3f, 0.5f, 0.9f}, 0)));
  EXPECT_NEAR(volume_of(box), 0.135, 1e-4);
  const MeshCollider sphere = sphere_around(hull(ball(0.4f, 64)));
  EXPECT_NEAR(sphere.size.x, 0.4, 1e-3);
  const MeshCollider can = cylinder_around(hull(cylinder(0.2f, 0, 1, 0, 64)));
  EXPECT_NEAR(can.size.x, 0.2, 1e-3);
  EXPECT_NEAR(can.size.y, 0.5, 1e-3);
  const MeshCollider pill = capsule_around(hull(ball(0.2f, 64) + ball(0.2f, 64).moved(0, 0, 1)));
  EXPECT_NEAR(pill.size.x, 0.2, 2e-3);
  EXPECT_NEAR(pill.size.y, 0.5, 4e-3);
}

TEST(Fit, ColliderDistancesAgreeWithTheirSurfaces) {
  for (const MeshColliderType type : {MeshColliderType::kBox, MeshColliderType::kSphere,
                                      MeshColliderType::kCylinder, MeshColliderType::kCapsule}) {
    MeshCollider c;
    c.type = type;
    c.size = {0.3, 0.5, 0.7};
    c.X_MG = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {1, 2, 3}};
    const TriangleMesh surface = surface_of(c);
    EXPECT_NEAR(mass_properties(surface).volume, volume_of(c), 3e-3 * volume_of(c))
        << word_of(type);
    const ColliderDistance distance(c);
    const MeshQueries mesh(surface);
    for (const Vec3f p : random_points(200, false)) {
      const Vec3d at{1 + 3.0 * p.x, 2 + 3.0 * p.y, 3 + 3.0 * p.z};
      EXPECT_NEAR(std::abs(distance(at)), mesh.distance(at), 2e-3) << word_of(type);
    }
  }
}

TEST(Fit, QuaternionsTurnAsTheirAxesDo) {
  for (const Vec3f& axis : random_points(50, true)) {
    const FrameOf<float> f = Frame::from_z(axis);
    const auto d = [](Vec3f v) { return Vec3d{v.x, v.y, v.z}; };
    const Quat q = quaternion_of({d(f.x), d(f.y), d(f.z), {}});
    EXPECT_NEAR(2 * (q.x * q.z + q.w * q.y), axis.x, 1e-6);
    EXPECT_NEAR(2 * (q.y * q.z - q.w * q.x), axis.y, 1e-6);
    EXPECT_NEAR(1 - 2 * (q.x * q.x + q.y * q.y), axis.z, 1e-6);
  }
}

TEST(Convert, RecognisesShapes) {
  EXPECT_STREQ(shape_of(tilted(rounded_box({0.3f, 0.5f, 0.9f}, 0.005f, 2))), "box");
  EXPECT_STREQ(shape_of(tilted(ball(0.4f, 32))), "sphere");
  EXPECT_STREQ(shape_of(tilted(cylinder(0.2f, 0, 1, 0.002f, 48))), "cylinder");
  EXPECT_STREQ(shape_of(tilted(lathe({{0, -0.7f},
                                      {0.1f, -0.673f},
                                      {0.173f, -0.6f},
                                      {0.2f, -0.5f},
                                      {0.2f, 0.5f},
                                      {0.173f, 0.6f},
                                      {0.1f, 0.673f},
                                      {0, 0.7f}},
                                     40))),
               "capsule");
  EXPECT_STREQ(shape_of(tilted(cone(0.4f, 0.1f, 0, 1, 0.002f, 40))), "hull");
  EXPECT_STREQ(shape_of(tilted(Solid(convex_hull(random_points(30, true))))), "hull");
}

TEST(Convert, SmallestAroundOnRequest) {
  const TriangleMesh mesh = l_shape();
  EXPECT_NEAR(volume_of(convert(mesh, "box").colliders[0]), 0.2, 0.002);
  EXPECT_NEAR(convert(mesh, "sphere").colliders[0].size.x, std::sqrt(0.51), 0.003);
  EXPECT_EQ(convert(mesh, "capsule").colliders[0].type, MeshColliderType::kCapsule);
  const Converted hull = convert(mesh, "hull");
  EXPECT_NEAR(volume_of(hull.colliders[0]), 0.2 * (1 - 0.8 * 0.8 / 2), 1e-4);
  EXPECT_NEAR(hull.mass.volume, 0.072, 1e-6);  // the mesh's all the same
  EXPECT_THAT(convert(mesh, "none").colliders, IsEmpty());
}

TEST(Convert, OpenMeshesWeighAsTheirHull) {
  TriangleMesh mesh = rounded_box({1, 1, 1}, 0).mesh();
  mesh.indices.resize(mesh.indices.size() - 6);
  const Converted made = convert(mesh, "hull");
  EXPECT_FALSE(made.is_closed);
  EXPECT_NEAR(made.mass.volume, 1, 1e-6);
  EXPECT_THAT(made.notes, ElementsAre(HasSubstr("is open (4 edges")));
}

TEST(Convert, TurnsMeshesThatLookInwards) {
  TriangleMesh mesh = l_shape();
  for (size_t i = 0; i < mesh.indices.size(); i += 3)
    std::swap(mesh.indices[i], mesh.indices[i + 1]);
  const Converted made = convert(mesh, "hull");
  EXPECT_TRUE(made.is_closed);
  EXPECT_NEAR(made.mass.volume, 0.072, 1e-6);
  EXPECT_THAT(made.notes, ElementsAre(HasSubstr("inwards")));
}

// Seen from inside.
TriangleMesh room_of(const Profile& outline, float height) {
  TriangleMesh room = extrude(outline, 0, height).mesh();
  for (size_t i = 0; i + 2 < room.indices.size(); i += 3)
    std::swap(room.indices[i + 1], room.indices[i + 2]);
  return room;
}

Converted converted_room(const TriangleMesh& shell) {
  Result<Converted> made = convert_mesh(shell, {.may_be_room = true});
  EXPECT_TRUE(made.ok()) << made.error().to_string();
  return made.ok() ? *made : Converted{};
}

// To the nearest of the colliders, below 0 within.
double clearance(const Converted& room, Vec3d p) {
  double least = 1e300;
  for (const MeshCollider& c : room.colliders) least = std::min(least, ColliderDistance(c)(p));
  return least;
}

TEST(ConvertRoom, HasWallsFloorAndCeilingAndAirWithin) {
  const Converted room = converted_room(room_of({{0, 0}, {5, 0}, {5, 4}, {0, 4}}, 2.5f));
  EXPECT_TRUE(room.is_room);
  EXPECT_THAT(room.notes, ElementsAre(HasSubstr("treated as a room")));
  EXPECT_EQ(room.colliders.size(), 6u);
  EXPECT_NEAR(clearance(room, {2.5, 2, 1.25}), 1.25, 1e-4);
  EXPECT_NEAR(clearance(room, {0.1, 2, 1}), 0.1, 1e-4);
  EXPECT_NEAR(clearance(room, {-0.05, 2, 1}), -0.05, 1e-4);
  EXPECT_NEAR(clearance(room, {2.5, 2, 2.55}), -0.05, 1e-4);
  EXPECT_NEAR(clearance(room, {2.5, 2, -0.05}), -0.05, 1e-4);
}

TEST(ConvertRoom, KeepsNichesAndBothSidesOfThinPartitions) {
  // 6 x 4 m with a wall of 6 cm that leaves a way of 1.2 m, and a niche of 0.5 x 0.5 m.
  const Converted room = converted_room(room_of({{0, 0},
                                                 {2.97f, 0},
                                                 {2.97f, 2.8f},
                                                 {3.03f, 2.8f},
                                                 {3.03f, 0},
                                                 {6, 0},
                                                 {6, 1},
                                                 {6.5f, 1},
                                                 {6.5f, 1.5f},
                                                 {6, 1.5f},
                                                 {6, 4},
                                                 {0, 4}},
                                                2.5f));
  EXPECT_LT(room.colliders.size(), 40u);
  for (const Vec3d p : {Vec3d{1.5, 2, 1}, Vec3d{4.5, 2, 1}, Vec3d{3, 3.4, 1}, Vec3d{6.25, 1.25, 1},
                        Vec3d{2.9, 1, 1}, Vec3d{3.1, 1, 1}})
    EXPECT_GT(clearance(room, p), 0.04) << p.x << ' ' << p.y;
  EXPECT_LT(clearance(room, {2.98, 1, 1}), 0);
  EXPECT_LT(clearance(room, {3.02, 1, 1}), 0);
}

TEST(ConvertRoom, OfAScanIsFewSlabs) {
  // Walls of 24,000 triangles, 3 mm rough.
  TriangleMesh shell;
  const RandomStream random{3, stream_id("room")};
  constexpr int kSteps = 45;
  const Vec3f side{5, 4, 2.5f};
  for (int axis = 0; axis < 3; ++axis) {
    for (int end = 0; end < 2; ++end) {
      const auto first = static_cast<uint32_t>(shell.positions.size());
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
          float at[3];
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          at[axis] = static_cast<float>(end);
          at[u] = static_cast<float>(i) / kSteps, at[v] = static_cast<float>(j) / kSteps;
          Vec3f p{at[0] * side.x, at[1] * side.y, at[2] * side.z};
          // The same at the same place, so that the walls meet.
          const auto key = static_cast<uint64_t>(std::lround(p.x * 1000)) * 100'000'000 +
                           static_cast<uint64_t>(std::lround(p.y * 1000)) * 10'000 +
                           static_cast<uint64_t>(std::lround(p.z * 1000));
          const auto rough = [&](uint32_t k) {
            return 0.003f * (2 * static_cast<float>(random.uniform(key, k)) - 1);
          };
          shell.positions.push_back(p + Vec3f{rough(0), rough(1), rough(2)});
        }
      }
      for (uint32_t i = 0; i < kSteps; ++i) {
        for (uint32_t j = 0; j < kSteps; ++j) {
          const auto at = [&](uint32_t a, uint32_t b) {
            return first + (i + a) * (kSteps + 1) + j + b;
          };
          std::array<uint32_t, 6> quad = {at(0, 0), at(1, 1), at(1, 0),
                                          at(0, 0), at(0, 1), at(1, 1)};
          if (end == 0) std::swap(quad[1], quad[2]), std::swap(quad[4], quad[5]);
          shell.indices.insert(shell.indices.end(), quad.begin(), quad.end());
        }
      }
    }
  }
  const Converted room = converted_room(shell);
  EXPECT_TRUE(room.is_room);
  EXPECT_LE(room.colliders.size(), 256u);
  for (uint64_t i = 0; i < 2000; ++i) {
    const Vec3d p{0.03 + 4.94 * random.uniform(i, 10), 0.03 + 3.94 * random.uniform(i, 11),
                  0.03 + 2.44 * random.uniform(i, 12)};
    ASSERT_GT(clearance(room, p), 0) << p.x << ' ' << p.y << ' ' << p.z;
    // Just behind each wall is something.
    ASSERT_LT(clearance(room, {p.x, p.y, -0.02}), 0);
    ASSERT_LT(clearance(room, {p.x, p.y, 2.52}), 0);
    ASSERT_LT(clearance(room, {-0.02, p.y, p.z}), 0);
    ASSERT_LT(clearance(room, {p.x, 4.02, p.z}), 0);
  }
}

TEST(ConvertRoom, IsNoneWhereNobodyStands) {
  const TriangleMesh crate = room_of({{0, 0}, {0.6f, 0}, {0.6f, 0.6f}, {0, 0.6f}}, 2);
  EXPECT_FALSE(converted_room(crate).is_room);
  EXPECT_EQ(converted_room(crate).colliders.size(), 1u);
  // What looks outwards is solid, and so is what is not of a place.
  const Profile large = {{0, 0}, {5, 0}, {5, 4}, {0, 4}};
  EXPECT_FALSE(converted_room(extrude(large, 0, 2.5f).mesh()).is_room);
  EXPECT_FALSE(convert(room_of(large, 2.5f)).is_room);
}

TEST(ConvertRoom, MayLackItsCeiling) {
  TriangleMesh shell = room_of({{0, 0}, {5, 0}, {5, 4}, {0, 4}}, 2.5f);
  std::vector<uint32_t> open;
  for (size_t i = 0; i + 2 < shell.indices.size(); i += 3) {
    const auto high = [&](size_t k) { return shell.positions[shell.indices[i + k]].z > 2.4f; };
    if (!(high(0) && high(1) && high(2)))
      open.insert(open.end(), shell.indices.begin() + static_cast<std::ptrdiff_t>(i),
                  shell.indices.begin() + static_cast<std::ptrdiff_t>(i) + 3);
  }
  shell.indices = open;
  const Converted room = converted_room(shell);
  EXPECT_TRUE(room.is_room);
  EXPECT_FALSE(room.is_closed);
  EXPECT_EQ(room.colliders.size(), 5u);
  EXPECT_NEAR(clearance(room, {2.5, 2, 1}), 1, 1e-4);
}

TEST(Convert, FlatMeshesBecomePlates) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  const Converted made = convert(mesh);
  ASSERT_EQ(made.colliders.size(), 1u);
  EXPECT_EQ(made.colliders[0].type, MeshColliderType::kBox);
  EXPECT_TRUE(made.is_closed);
  EXPECT_NEAR(made.mass.volume, 2 * 1 * std::sqrt(5) * 1e-3, 1e-6);
  EXPECT_THAT(made.notes, ElementsAre(HasSubstr("is flat")));
}

TEST(Convert, RefusesWhatIsNoMesh) {
  const auto error = [](const TriangleMesh& mesh) {
    const Result<Converted> made = convert_mesh(mesh, {});
    return made.ok() ? "" : made.error().message;
  };
  TriangleMesh mesh;
  EXPECT_THAT(error(mesh), HasSubstr("no triangles"));
  mesh.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  mesh.indices = {0, 1, 2, 1, 2, 3};
  EXPECT_THAT(error(mesh), HasSubstr("no extent"));
  mesh.positions.assign(4, {1, 2, 3});
  EXPECT_THAT(error(mesh), HasSubstr("no triangles"));
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {NAN, 1, 0}};
  mesh.indices = {0, 1, 2};
  EXPECT_THAT(error(mesh), HasSubstr("not a number"));
}

TEST(Convert, RefusesWhatIsTooFarAway) {
  TriangleMesh mesh = l_shape();
  for (Vec3f& p : mesh.positions) p = p * 1e20f;
  const Result<Converted> made = convert_mesh(mesh, {});
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().message, HasSubstr("1e+20 m from its origin"));
  EXPECT_THAT(made.error().hint, HasSubstr("'unit'"));
}

TEST(Convert, TrianglesWithoutAreaOpenNothing) {
  TriangleMesh mesh = l_shape();
  mesh.indices.insert(mesh.indices.end(), {0, 0, 1, 2, 2, 2, 1, 0, 1});
  const Converted made = convert(mesh, "hull");
  EXPECT_TRUE(made.is_closed);
  EXPECT_NEAR(made.mass.volume, 0.072, 1e-6);
}

TEST(Convert, FinsAndSharedEdgesWeighAsTheirHull) {
  // Two boxes that touch along an edge: four triangles meet there.
  const TriangleMesh boxes =
      (rounded_box({1, 1, 1}, 0) + rounded_box({1, 1, 1}, 0).moved(1, 1, 0)).mesh();
  const Converted made = convert(boxes, "hull");
  EXPECT_FALSE(made.is_closed);
  EXPECT_TRUE(is_physical(made.mass));
  EXPECT_NEAR(made.mass.volume, 3, 1e-5);
  EXPECT_THAT(made.notes, ElementsAre(HasSubstr("not a manifold (1 edges")));
}

TEST(Convert, OneHugeTriangleIsAPlate) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1e6f, 0, 0}, {0, 1e6f, 0}};
  mesh.indices = {0, 1, 2};
  const Converted made = convert(mesh, "hull");
  ASSERT_EQ(made.colliders.size(), 1u);
  EXPECT_TRUE(is_physical(made.mass));
  EXPECT_THAT(made.notes, ElementsAre(HasSubstr("is flat")));
}

TEST(Coarsen, KeepsShapeAndClosure) {
  const TriangleMesh fine = torus(1, 0.25f, 400);  // 320,000 triangles
  const TriangleMesh coarse = coarsened(fine, 20'000);
  EXPECT_LE(coarse.triangle_count(), 20'000u);
  EXPECT_GT(coarse.triangle_count(), 10'000u);
  EXPECT_EQ(count_edges(coarse).open, 0u);
  const double volume = mass_properties(fine).volume;
  EXPECT_NEAR(mass_properties(coarse).volume, volume, 5e-3 * volume);
  const MeshQueries queries(fine);
  double most = 0;
  for (const SurfacePoint& s : sample_surface(coarse, 2000))
    most = std::max(most, queries.distance(s.p));
  EXPECT_LT(most, 0.01);  // of 2.5 m
  EXPECT_EQ(coarsened(l_shape(), 1000).indices, l_shape().indices);
}

TEST(Coarsen, KeepsBothSidesOfThinWalls) {
  // A sheet of 1 x 1 x 0.001 m in small triangles: cells are thicker than it is.
  constexpr uint32_t kSteps = 200;
  TriangleMesh sheet;
  for (const float z : {0.0f, 0.001f})
    for (uint32_t i = 0; i <= kSteps; ++i)
      for (uint32_t k = 0; k <= kSteps; ++k)
        sheet.positions.push_back(
            {static_cast<float>(i) / kSteps, static_cast<float>(k) / kSteps, z});
  constexpr uint32_t kRow = kSteps + 1, kSide = kRow * kRow;
  for (uint32_t i = 0; i < kSteps; ++i)
    for (uint32_t k = 0; k < kSteps; ++k) {
      const uint32_t a = i * kRow + k, b = a + kRow;
      for (const uint32_t corner : {a, a + 1, b, b, a + 1, b + 1}) sheet.indices.push_back(corner);
      for (const uint32_t corner : {a, b, a + 1, b, b + 1, a + 1})
        sheet.indices.push_back(kSide + corner);
    }
  const TriangleMesh coarse = coarsened(sheet, 5000);
  size_t below = 0, above = 0;
  for (const uint32_t v : coarse.indices) {
    below += coarse.positions[v].z < 2e-4f;
    above += coarse.positions[v].z > 8e-4f;
  }
  EXPECT_EQ(below + above, coarse.indices.size());
  EXPECT_GT(below, 1000u);
  EXPECT_GT(above, 1000u);
}

class MeshParts : public testing::Test {
 protected:
  void SetUp() override {
#ifdef GLOAM_SANITIZED
    GTEST_SKIP() << "CoACD is loaded with its own symbols first, which sanitizers refuse";
#endif
  }
  MeshParts() {
    folder_ =
        std::filesystem::temp_directory_path() / ("gloam_parts_" + std::to_string(::getpid()));
    ::setenv("GLOAM_CACHE", folder_.c_str(), 1);
  }
  ~MeshParts() override {
    ::unsetenv("GLOAM_CACHE");
    std::filesystem::remove_all(folder_);
  }
  std::filesystem::path folder_;
};

TEST_F(MeshParts, OfThinAndThickThings) {
  struct Case {
    const char* name;
    TriangleMesh mesh;
    double shared, mean;  // at least, at most of the size
  };
  for (const Case& c :
       {Case{"L", l_shape(), 0.97, 0.005}, Case{"torus", torus(1, 0.25f), 0.8, 0.02},
        Case{"mug", mug(), 0.8, 0.005}, Case{"chair", chair(), 0.9, 0.005}}) {
    const auto start = std::chrono::steady_clock::now();
    const Converted made = convert(c.mesh);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    const Overlap overlap = overlap_of(made);
    for (const std::string& note : made.notes) std::printf("%s %s\n", c.name, note.c_str());
    const double size = length(Solid(c.mesh).high() - Solid(c.mesh).low());
    EXPECT_GT(made.colliders.size(), 1u) << c.name;
    EXPECT_GT(overlap.shared, c.shared) << c.name;
    EXPECT_LT(overlap.mean_distance, c.mean * size) << c.name;
    std::printf(
        "%s: %.2f s, %zu hulls, closed %d, shared %.3f, volume %.4g of %.4g, distance mean %.3g "
        "max %.3g "
        "of the size\n",
        c.name, passed.count(), made.colliders.size(), made.is_closed, overlap.shared,
        overlap.collider_volume, overlap.mesh_volume, overlap.mean_distance / size,
        overlap.max_distance / size);
  }
}

double seconds_of(const TriangleMesh& mesh, const std::string& colliders, Converted* made) {
  const auto start = std::chrono::steady_clock::now();
  *made = convert(mesh, colliders);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// A scan: a lumpy closed body of 5,120,000 triangles, with the scanner's noise.
TriangleMesh large_scan() {
  TriangleMesh scan = torus(0.5f, 0.3f, 1600);
  const RandomStream random{11, stream_id("scan")};
  for (size_t i = 0; i < scan.positions.size(); ++i) {
    Vec3f& p = scan.positions[i];
    p.z *= 1.2f + 0.3f * std::sin(5 * p.x) * std::cos(4 * p.y);
    p = p * (1 + 2e-4f * (static_cast<float>(random.uniform(i, 0)) - 0.5f));
  }
  return scan;
}

TEST_F(MeshParts, TheHullOfAScanOfFiveMillionTriangles) {
  Converted hull;
  const double seconds = seconds_of(large_scan(), "hull", &hull);
  EXPECT_TRUE(hull.is_closed);
  EXPECT_TRUE(is_physical(hull.mass));
  EXPECT_EQ(hull.colliders.size(), 1u);
  EXPECT_LT(seconds, 60);
  std::printf("hull of a scan: %.1f s\n", seconds);
}

TEST_F(MeshParts, DISABLED_SweepPartsOfAScanOfFiveMillionTriangles) {
  Converted parts;
  const double seconds = seconds_of(large_scan(), "hulls", &parts);
  EXPECT_GT(parts.colliders.size(), 1u);
  EXPECT_THAT(parts.notes, testing::Contains(HasSubstr("5120000 triangles")));
  const Overlap overlap = overlap_of(parts);
  EXPECT_GT(overlap.shared, 0.8);
  std::printf("parts of a scan: %.1f s (%zu), shared %.3f\n", seconds, parts.colliders.size(),
              overlap.shared);
}

TEST_F(MeshParts, AreTheSameEveryTime) {
  const TriangleMesh mesh = chair();
  const auto run = [&] {
    const auto start = std::chrono::steady_clock::now();
    const Converted made = convert(mesh);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    return std::pair(made, passed.count());
  };
  const auto [first, cold] = run();
  const auto [second, warm] = run();
  ASSERT_EQ(first.colliders.size(), second.colliders.size());
  for (size_t i = 0; i < first.colliders.size(); ++i) {
    EXPECT_EQ(first.colliders[i].hull.indices, second.colliders[i].hull.indices);
    EXPECT_TRUE(std::ranges::equal(first.colliders[i].hull.positions,
                                   second.colliders[i].hull.positions,
                                   [](Vec3f a, Vec3f b) { return (a == b) != 0; }));
  }
  std::printf("chair of %zu triangles: %zu hulls, %.2f s, %.3f s again\n", mesh.triangle_count(),
              first.colliders.size(), cold, warm);
}

}  // namespace
}  // namespace gloam
