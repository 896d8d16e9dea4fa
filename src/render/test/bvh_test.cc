// Our own BVH sees what Embree sees, and what brute force over all triangles sees.

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/test/probe.h"
#include "world/shapes/visual_mesh.h"

namespace gloam {
namespace {

/// All shapes, still and moving (within the shutter too), two large meshes of which one stands in
/// several places, one that changes its form, and a floor without end.
struct Zoo {
  SceneBuilder builder;
  PoseFrame close;  ///< the second of three keys: all goes back to where it was

  explicit Zoo(int rings) {
    SceneBuilder& b = builder;
    const int material = b.add_diffuse({0.5f, 0.5f, 0.5f});
    MaterialDescription half;
    half.opacity = 0.5f;
    const int sheer = b.add_material(half);
    const int ball = b.add_mesh(make_ball(rings, 0.2f));
    const int crate = b.add_mesh(make_box({0.3f, 0.5f, 0.2f}));
    const ShapeType shapes[] = {ShapeType::kBox,     ShapeType::kSphere,   ShapeType::kEllipsoid,
                                ShapeType::kCapsule, ShapeType::kCylinder, ShapeType::kPlane,
                                ShapeType::kMesh,    ShapeType::kMesh};
    Sampler sampler = draw(0, 11);
    const auto uniform = [&](float low, float high) {
      return low + (high - low) * sampler.next_1d();
    };
    std::vector<std::pair<int, Affine3f>> ends;
    for (int i = 0; i < 96; ++i) {
      const ShapeType shape = shapes[i % 8];
      const Vec3f size{uniform(0.05f, 0.5f), uniform(0.05f, 0.5f), uniform(0.05f, 0.5f)};
      const Vec3f axis = normalize(Vec3f{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1) + 1e-3f});
      const Vec3f p{uniform(-4, 4), uniform(-4, 4), uniform(0, 4)};
      const float angle = uniform(0, 6);
      int body = 0;
      if (i % 3 != 0) body = b.add_body(rigid(axis, angle, p));
      if (i % 3 == 2) {
        ends.push_back({body, rigid(axis, angle + uniform(0, 0.3f),
                                    p + Vec3f{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)})});
      }
      const int mesh = i % 8 == 6 ? ball : (i % 8 == 7 ? crate : -1);
      b.add(shape, size, body == 0 ? rigid(axis, angle, p) : translation({0.1f, 0, 0}),
            i % 5 == 0 ? sheer : material, body, mesh);
    }
    b.add(ShapeType::kPlane, {0, 0, 1}, translation({0, 0, -1}), material);
    DeformableDescription jelly;
    jelly.rest = make_ball(24, 0.4f);
    b.description.deformables.push_back(jelly);
    b.add(ShapeType::kDeformable, {}, {}, material, 0, 0);
    b.description.instances.back().is_static = false;
    close = b.frame;
    for (const Vec3f& p : jelly.rest.positions) {
      for (const float v : {p.x, p.y, p.z + 2}) b.frame.vertices.push_back(v);
      for (const float v : {1.5f * p.x + 1, p.y, 0.7f * p.z + 2}) close.vertices.push_back(v);
    }
    for (const auto& [body, X_WB] : ends) SceneBuilder::set_body(&close, body, X_WB);
  }
};

/// Kind of the last update: motion within the shutter, or a later instant without motion. A later
/// instant refits the trees of changed forms, and is requested twice, as by two sensors.
enum class Update { kShutter, kInstant };

class BothTrees {
 public:
  explicit BothTrees(int rings, Update last = Update::kShutter)
      : zoo_(rings), traced_(trace_scene(zoo_.builder, true)) {
    const PoseFrame* const keys[] = {&zoo_.builder.frame, &zoo_.close, &zoo_.builder.frame};
    traced_.update({keys, 1}, zoo_.builder.frame);
    if (last == Update::kShutter) traced_.update(keys, zoo_.builder.frame);
    for (int sensor = 0; sensor < 2 && last == Update::kInstant; ++sensor)
      traced_.update({keys + 1, 1}, zoo_.close);
    theirs = traced_.tracer();
    ours = traced_.own().tracer(traced_.scene());
    view = traced_.scene().view_from({});
  }
  bool is_mesh(uint32_t instance) const {
    return gloam::is_mesh(traced_.scene().instances()[instance].shape);
  }
  CpuTracer theirs;
  BvhTracer ours;
  SceneView view;

 private:
  Zoo zoo_;
  TracedScene traced_;
};

