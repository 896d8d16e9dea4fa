// The catalogue of props as a whole: whatever kind, seed and size, a prop is a thing that can stand
// in a world.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "gloam/scene/object.h"
#include "places/catalogue.h"
#include "places/place.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;

bool finite(Vec3f v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::vector<PropRequest> requests_of(const PropKind& kind) {
  std::vector<PropRequest> all;
  for (uint64_t seed = 0; seed < 5; ++seed) all.push_back({kind.name, seed});
  MaterialSet materials;
  const Prop usual = make_prop(all[0], {}, &materials).value();
  const Vec3f size = usual.bounds().high - usual.bounds().low;
  for (const double by : {0.1, 0.6, 1.5, 10.0}) {
    const auto edge = [&](float e) { return std::clamp(by * double(e), 0.01, 100.0); };
    all.push_back({kind.name, 7, Vec3{edge(size.x), edge(size.y), edge(size.z)}});
  }
  return all;
}

void check_mesh(const TriangleMesh& mesh) {
  ASSERT_GE(mesh.indices.size(), 3u);
  EXPECT_EQ(mesh.indices.size() % 3, 0u);
  EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  size_t bad = 0;
  for (const Vec3f p : mesh.positions) bad += !finite(p);
  for (const Vec3f n : mesh.normals) bad += !(std::fabs(length(n) - 1) < 1e-3f);
  for (const uint32_t i : mesh.indices) bad += i >= mesh.positions.size();
  EXPECT_EQ(bad, 0u) << "vertices or corners that are none";
}

// Where most of a closed thing's faces look: normals and winding agree.
void check_winding(const TriangleMesh& mesh) {
  double against = 0, all = 0;
  for (size_t f = 0; f < mesh.indices.size(); f += 3) {
    const uint32_t* c = &mesh.indices[f];
    const Vec3f a = mesh.positions[c[0]];
    const Vec3f face = cross(mesh.positions[c[1]] - a, mesh.positions[c[2]] - a);
    all += length(face);
    if (dot(face, mesh.normals[c[0]] + mesh.normals[c[1]] + mesh.normals[c[2]]) < 0)
      against += length(face);
  }
  EXPECT_LT(against, 0.02 * all) << "faces that look the other way than their normals";
}

// `is_paint`: too thin for a robot to notice, as lines on a floor are.
void check_part(const PropPart& part, const std::set<std::string>& looks, bool is_paint) {
  EXPECT_GT(part.mass, 0);
  EXPECT_EQ(part.colliders.empty(), is_paint);
  std::set<std::string> names;
  for (const PropVisual& visual : part.visuals) {
    SCOPED_TRACE(visual.name);
    EXPECT_TRUE(names.insert(visual.name).second) << "a name twice";
    EXPECT_TRUE(looks.count(visual.material)) << visual.material;
    check_mesh(visual.mesh);
    check_winding(visual.mesh);
  }
  for (const PropCollider& c : part.colliders) {
    EXPECT_TRUE(finite(c.size));
    const int edges = c.shape == ColliderShape::kBox      ? 3
                      : c.shape == ColliderShape::kSphere ? 1
                                                          : 2;
    for (int i = 0; i < edges; ++i) EXPECT_GT(c.size[i], 0);
    const Quat& q = c.X_PG.q;
    EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-6);
    EXPECT_GE(c.friction, 0);
  }
  if (!part.joint) return;
  EXPECT_LT(part.joint->low, part.joint->high);
  EXPECT_GE(part.joint->initial, part.joint->low);
  EXPECT_LE(part.joint->initial, part.joint->high);
  EXPECT_GT(part.joint->damping, 0);
}

// What is seen, or what collides, alone.
Prop::Box box_of(Prop prop, bool seen) {
  for (PropPart& part : prop.parts) {
    if (seen) part.colliders.clear();
    if (!seen) part.visuals.clear();
  }
  return prop.bounds();
}

