// Eight lanes compute what one float computes, bit for bit.

#include <gtest/gtest.h>

#include <cstring>

#include "render/test/probe.h"

namespace gloam {
namespace {

uint32_t bits(float x) {
  uint32_t out;
  std::memcpy(&out, &x, sizeof out);
  return out;
}

template <class Function>
void expect_equal_lanes(const char* name, float low, float high, const Function& function) {
  for (int round = 0; round < 200; ++round) {
    FloatLanes x;
    for (int i = 0; i < kLaneCount; ++i) {
      Sampler sampler = draw(static_cast<uint32_t>(round * kLaneCount + i));
      set_lane(&x, i, low + (high - low) * sampler.next_1d());
    }
    const FloatLanes y = function(x);
    for (int i = 0; i < kLaneCount; ++i) {
      EXPECT_EQ(bits(lane(y, i)), bits(function(lane(x, i)))) << name << " of " << lane(x, i);
    }
  }
}

TEST(Lanes, FunctionsOfOneNumberEqualTheFloats) {
  expect_equal_lanes("square_root", 0, 9, [](auto x) { return square_root(x); });
  expect_equal_lanes("floor_of", -9, 9, [](auto x) { return floor_of(x); });
  expect_equal_lanes("magnitude", -9, 9, [](auto x) { return magnitude(x); });
  expect_equal_lanes("to_uint", 0, 1e6f, [](auto x) { return to_float(to_uint(x)); });
  expect_equal_lanes("min and max", -9, 9, [](auto x) { return min(max(x, -2.0f), 3.0f); });
  expect_equal_lanes("mis_weight", 0, 9, [](auto x) { return mis_weight(x, x * x); });
  expect_equal_lanes("natural_log", 1e-6f, 9, [](auto x) { return natural_log(x); });
  expect_equal_lanes("sincos_turn", 0, 0.9999999f, [](auto x) {
    decltype(x) s, c;
    sincos_turn(x, &s, &c);
    return s + c * 3.0f;
  });
}

TEST(Lanes, SamplersDrawTheSameNumbersAndWaitWhereInactive) {
  UintLanes pixel;
  for (uint32_t i = 0; i < kLaneCount; ++i) set_lane(&pixel, static_cast<int>(i), 37 * i + 5);
  auto lanes = SamplerOf<FloatLanes>::make(7, 3, pixel, pixel, 2u, 4);
  Sampler single[kLaneCount];
  for (int i = 0; i < kLaneCount; ++i) {
    single[i] = Sampler::make(7, 3, lane(pixel, i), lane(pixel, i), 2, 4);
  }
  for (int draws = 0; draws < 30; ++draws) {
    MaskLanes active;
    for (int i = 0; i < kLaneCount; ++i) set_lane(&active, i, (draws + i) % 3 != 0);
    const FloatLanes a = lanes.next_1d(active);
    const Vec2Of<FloatLanes> b = lanes.next_2d();
    for (int i = 0; i < kLaneCount; ++i) {
      if (lane(active, i)) {
        EXPECT_EQ(lane(a, i), single[i].next_1d());
      }
      const Vec2f expected = single[i].next_2d();
      EXPECT_EQ(lane(b.x, i), expected.x);
      EXPECT_EQ(lane(b.y, i), expected.y);
    }
  }
}

/// Traces the rays of lanes one by one: packets round otherwise, and now and then a ray takes
/// another way.
struct OneByOne {
  const CpuTracer& tracer;

