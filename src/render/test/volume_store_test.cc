// Grids as they come from outside: bounds, replacement, and what is refused.

#include <gtest/gtest.h>

#include <limits>

#include "base/rng.h"
#include "render/test/media_probe.h"

namespace gloam {
namespace {

VolumeDescription random_volume(uint32_t seed) {
  const auto draw = [&](uint32_t i) { return philox4x32(seed, 1, i).v[0]; };
  VolumeDescription v;
  v.name = "random";
  v.nx = 1 + static_cast<int>(draw(0) % 300);
  v.ny = 1 + static_cast<int>(draw(1) % 20);
  v.nz = 1 + static_cast<int>(draw(2) % 20);
  if (seed % 3 == 0) v.fade = 0.3f;
  std::vector<float> values(static_cast<size_t>(v.nx) * v.ny * v.nz);
  for (size_t i = 0; i < values.size(); ++i) {
    const Philox4 d = philox4x32(seed, 2, i);
    values[i] = d.v[0] % 4 == 0 ? 0 : 10 * uniform_float(d.v[1]);
  }
  v.density = grid_of(std::move(values));
  return v;
}

TEST(VolumeStore, BoundsHoldEveryLookupAndAreNoWiderThanTheVoxelsRead) {
  for (uint32_t seed = 0; seed < 24; ++seed) {
    MediaBuilder b;
    const VolumeDescription v = b.add(random_volume(seed), b.add_medium({1, 1, 1}, {}));
    const VolumeStore store = b.build();
    const VolumeView& view = store.view().volumes[0];
    ASSERT_EQ(view.cells.size, static_cast<uint32_t>(view.cells_x * view.cells_y * view.cells_z));
    for (uint32_t c = 0; c < view.cells.size; ++c) {
      const int cell[3] = {static_cast<int>(c) % view.cells_x,
                           static_cast<int>(c) / view.cells_x % view.cells_y,
                           static_cast<int>(c) / view.cells_x / view.cells_y};
      float low = 1e30f, high = 0;
      const auto in_reach = [](int voxel, int cell_index) {
        return voxel >= cell_index * 8 - 1 && voxel <= cell_index * 8 + 8;
      };
      for (int z = 0; z < v.nz; ++z) {
        for (int y = 0; y < v.ny; ++y) {
          if (!in_reach(z, cell[2]) || !in_reach(y, cell[1])) continue;
          for (int x = 0; x < v.nx; ++x) {
            if (!in_reach(x, cell[0])) continue;
            const float value = (*v.density)[(static_cast<size_t>(z) * v.ny + y) * v.nx + x];
            low = min(low, value);
            high = max(high, value);
          }
        }
      }
      EXPECT_EQ(view.cells[c].high, high);
      EXPECT_EQ(view.cells[c].low, v.fade > 0 ? 0 : low);
    }
    // Along rays: every point of a step of the walk lies within the step's bounds.
    for (uint32_t i = 0; i < 200; ++i) {
      const Philox4 d = philox4x32(seed, 3, i);
      const Vec3f to{uniform_float(d.v[0]) - 0.5f, uniform_float(d.v[1]) - 0.5f,
                     uniform_float(d.v[2]) - 0.5f};
      const Vec3f from = i % 2 == 0 ? Vec3f{0.1f, -0.2f, 0.3f} : Vec3f{-2, 1, 1.5f};
      const Ray ray = make_ray(from, i % 5 == 0 ? Vec3f{1, -0.5f, -0.7f} : to - from);
      CellWalk walk;
      if (!walk.start(view, ray, 1e30f)) continue;
      int cells = 0;
      for (float t = walk.to(); walk.advance(); t = walk.to(), ++cells) {
        ASSERT_GE(walk.to(), t);
        for (int k = 0; k <= 16; ++k) {
          const Vec3f p = ray.o + ray.d * lerp(t, walk.to(), static_cast<float>(k) / 16);
          const float density = media::density_at(view, transform_point(view.X_GW, p));
          EXPECT_LE(density, walk.high() * (1 + 1e-5f) + 1e-6f);
          EXPECT_GE(density, walk.low() * (1 - 1e-5f) - 1e-6f);
        }
      }
      EXPECT_LE(cells, view.cells_x + view.cells_y + view.cells_z);
      EXPECT_GE(cells, 1);
    }
  }
}

TEST(VolumeStore, LookupsInterpolateBetweenTheCentresOfVoxels) {
  MediaBuilder b;
  VolumeDescription v;
  v.name = "ramp";
  v.nx = 4;
  v.ny = 2;
  v.nz = 3;
  v.size = {4, 2, 6};
  std::vector<float> values, heat;
  for (int i = 0; i < 24; ++i) {
    values.push_back(static_cast<float>(1 + i % 4 + 10 * (i / 4 % 2) + 100 * (i / 8)));
    heat.push_back(values.back() + 300);
  }
  v.density = grid_of(values);
  v.temperature = grid_of(heat);
  v.X_WV = rigid({0, 0, 1}, 0.5f * kPi, {10, 0, 0});  // V's x points along W's y
  b.add(v, b.add_medium({1, 1, 1}, {}));
  const VolumeStore store = b.build();
  const VolumeView& view = store.view().volumes[0];
  const auto at = [&](Vec3f p_V) {
    const Vec3f p_W{10 - p_V.y, p_V.x, p_V.z};
    EXPECT_NEAR(medium_at(store.view(), p_W, {}).extinction.x,
                media::density_at(view, transform_point(view.X_GW, p_W)), 1e-4);
    EXPECT_NEAR(media::temperature_at(view, transform_point(view.X_GW, p_W)),
                media::density_at(view, transform_point(view.X_GW, p_W)) + 300, 1e-3);
    return media::density_at(view, transform_point(view.X_GW, p_W));
  };
  EXPECT_NEAR(at({-1.5f, -0.5f, -2}), 1, 1e-4) << "the first voxel's centre";
  EXPECT_NEAR(at({1.5f, 0.5f, 2}), 214, 1e-3) << "the last one's";
  EXPECT_NEAR(at({-1.99f, -0.99f, -2.99f}), 1, 1e-4) << "constant up to the walls";
  EXPECT_NEAR(at({0, 0, 0}), 107.5f, 1e-3) << "the middle";
  EXPECT_NEAR(at({0.25f, -0.5f, 1}), 2.75f + 150, 1e-3);
  EXPECT_EQ(medium_at(store.view(), {0, 0, 0}, {}).extinction, Vec3f{}) << "outside";
}

TEST(VolumeStore, FadesTowardsTheWalls) {
  MediaBuilder b;
  VolumeDescription& box = b.add_box({2, 2, 2}, {}, 3, b.add_medium({1, 1, 1}, {}));
  box.fade = 0.5f;
  const VolumeStore store = b.build();
  const auto at = [&](float x) { return medium_at(store.view(), {x, 0, 0}, {}).extinction.x; };
  EXPECT_NEAR(at(0.3f), 3, 1e-5);
  EXPECT_NEAR(at(0.75f), 1.5f, 1e-4) << "half way";
  EXPECT_NEAR(at(0.9999f), 0, 1e-5);
  // The share of light that a fading box lets through: smoothstep's mean is one half.
  Mean mean;
  for (uint32_t i = 0; i < 20000; ++i) {
    Sampler s = independent(i);
    mean.add(transmittance(store.view(), make_ray({-3, 0, 0}, {1, 0, 0}), 9, {}, &s).x);
  }
  EXPECT_NEAR(mean.mean, std::exp(-3 * 1.5), 4.5 * mean.standard_error());
}

TEST(VolumeStore, EmptyGridsAndNoVolumesChangeNothing) {
  MediaBuilder none, empty;
  VolumeDescription v;
  v.name = "empty";
  v.nx = v.ny = v.nz = 20;
  v.density = grid_of(std::vector<float>(8000, 0.0f));
  empty.add(v, empty.add_medium({5, 5, 5}, {1, 1, 1}, {}, 1));
  for (const VolumeStore& store : {none.build(), empty.build(), VolumeStore()}) {
    const Ray ray = make_ray({-3, 0, 0}, {1, 0.01f, 0.02f});
    Sampler s = draw(1);
    EXPECT_EQ(transmittance(store.view(), ray, 9, {}, &s), (Vec3f{1, 1, 1}));
    const MediumEvent e = sample_distance(store.view(), ray, 9, {}, {1, 1, 1}, &s);
    EXPECT_EQ(e.volume, -1);
    EXPECT_EQ(e.t, 9);
    EXPECT_EQ(e.weight, (Vec3f{1, 1, 1}));
    EXPECT_EQ(e.emission, Vec3f{});
  }
}

TEST(VolumeStore, ReplacesOneVolumeAsIfMadeAnew) {
  MediaBuilder b;
  const int medium = b.add_medium({1, 2, 3}, {0.5f, 0.5f, 0.5f});
  b.add(make_noise_volume(40, 30, 20, 2, 1), medium);
  b.add(make_noise_volume(20, 20, 20, 2, 2), medium);
  VolumeStore store = b.build();
  const CellBounds* untouched = store.view().volumes[0].cells.data;
  std::vector<const CellBounds*> rooms;
  for (uint32_t seed = 3; seed < 9; ++seed) {
    VolumeDescription next = make_noise_volume(20, 20, 20, 2, seed);
    next.medium = medium;
    next.X_WV.p = {0, 0, 0.01f * static_cast<float>(seed)};
    ASSERT_TRUE(store.replace(1, next).ok());
    rooms.push_back(store.view().volumes[1].cells.data);
    b.volumes[1] = next;
    const VolumeStore fresh = b.build();
    for (uint32_t i = 0; i < 20; ++i) {
      Sampler s = draw(i), r = draw(i);
      const Ray ray = make_ray({-1, 0.1f, 0.05f}, {1, 0.1f, 0.01f * static_cast<float>(i)});
      EXPECT_EQ(transmittance(store.view(), ray, 9, {}, &s),
                transmittance(fresh.view(), ray, 9, {}, &r));
    }
  }
  EXPECT_EQ(store.view().volumes[0].cells.data, untouched);
  EXPECT_EQ(rooms[1], rooms[3]) << "two rooms for bounds take turns: nothing is allocated";
  EXPECT_EQ(rooms[2], rooms[4]);

  // Same grids, other shape: the bounds are not kept.
  VolumeDescription turned = b.volumes[1];
  turned.nx = 10;
  turned.ny = 40;
  ASSERT_TRUE(store.replace(1, turned).ok());
  EXPECT_EQ(store.view().volumes[1].cells_y, 5);
  EXPECT_EQ(store.view().volumes[1].cells.size, 2u * 5 * 3);

  // A rejected request changes nothing.
  const VolumeView before = store.view().volumes[1];
  VolumeDescription bad = turned;
  std::vector<float> values = *turned.density;
  values[10 * 40 * 7 + 10 * 3 + 4] = NAN;
  bad.density = grid_of(values);
  const Status refused = store.replace(1, bad);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message,
            "volume 'noise' has a density of nan in voxel (4, 3, 7); it must be 0 or more");
  EXPECT_EQ(store.view().volumes[1].cells.data, before.cells.data);
  EXPECT_EQ(store.view().volumes[1].density.data, before.density.data);
}

TEST(VolumeStore, RefusesWhatCannotBe) {
  const auto refusal = [](const std::function<void(MediaBuilder*)>& spoil) {
    MediaBuilder b;
    VolumeDescription v = make_noise_volume(4, 4, 4, 1, 1);
    b.add(v, b.add_medium({1, 1, 1}, {0.5f, 0.5f, 0.5f}));
    spoil(&b);
    auto store = VolumeStore::make(b.media, b.volumes);
    return store.ok() ? std::string("accepted") : store.error().to_string();
  };
  const auto with_value = [](float value, bool is_heat) {
    return [=](MediaBuilder* b) {
      std::vector<float> values(64, 1.0f);
      values[63] = value;
      (is_heat ? b->volumes[0].temperature : b->volumes[0].density) = grid_of(values);
    };
  };
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(refusal([](MediaBuilder*) {}), "accepted");
  const auto says = [&](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says(refusal(with_value(-1, false)), "density of -1 in voxel (3, 3, 3)");
  says(refusal(with_value(NAN, false)), "density of nan in voxel (3, 3, 3)");
  says(refusal(with_value(inf, false)), "density of inf in voxel (3, 3, 3)");
  says(refusal(with_value(NAN, true)), "temperature of nan in voxel (3, 3, 3)");
  says(refusal([](MediaBuilder* b) { b->volumes[0].nx = 5; }), "64 density values for 5 x 4 x 4");
  says(refusal([](MediaBuilder* b) { b->volumes[0].nz = 0; }), "at least one along each axis");
  says(refusal([](MediaBuilder* b) { b->volumes[0].medium = 1; }), "medium 1, which does not");
  says(refusal([](MediaBuilder* b) { b->volumes[0].medium = -1; }), "medium -1, which does not");
  says(refusal([](MediaBuilder* b) { b->volumes[0].size.y = 0; }), "must be positive");
  says(refusal([](MediaBuilder* b) { b->volumes[0].X_WV.x.x = 2; }), "not rigid");
  says(refusal([](MediaBuilder* b) { b->volumes[0].X_WV.p.z = NAN; }), "not rigid");
  says(refusal([](MediaBuilder* b) { b->volumes[0].fade = NAN; }), "fade of nan");
  says(refusal([](MediaBuilder* b) { b->volumes[0].even_density = -2; }), "density of -2");
  says(refusal([](MediaBuilder* b) { b->media[0].albedo[4] = 1.5f; }), "band 1550 nm");
  says(refusal([](MediaBuilder* b) { b->media[0].mass_extinction[0] = NAN; }), "mass extinction");
  says(refusal([](MediaBuilder* b) { b->media[0].g[1] = 1; }), "band green");
  says(refusal([](MediaBuilder* b) { b->media[0].emission = -1; }), "emission of -1");
  says(refusal([](MediaBuilder* b) { b->media[0].mass_extinction[5] = 1e30f; }),
       "extinction of up");
  says(refusal(with_value(1e9f, false)), "extinction of up to 4e+09 1/m");
  says(refusal([](MediaBuilder* b) { b->volumes.resize(33, b->volumes[0]); }), "limit is 32");
}

TEST(VolumeStore, RefusesHugeVolumesBeforeMemoryIsAskedFor) {
  const Status two_gib = check_volume_voxels("fog", 1024, 1024, 512);
  ASSERT_FALSE(two_gib.ok());
  EXPECT_EQ(two_gib.error().to_string(),
            "volume 'fog' has 1024 x 1024 x 512 voxels, 2 GiB per field; the limit is 1 GiB (use "
            "fewer voxels or several volumes)");
  EXPECT_TRUE(check_volume_voxels("fog", 1024, 1024, 256).ok());
  EXPECT_FALSE(check_volume_voxels("fog", INT64_MAX, INT64_MAX, INT64_MAX).ok());
  EXPECT_FALSE(check_volume_voxels("fog", int64_t{1} << 32, int64_t{1} << 32, 1).ok());
  EXPECT_FALSE(check_volume_voxels("fog", -1, -1, 1).ok());
  MediaBuilder b;
  b.add_box({1, 1, 1}, {}, 1, b.add_medium({1, 1, 1}, {})).nx = INT32_MAX;
  b.volumes[0].ny = b.volumes[0].nz = INT32_MAX;
  EXPECT_FALSE(VolumeStore::make(b.media, b.volumes).ok());
}

/// Along rays through a plume: how many densities ratio tracking has to look up.
TEST(VolumeStore, BoundsByCellsSaveMostLookups) {
  MediaBuilder b;
  b.add(make_plume(64, 1, 293), b.add_medium({20, 20, 20}, {}));
  const VolumeStore store = b.build();
  const VolumeView& view = store.view().volumes[0];
  float highest = 0;
  for (uint32_t i = 0; i < view.cells.size; ++i) highest = max(highest, view.cells[i].high);
  double by_cells = 0, by_one = 0, cells = 0;
  int rays = 0;
  for (uint32_t i = 0; i < 2000; ++i) {
    const Philox4 d = philox4x32(1, 2, i);
    const Vec3f o{-2, 0.8f * uniform_float(d.v[0]) - 0.4f, 1.8f * uniform_float(d.v[1]) - 0.9f};
    CellWalk walk;
    if (!walk.start(view, make_ray(o, {1, 0.1f, 0.05f}), 1e30f)) continue;
    ++rays;
    for (float t = walk.to(); walk.advance(); t = walk.to()) {
      by_cells += 20 * (walk.high() - walk.low()) * (walk.to() - t);
      by_one += 20 * highest * (walk.to() - t);
      ++cells;
    }
  }
  RecordProperty("cells_per_ray", std::to_string(cells / rays));
  RecordProperty("lookups_per_ray", std::to_string(by_cells / rays));
  RecordProperty("lookups_per_ray_one_bound", std::to_string(by_one / rays));
  EXPECT_LT(by_cells, 0.5 * by_one) << by_cells / rays << " against " << by_one / rays;
  EXPECT_LT(cells / rays, 20);
}

}  // namespace
}  // namespace gloam