Ray random_ray(uint32_t i) {
  Sampler sampler = draw(i, 5);
  const Vec2f a = sampler.next_2d(), b = sampler.next_2d(), c = sampler.next_2d();
  Vec3f d = sample_sphere(c);
  if (i % 16 == 0) d = {i % 32 == 0 ? 1.0f : -1.0f, 0, 0};
  if (i % 16 == 1) d = {0, d.y, d.z};
  Ray ray = make_ray({(a.x * 2 - 1) * 6, (a.y * 2 - 1) * 6, b.x * 6 - 0.5f}, d);
  ray.time = i % 4 == 0 ? 0.0f : b.y;
  if (i % 8 == 3) ray.tmax = 2;
  return ray;
}

TEST(Bvh, AShadowRayAndARayTogetherHitWhatTheyHitAlone) {
  const BothTrees both(20);
  int blocked = 0, hits = 0;
  for (uint32_t i = 0; i < 100'000; ++i) {
    Ray shadow = random_ray(2 * i), ray = random_ray(2 * i + 1);
    ray.time = shadow.time;  // of one path
    if (i % 3 == 1) shadow.tmax = 0;
    if (i % 3 == 2) ray.tmax = 0;
    RayHit none, alone, together;
    const bool blocks = shadow.tmax > 0 && both.ours.trace(shadow, true, &none);
    const bool found = ray.tmax > 0 && both.ours.trace(ray, false, &alone);
    bool shadowed;
    ASSERT_EQ(both.ours.trace_both(shadow, ray, &shadowed, &together), found) << i;
    ASSERT_EQ(shadowed, blocks) << i;
    blocked += blocks;
    hits += found;
    if (!found) continue;
    ASSERT_EQ(alone.t, together.t) << i;
    ASSERT_EQ(alone.instance, together.instance) << i;
    ASSERT_EQ(alone.primitive, together.primitive) << i;
    ASSERT_EQ(alone.normal, together.normal) << i;
  }
  EXPECT_GT(blocked, 20'000);
  EXPECT_GT(hits, 20'000);
}

// Surfaces that may let light through neither hide others nor stay unnoticed.
TEST(Bvh, ARayIsHiddenByWhatLetsNoLightThrough) {
  const BothTrees both(20);
  int hidden = 0, open = 0, missed = 0;
  for (uint32_t i = 0; i < 50'000; ++i) {
    const Ray ray = random_ray(i);
    RayHit hit;
    bool clear;
    const bool blocks = both.ours.trace(both.view, ray, true, &hit, &clear);
    bool opaque = false, any = false;
    for (Ray rest = ray; !opaque && rest.tmax > 0 && both.ours.trace(rest, false, &hit);) {
      any = true;
      opaque = !both.view.materials[both.view.instances[hit.instance].material].transparent;
      const float step = hit.t + 1e-4f;
      rest.o = rest.o + rest.d * step;
      rest.tmax -= step;
    }
    ASSERT_TRUE(blocks || clear || !any) << i;
    missed += blocks != opaque;  // edges within a step, and behind clear solids that are scanned
    hidden += blocks;
    open += !blocks && any;
  }
  EXPECT_GT(hidden, 10'000);
  EXPECT_GT(open, 1'000);
  EXPECT_LT(missed, 100);
}

TEST(Bvh, ARayHitsTheSameByStepsAndByRuns) {
  const BothTrees both(20);
  const BvhSolids solids{both.ours.scanned.instances};
  int hits = 0;
  for (uint32_t i = 0; i < 100'000; ++i) {
    const Ray ray = random_ray(i);
    const bool any = i % 5 == 0;
    BvhHit a, b;
    const bool by_runs =
        traverse<true, false>(both.ours.bvh, solids, ray.o, ray.d, ray.time, ray.tmax, any, &a);
    const bool by_steps =
        traverse<true, true>(both.ours.bvh, solids, ray.o, ray.d, ray.time, ray.tmax, any, &b);
    ASSERT_EQ(by_steps, by_runs) << i;
    if (!by_runs || any) continue;
    ++hits;
    ASSERT_EQ(b.t, a.t) << i;
    ASSERT_EQ(b.id, a.id) << i;
    ASSERT_EQ(b.primitive, a.primitive) << i;
    ASSERT_EQ(b.u, a.u) << i;
    ASSERT_EQ(b.v, a.v) << i;
  }
  EXPECT_GT(hits, 10'000) << "the rest hits what stands outside the tree";
}

TEST(Bvh, ARayHitsAHillThatGrowsOutOfTheGround) {
  SceneBuilder b;
  const HeightFieldDescription field{
      .mesh = 0, .rows = 5, .columns = 5, .size = {1, 1, 1}, .base = 0.1f};
  b.frame.height_field.assign(25, 0);
  b.add_mesh(height_field_mesh(field, b.frame.height_field));
  b.description.height_fields.push_back(field);
  b.add(ShapeType::kMesh, {}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}), 0, 0);
  // Beside it, a ball that changes its form: Embree then builds in two levels.
  DeformableDescription ball;
  ball.rest = make_ball(8, 0.2f);
  for (const Vec3f& p : ball.rest.positions)
    for (const float v : {p.x, p.y, p.z + 5}) b.frame.vertices.push_back(v);
  b.description.deformables.push_back(ball);
  b.add(ShapeType::kDeformable, {}, {}, 0, 0, 0);
  TracedScene traced = trace_scene(b, true);
  const PoseFrame* const flat[] = {&b.frame};
  traced.update(flat, b.frame);
  PoseFrame hilly = b.frame;
  std::ranges::fill(hilly.height_field, 0.8f);
  ++hilly.height_field_serial;
  const PoseFrame* const now[] = {&hilly};
  traced.update(now, hilly);
  RayHit hit;
  ASSERT_TRUE(traced.tracer().trace(make_ray({-5, 0.1f, 0.6f}, {1, 0, 0}), false, &hit))
      << "above all that was there before";
  EXPECT_NEAR(hit.t, 4, 1e-4);
}

class BvhAfter : public testing::TestWithParam<Update> {};
INSTANTIATE_TEST_SUITE_P(Updates, BvhAfter, testing::Values(Update::kShutter, Update::kInstant));

TEST_P(BvhAfter, AMillionRaysHitWhatTheyHitInEmbree) {
  const BothTrees both(120, GetParam());  // 57,600 triangles a ball
  if (both.theirs.own) GTEST_SKIP() << "this build has no Embree to compare with";
  constexpr int kRays = 1'000'000;
  struct Count {
    int hits = 0, lost = 0, gained = 0, far = 0, other_thing = 0, other_any = 0, turned = 0;
    double worst = 0;
    float worst_corner = 0;
  };
  std::vector<Count> counts(64);
  parallel_for("rays", 64, [&](int64_t part) {
    Count& n = counts[static_cast<size_t>(part)];
    for (int i = 0; i < kRays / 64; ++i) {
      const Ray ray = random_ray(static_cast<uint32_t>(part * (kRays / 64) + i));
      RayHit a, b;
      const bool theirs = both.theirs.trace(ray, false, &a), ours = both.ours.trace(ray, false, &b);
      RayHit none;
      n.other_any += both.ours.trace(ray, true, &none) != ours;
      n.lost += theirs && !ours;
      n.gained += ours && !theirs;
      if (!ours || !theirs) continue;
      ++n.hits;
      // The scene is some metres wide: that is what a distance is rounded to.
      const double error = std::fabs(double{a.t} - b.t) / std::max(1.0, double{a.t});
      if (error > 1e-5) {  // at grazing incidence the distance itself is not sharp
        ++n.far;
      } else {
        n.worst = std::max(n.worst, error);
        const bool mesh = both.is_mesh(b.instance);  // to Embree boxes are triangles
        n.other_thing += a.instance != b.instance || (mesh && a.primitive != b.primitive);
        if (mesh && a.instance == b.instance && a.primitive == b.primitive) {
          n.turned += dot(normalize(a.normal), normalize(b.normal)) < 1 - 1e-4f;
          n.worst_corner = std::max({n.worst_corner, std::fabs(a.u - b.u), std::fabs(a.v - b.v)});
        }
      }
    }
  });
  Count all;
  for (const Count& n : counts) {
    all.hits += n.hits, all.lost += n.lost, all.gained += n.gained, all.far += n.far;
    all.other_thing += n.other_thing, all.other_any += n.other_any, all.turned += n.turned;
    all.worst = std::max(all.worst, n.worst);
    all.worst_corner = std::max(all.worst_corner, n.worst_corner);
  }
  std::printf(
      "%d hits, %d lost, %d gained, %d farther than 1e-5 apart, %d other ids, worst %.2g, corner "
      "%.2g\n",
      all.hits, all.lost, all.gained, all.far, all.other_thing, all.worst,
      static_cast<double>(all.worst_corner));
  EXPECT_GT(all.hits, kRays / 2);
  EXPECT_LE(all.lost + all.gained, 2);
  EXPECT_LE(all.far, kRays / 10'000);
  EXPECT_LE(all.other_thing, kRays / 20'000);
  EXPECT_EQ(all.turned, 0);
  EXPECT_LE(all.worst_corner, 0.01f);
  EXPECT_LE(all.other_any, 2);
}

}  // namespace
}  // namespace gloam