  MaskLanes closest(const RayOf<FloatLanes>& ray, MaskLanes active, bool coherent,
                    RayHitOf<FloatLanes>* hit) const {
    MaskLanes found;
    each_lane(active, [&](int i) {
      RayHit one;
      set_lane(&found, i, tracer.closest(lane(ray, i), true, coherent, &one));
      set_lane(&hit->t, i, one.t);
      set_lane(&hit->instance, i, one.instance);
      set_lane(&hit->primitive, i, one.primitive);
      set_lane(&hit->u, i, one.u);
      set_lane(&hit->v, i, one.v);
      set_lane(&hit->normal, i, one.normal);
    });
    return found;
  }
  MaskLanes occluded(const RayOf<FloatLanes>& ray, MaskLanes active) const {
    MaskLanes found;
    each_lane(active, [&](int i) { set_lane(&found, i, tracer.occluded(lane(ray, i), true)); });
    return found;
  }
};

/// Every kind of light, material and shape that takes another way through the path stage.
SceneBuilder varied_scene() {
  SceneBuilder b;
  MaterialDescription glossy;
  glossy.base_color = {0.7f, 0.6f, 0.5f};
  glossy.roughness = 0.3f;
  MaterialDescription metal = glossy;
  metal.metallic = 1;
  MaterialDescription pane = glossy;
  pane.opacity = 0.4f;
  MaterialDescription tiles = glossy;
  tiles.mapping = TextureMapping::kUv;
  tiles.texture_repeat = {3, 3};
  tiles.textures.base_color = b.add_texture(make_checker(64, 2, 60, 220));
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_material(tiles));
  b.add(ShapeType::kBox, {3, 0.1f, 2}, translation({0, 3, 1}), b.add_material(glossy));
  b.add(ShapeType::kSphere, {0.4f, 0, 0}, translation({-1, 1, 0.4f}), b.add_material(metal));
  b.add(ShapeType::kBox, {0.5f, 0.01f, 0.5f}, translation({0.3f, -0.5f, 0.6f}),
        b.add_material(pane));
  b.add(ShapeType::kMesh, {}, translation({1, 1, 0.5f}), b.add_diffuse({0.2f, 0.6f, 0.3f}), 0,
        b.add_mesh(make_ball(16, 0.1f)));
  b.add(ShapeType::kBox, {0.4f, 0.4f, 0.01f}, translation({0.5f, 0, 2.5f}),
        b.add_emitter({300, 280, 250}));
  b.add(ShapeType::kSphere, {0.1f, 0, 0}, translation({-1.5f, 0, 1.5f}),
        b.add_emitter({900, 900, 900}));
  b.add(ShapeType::kCapsule, {0.05f, 0.3f, 0}, translation({1.8f, 0.5f, 1}),
        b.add_emitter({200, 100, 50}));
  MaterialDescription glass = glossy;
  glass.transmission_weight = 1;
  glass.roughness = 0.1f;
  glass.transmission_color = {0.7f, 0.9f, 0.8f};
  glass.transmission_depth = 0.2f;
  b.add(ShapeType::kSphere, {0.25f, 0, 0}, translation({-0.6f, -0.9f, 0.3f}),
        b.add_material(glass));
  MaterialDescription sheet = glass;
  sheet.thin_walled = true;
  sheet.roughness = 0;
  b.add(ShapeType::kBox, {0.3f, 0.005f, 0.3f}, translation({1.3f, -1, 0.4f}),
        b.add_material(sheet));
  MaterialDescription car = glossy;
  car.coat_weight = 1;
  car.coat_roughness = 0.1f;
  car.fuzz_weight = 0.3f;
  b.add(ShapeType::kBox, {0.2f, 0.2f, 0.2f}, translation({-1.6f, -0.3f, 0.2f}),
        b.add_material(car));
  LightDescription lamp;
  lamp.intensity = {50, 60, 70};
  lamp.radius = 0.1f;
  b.add_light(lamp, {0, 1, 2});
  lamp.radius = 0;
  lamp.type = PunctualLightType::kSpot;
  b.add_light(lamp, {-1, -1, 2}, normalize(Vec3f{0.3f, 0.5f, -1}));
  LightDescription sun;
  sun.type = PunctualLightType::kDirectional;
  sun.intensity = {100, 100, 90};
  sun.radius = 0.01f;
  b.add_light(sun, {0, 0, 5}, normalize(Vec3f{0.2f, 0.6f, -1}));
  b.description.sky.ambient = {5, 6, 8};
  b.description.extent = 4;
  return b;
}

/// The same under a map of the sky, in glowing fog, with a lamp that has a profile.
SceneBuilder foggy_scene() {
  SceneBuilder b = varied_scene();
  EnvironmentDescription& map = b.description.sky.environment;
  map = {"map", 32, 16, {}};
  for (int i = 0; i < 32 * 16; ++i) {
    map.texels.push_back(Vec3f{5, 6, 8} * (i == 100 ? 500.0f : 1.0f));
  }
  IesProfile profile;
  profile.rows = 3;
  profile.columns = 2;
  profile.candela = {3, 3, 2, 1, 0, 0};
  profile.most = 3;
  b.description.ies_profiles = {profile};
  b.description.lights[0].profile = 0;
  MediumDescription fog;
  fog.mass_extinction = {0.1f, 0.2f, 0.3f, 0, 0, 0};
  fog.albedo = {0.9f, 0.8f, 0.7f, 0, 0, 0};
  fog.g = {0.7f, 0.6f, 0.5f, 0, 0, 0};
  fog.emission = 1e-4f;
  b.description.media = {fog};
  VolumeDescription box;
  box.size = {4, 4, 4};
  box.even_density = 1;
  box.even_temperature = 1500;
  box.fade = 0.5f;
  b.description.volumes = {box};
  return b;
}

class LanePaths : public testing::TestWithParam<bool> {};

CameraView32 camera_of_64_by_48() {
  const CameraView view = SceneBuilder::camera(look_at({0, -4, 1.8f}, {0, 0.5f, 0.6f}), 64, 48, 55);
  CameraView32 camera;
  camera.fx = camera.fy = static_cast<float>(view.intrinsics.fx);
  camera.cx = static_cast<float>(view.intrinsics.cx);
  camera.cy = static_cast<float>(view.intrinsics.cy);
  camera.pose = {view.X_WC_open, view.X_WC_open, {}};
  return camera;
}

TEST(Lanes, RaysOfCamerasEqualSingleOnes) {
  for (const float aperture : {0.0f, 0.05f}) {
    CameraView32 camera = camera_of_64_by_48();
    camera.aperture = {aperture, 3};
    Vec2Of<FloatLanes> lens, pixel;
    for (int i = 0; i < kLaneCount; ++i) {
      Sampler sampler = draw(static_cast<uint32_t>(i));
      set_lane(&lens, i, sampler.next_2d());
      set_lane(&pixel, i, sampler.next_2d());
    }
    const Vec2Of<FloatLanes> offset = sample_pixel_filter(pixel);
    RayConeOf<FloatLanes> cones;
    const RayOf<FloatLanes> rays =
        camera_rays(camera, offset.x + 9.5f, offset.y + 7.5f, FloatLanes(0.5f), &cones, &lens);
    for (int i = 0; i < kLaneCount; ++i) {
      const Vec2f at = lane(lens, i), from = sample_pixel_filter(lane(pixel, i));
      RayCone cone;
      const Ray ray = camera_ray(camera, from.x + 9.5f, from.y + 7.5f, 0.5f, &cone, &at);
      EXPECT_EQ(ray.o, lane(rays.o, i));
      EXPECT_EQ(ray.d, lane(rays.d, i));
      EXPECT_EQ(ray.time, lane(rays.time, i));
      EXPECT_EQ(cone.spread, lane(cones.spread, i));
    }
  }
}

TEST_P(LanePaths, EqualThoseOfOneFloat) {
  const SceneBuilder b = GetParam() ? foggy_scene() : varied_scene();
  Probe probe(b);
  probe.guide();
  ASSERT_GT(probe.view.guide.nx, 0);
  const CameraView32 camera = camera_of_64_by_48();
  const PathOptions options{6, 2};
  int different = 0, lit = 0;
  for (int first = 0; first < 64 * 48; first += kLaneCount) {
    UintLanes x, y;
    RayOf<FloatLanes> ray;
    FloatLanes width, spread;
    MaskLanes active;
    Ray rays[kLaneCount];
    RayCone cones[kLaneCount];
    for (int i = 0; i < kLaneCount; ++i) {
      const uint32_t px = static_cast<uint32_t>((first + i) % 64),
                     py = static_cast<uint32_t>((first + i) / 64);
      set_lane(&x, i, px);
      set_lane(&y, i, py);
      rays[i] = camera_ray(camera, static_cast<float>(px) + 0.5f, static_cast<float>(py) + 0.5f, 0,
                           &cones[i]);
      set_lane(&ray.o, i, rays[i].o);
      set_lane(&ray.d, i, rays[i].d);
      set_lane(&width, i, cones[i].width);
      set_lane(&spread, i, cones[i].spread);
      set_lane(&active, i, (first + i) % 7 != 0);
    }
    const auto lanes = trace_path(probe.view, OneByOne{probe.tracer}, ray, width, spread, options,
                                  SamplerOf<FloatLanes>::make(1, 0, x, y, 0u, 0), active);
    for (int i = 0; i < kLaneCount; ++i) {
      const Vec3f radiance = lane(lanes.radiance, i);
      if (!lane(active, i)) {
        EXPECT_EQ(lane(lanes.rays, i), 0u) << "an inactive lane was traced";
        continue;
      }
      const PathResult one =
          trace_path(probe.view, probe.tracer, rays[i], cones[i].width, cones[i].spread, options,
                     Sampler::make(1, 0, lane(x, i), lane(y, i), 0, 0));
      lit += one.radiance.x > 0;
      different += !(one.radiance == radiance) || one.rays != lane(lanes.rays, i);
    }
  }
  EXPECT_GT(lit, 1500) << "the scene is too dark to compare";
  EXPECT_EQ(different, 0) << "paths in lanes differ from single paths";
}

TEST_P(LanePaths, MayBeginWhileOthersGoOn) {
  Probe probe(GetParam() ? foggy_scene() : varied_scene());
  probe.guide();
  const CameraView32 camera = camera_of_64_by_48();
  const PathOptions options{6, 2};
  constexpr int kPaths = 64 * 48;
  std::vector<PathResult> results(kPaths);
  paths::State<FloatLanes> path;
  MaskLanes active = false;
  int path_of[kLaneCount] = {}, begun = 0, mixed = 0;
  while (begun < kPaths || any(active)) {
    mixed += any(active) && any(!active) && begun < kPaths;
    paths::CameraSampleOf<FloatLanes> start;
    UintLanes x, y;
    MaskLanes starting = false;
    each_lane(!active, [&](int i) {
      if (begun == kPaths) return;
      path_of[i] = begun++;
      set_lane(&starting, i, true);
      set_lane(&x, i, static_cast<uint32_t>(path_of[i] % 64));
      set_lane(&y, i, static_cast<uint32_t>(path_of[i] / 64));
      RayCone cone;
      const Ray ray = camera_ray(camera, static_cast<float>(lane(x, i)) + 0.5f,
                                 static_cast<float>(lane(y, i)) + 0.5f, 0, &cone);
      set_lane(&start.ray.o, i, ray.o);
      set_lane(&start.ray.d, i, ray.d);
      set_lane(&start.cone_width, i, cone.width);
      set_lane(&start.cone_spread, i, cone.spread);
    });
    start.sampler = SamplerOf<FloatLanes>::make(1, 0, x, y, 0u, 0);
    path.start(start, starting);
    const MaskLanes before = active | starting;
    active = paths::advance(probe.view, OneByOne{probe.tracer}, options, false, &path, before);
    each_lane(before & !active, [&](int i) {
      PathResult& result = results[static_cast<size_t>(path_of[i])];
      result.radiance = lane(path.result.radiance, i);
      result.albedo = lane(path.result.albedo, i);
      result.normal = lane(path.result.normal, i);
      result.rays = lane(path.result.rays, i);
    });
  }
  EXPECT_GT(mixed, 100) << "hardly a path began while another went on";
  int different = 0;
  for (uint32_t i = 0; i < kPaths; ++i) {
    RayCone cone;
    const Ray ray = camera_ray(camera, static_cast<float>(i % 64) + 0.5f,
                               static_cast<float>(i / 64) + 0.5f, 0, &cone);
    const PathResult one = trace_path(probe.view, probe.tracer, ray, cone.width, cone.spread,
                                      options, Sampler::make(1, 0, i % 64, i / 64, 0, 0));
    const PathResult& r = results[i];
    different += !(one.radiance == r.radiance && one.albedo == r.albedo && one.normal == r.normal &&
                   one.rays == r.rays);
  }
  EXPECT_EQ(different, 0) << "a path keeps something of the one before it in its lane";
}

INSTANTIATE_TEST_SUITE_P(ClearAndFoggy, LanePaths, testing::Bool());

}  // namespace
}  // namespace gloam