void check_boxes(const Prop& prop) {
  const Prop::Box seen = box_of(prop, true), solid = box_of(prop, false), all = prop.bounds();
  constexpr float kTight = 0.02f;  // [m]
  for (int i = 0; i < 3; ++i) {
    EXPECT_GE(solid.low[i], seen.low[i] - kTight) << "colliders beyond what is seen, axis " << i;
    EXPECT_LE(solid.high[i], seen.high[i] + kTight) << "colliders beyond what is seen, axis " << i;
  }
  const Vec3f size = all.high - all.low;
  const double density = prop.mass() / (double(size.x) * size.y * size.z);
  EXPECT_GT(density, 1) << "lighter than air; paper lanterns are not much heavier";
  EXPECT_LT(density, 3000);
  // It stands on the floor, or hangs well below its origin.
  EXPECT_TRUE(all.low.z > -1e-4f || all.low.z < -0.01f) << all.low.z;
  if (prop.loose) {
    EXPECT_NEAR(solid.low.z, 0, 1e-5) << "its colliders are its feet";
    EXPECT_GT(all.low.z, -1e-4f);
  }
  EXPECT_GE(prop.front, 0);
  for (const PropSurface& s : prop.surfaces) {
    EXPECT_LT(s.low.x, s.high.x);
    EXPECT_LT(s.low.y, s.high.y);
    EXPECT_GT(s.clearance, 0.02f);
    EXPECT_GE(s.z, all.low.z);
    EXPECT_LE(s.z, all.high.z + 1e-4f);
    EXPECT_GE(s.low.x, all.low.x);
    EXPECT_LE(s.high.x, all.high.x);
    EXPECT_GE(s.low.y, all.low.y);
    EXPECT_LE(s.high.y, all.high.y);
  }
}

TEST(Props, AreThingsThatCanStandInAWorld) {
  for (const PropKind& kind : prop_catalogue()) {
    for (const PropRequest& request : requests_of(kind)) {
      SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(request.seed) +
                   (request.size ? ", width " + std::to_string(request.size->y) : ""));
      MaterialSet materials;
      const Result<Prop> made = make_prop(request, {}, &materials);
      ASSERT_TRUE(made.ok()) << made.error().to_string();
      std::set<std::string> looks, parts;
      for (const Look& look : materials.looks()) looks.insert(look.name);
      EXPECT_EQ(made->label, kind.name);
      int index = 0;
      for (const PropPart& part : made->parts) {
        SCOPED_TRACE(part.name);
        EXPECT_TRUE(parts.insert(part.name).second) << "a part's name twice";
        EXPECT_LT(part.parent, index);
        EXPECT_EQ(part.parent < 0, index == 0);
        check_part(part, looks, made->bounds().high.z - made->bounds().low.z < 0.002f);
        ++index;
      }
      check_boxes(*made);
      for (const LightOptions& light : made->lights) {
        EXPECT_TRUE(light.type.has_value());
        EXPECT_GT(light.flux.value_or(1), 0);
      }
    }
  }
}

TEST(Props, AreTheSameForTheSameRequest) {
  const auto hash = [](const PropRequest& request) {
    Place place("p");
    place.put(place.make(request).value(), "", {});
    return place.hash();
  };
  for (const PropKind& kind : prop_catalogue())
    for (uint64_t seed = 0; seed < 3; ++seed)
      EXPECT_EQ(hash({kind.name, seed}), hash({kind.name, seed})) << kind.name;
}

// A geom costs time at every step: a place's thing has no more of them than it has to.
TEST(Props, InAPlaceHaveOneVisualForEachMaterialAndLoseNothing) {
  for (const PropKind& kind : prop_catalogue()) {
    SCOPED_TRACE(kind.name);
    MaterialSet materials;
    const Prop alone = make_prop({kind.name, 3}, {}, &materials).value();
    Place place("p");
    const Prop& placed = place.prop(place.make({kind.name, 3}).value());
    ASSERT_EQ(placed.parts.size(), alone.parts.size());
    for (size_t i = 0; i < placed.parts.size(); ++i) {
      size_t corners = 0;
      std::set<std::pair<std::string, bool>> kinds;
      for (const PropVisual& visual : placed.parts[i].visuals) {
        check_mesh(visual.mesh);
        corners += visual.mesh.indices.size();
        EXPECT_TRUE(kinds.insert({visual.material, visual.mesh.uvs.empty()}).second)
            << visual.name << " is of a material that another visual has";
      }
      for (const PropVisual& visual : alone.parts[i].visuals) corners -= visual.mesh.indices.size();
      EXPECT_EQ(corners, 0u) << "corners more or less than those of all visuals together";
    }
  }
}

TEST(Props, HaveNamesOfTheirOwnAndATextEach) {
  std::set<std::string> names;
  for (const PropKind& kind : prop_catalogue()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_GT(std::string(kind.text).size(), 5u) << kind.name;
  }
  EXPECT_EQ(prop_kinds().size(), prop_catalogue().size());
}

TEST(Props, UnknownKindsAndAbsurdSizesAreRefused) {
  MaterialSet materials;
  const Result<Prop> unknown = make_prop({"sofaa"}, {}, &materials);
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(unknown.error().to_string(), HasSubstr("there is no prop 'sofaa'"));
  EXPECT_THAT(unknown.error().to_string(), HasSubstr("sofa"));
  for (const double edge : {0.0, -1.0, 101.0, std::nan("")})
    EXPECT_FALSE(make_prop({"sofa", 0, Vec3{1, edge, 1}}, {}, &materials).ok()) << edge;
}

}  // namespace
}  // namespace gloam
