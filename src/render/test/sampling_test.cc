// Every sampler against its density, and the sample points themselves.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <set>

#include "base/rng.h"
#include "render/scene/albedo_table.h"
#include "render/test/direction_check.h"
#include "render/test/panel.h"
#include "render/test/probe.h"

namespace gloam {
namespace {

TEST(Sampling, DomainsMatchTheirDensities) {
  check_directions(
      [](uint32_t i, Vec3f* d) {
        *d = sample_sphere(random_2d(i, 0));
        return true;
      },
      [](Vec3f) { return 1 / (4 * kPi); }, "sphere");
  check_directions(
      [](uint32_t i, Vec3f* d) {
        *d = sample_cosine_hemisphere(random_2d(i, 0));
        return true;
      },
      [](Vec3f d) { return std::max(0.0f, d.z) / kPi; }, "cosine");
  const float one_minus_cos = 0.25f;
  check_directions(
      [&](uint32_t i, Vec3f* d) {
        *d = sample_cone(one_minus_cos, random_2d(i, 0));
        return true;
      },
      [&](Vec3f d) { return d.z > 0.75f ? cone_pdf(one_minus_cos) : 0.0f; }, "cone");
}

Bsdf make_plain(const AlbedoTable& table, Vec3f color, float metallic, float roughness, Vec3f wo) {
  return make_bsdf(table, color, color, metallic, 1.0f, roughness, 0.04f, 1.0f, 0.0f, wo);
}

TEST(Sampling, BsdfMatchesItsDensity) {
  AlbedoTable table;
  fill_albedo_table(&table);
  for (const float roughness : {0.35f, 0.6f, 1.0f}) {
    for (const float metallic : {0.0f, 1.0f}) {
      for (const float cos_o : {0.95f, 0.5f, 0.15f}) {
        const Vec3f wo{std::sqrt(1 - cos_o * cos_o), 0, cos_o};
        const Bsdf bsdf = make_plain(table, {0.6f, 0.5f, 0.4f}, metallic, roughness, wo);
        check_bsdf(bsdf, wo,
                   fmt::format("roughness {} metallic {} cos {}", roughness, metallic, cos_o));
      }
    }
  }
}

TEST(Sampling, BsdfNeverGainsEnergyAndWhiteLosesNone) {
  AlbedoTable table;
  fill_albedo_table(&table);
  for (const float roughness : {0.05f, 0.1f, 0.2f, 0.4f, 0.7f, 1.0f}) {
    for (const float cos_o : {1.0f, 0.7f, 0.4f, 0.2f, 0.08f}) {
      const Vec3f wo{std::sqrt(1 - cos_o * cos_o), 0, cos_o};
      for (const float metallic : {0.0f, 0.5f, 1.0f}) {
        const Bsdf white = make_plain(table, {1, 1, 1}, metallic, roughness, wo);
        Mean mean;
        for (uint32_t i = 0; i < 20000; ++i) {
          const BsdfSample s = sample_bsdf(white, wo, random_2d(i, 1).x, random_2d(i, 0));
          mean.add(s.pdf > 0 ? s.weight.x : 0);
        }
        EXPECT_NEAR(mean.mean, 1, 4 * mean.standard_error() + 6e-3)
            << "roughness " << roughness << " cos " << cos_o << " metallic " << metallic;
      }
    }
  }
}

TEST(Sampling, DielectricLayerMatchesBruteForceAlbedo) {
  AlbedoTable table;
  fill_albedo_table(&table);
  for (const float roughness : {0.3f, 0.8f}) {
    for (const float cos_o : {0.9f, 0.3f}) {
      const Vec3f wo{std::sqrt(1 - cos_o * cos_o), 0, cos_o};
      const Bsdf bsdf = make_plain(table, {0, 0, 0}, 0.0f, roughness, wo);
      Mean brute;  // uniform directions: independent of the layer's own sampling
      for (uint32_t i = 0; i < 400000; ++i) {
        Vec3f wi = sample_sphere(random_2d(i, 0));
        wi.z = std::fabs(wi.z);
        float pdf = 0;
        brute.add(eval_bsdf(bsdf, wo, wi, &pdf).x * 2 * kPi);
      }
      float a = 0, b = 0;
      layer_albedo(table, roughness, cos_o, &a, &b);
      const double gain = 1 + 0.04 * (1 - (a + b)) / (a + b);
      EXPECT_NEAR(brute.mean, (0.04 * a + b) * gain, 4 * brute.standard_error() + 1e-3);
    }
  }
}

TEST(Sampling, ShapesAreSampledEvenly) {
  const struct {
    ShapeType shape;
    Vec3f size;
  } cases[] = {{ShapeType::kBox, {0.3f, 0.5f, 0.1f}},       {ShapeType::kSphere, {0.4f, 0, 0}},
               {ShapeType::kEllipsoid, {0.3f, 0.5f, 0.2f}}, {ShapeType::kCapsule, {0.2f, 0.4f, 0}},
               {ShapeType::kCylinder, {0.3f, 0.2f, 0}},     {ShapeType::kPlane, {0.3f, 0.5f, 0}}};
  for (const auto& c : cases) {
    // For a closed surface, the integral of n is 0 and that of p·n is three times the volume; with
    // density p the mean of f / p is the integral of f, whatever the density.
    Mean nx, nz, volume, area;
    for (uint32_t i = 0; i < 200000; ++i) {
      Vec3f n;
      Vec3f p = sample_shape(c.shape, c.size, random_2d(i, 0), &n);
      const float pdf = shape_pdf(c.shape, c.size, p);
      ASSERT_GT(pdf, 0);
      Vec3f q = p;
      const Vec3f m = snap_to_shape(c.shape, c.size, &q);
      EXPECT_LT(length(q - p), 1e-5f) << "off the surface";
      EXPECT_GT(dot(m, n), c.shape == ShapeType::kEllipsoid ? 0.999f : 0.9999f)
          << "shape " << int(c.shape);
      nx.add(n.x / pdf);
      nz.add(n.z / pdf);
      volume.add(dot(p, n) / pdf / 3);
      area.add(1 / pdf);
    }
    const float r = c.size.x, h = c.size.y;
    double expected = 0;
    switch (c.shape) {
      case ShapeType::kBox:
        expected = 8 * c.size.x * c.size.y * c.size.z;
        break;
      case ShapeType::kSphere:
        expected = 4.0 / 3 * kPi * r * r * r;
        break;
      case ShapeType::kEllipsoid:
        expected = 4.0 / 3 * kPi * c.size.x * c.size.y * c.size.z;
        break;
      case ShapeType::kCapsule:
        expected = 4.0 / 3 * kPi * r * r * r + 2 * kPi * r * r * h;
        break;
      case ShapeType::kCylinder:
        expected = 2 * kPi * r * r * h;
        break;
      default:
        EXPECT_NEAR(area.mean, 4 * c.size.x * c.size.y, 1e-5);
        continue;
    }
    EXPECT_NEAR(volume.mean, expected, 4 * volume.standard_error() + 1e-5 * expected)
        << "shape " << int(c.shape);
    EXPECT_NEAR(nx.mean, 0, 4.5 * nx.standard_error()) << "shape " << int(c.shape);
    EXPECT_NEAR(nz.mean, 0, 4.5 * nz.standard_error()) << "shape " << int(c.shape);
  }
}

TEST(Sampling, PointsAreUniformStatelessAndWellSpread) {
  // Every power-of-two prefix of a pixel's samples hits each elementary interval once.
  for (uint32_t pixel = 0; pixel < 20; ++pixel) {
    std::vector<int> columns(16), rows(16), cells(16);
    for (uint32_t i = 0; i < 16; ++i) {
      Sampler s = Sampler::make(7, 3, pixel, 2 * pixel, i, 4);
      s.next_1d();
      const Vec2f u = s.next_2d();
      ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
      ++columns[static_cast<size_t>(u.x * 16)];
      ++rows[static_cast<size_t>(u.y * 16)];
      ++cells[static_cast<size_t>(u.x * 4) * 4 + static_cast<size_t>(u.y * 4)];
    }
    for (int i = 0; i < 16; ++i) {
      EXPECT_EQ(columns[i], 1);
      EXPECT_EQ(rows[i], 1);
      EXPECT_EQ(cells[i], 1);
    }
  }
  // Different dimensions, frames and seeds are not correlated.
  const auto correlation = [](const std::function<float(uint32_t)>& f,
                              const std::function<float(uint32_t)>& g) {
    double sum = 0;
    for (uint32_t i = 0; i < 4096; ++i) sum += (f(i) - 0.5) * (g(i) - 0.5) * 12;
    return sum / 4096;
  };
  const auto at = [](uint64_t seed, uint32_t frame, int dimension) {
    return [=](uint32_t i) {
      Sampler s = Sampler::make(seed, frame, i & 63, i >> 6, 0, 0);
      float u = 0;
      for (int d = 0; d <= dimension; ++d) u = s.next_1d();
      return u;
    };
  };
  for (const int other : {1, 2, 5, 25, 26}) {
    EXPECT_LT(std::abs(correlation(at(1, 0, 0), at(1, 0, other))), 0.08) << other;
  }
  EXPECT_LT(std::abs(correlation(at(1, 0, 0), at(1, 1, 0))), 0.08);
  EXPECT_LT(std::abs(correlation(at(1, 0, 0), at(2, 0, 0))), 0.08);
  // The pixel filter is centred, cut, and of the documented width.
  Mean x, r2;
  for (uint32_t i = 0; i < 65536; ++i) {
    const Vec2f d = sample_pixel_filter(random_2d(i, 0));
    EXPECT_LE(d.x * d.x + d.y * d.y, 1.25f * 1.25f * 1.0001f);
    x.add(d.x);
    r2.add(d.x * d.x);
  }
  EXPECT_NEAR(x.mean, 0, 4 * x.standard_error());
  EXPECT_NEAR(std::sqrt(r2.mean), 0.41, 0.01);
}

/// How many of 4 x 4 squares the points lie in.
size_t squares_of(const std::vector<Vec2f>& points) {
  std::set<int> squares;
  for (const Vec2f& u : points) {
    squares.insert(static_cast<int>(u.x * 4) + 4 * static_cast<int>(u.y * 4));
  }
  return squares.size();
}

TEST(Sampling, PointsOfTurnsAreWellSpreadOverTurnsAndOverPixels) {
  const auto point = [](uint32_t x, uint32_t y, uint32_t turn) {
    Sampler sampler = Sampler::of_turn(7, x, y, turn);
    sampler.next_1d();
    return sampler.next_2d();
  };
  for (const uint32_t period : {0u, 16u, 48u}) {
    for (uint32_t y = 20; y < 24; ++y) {
      for (uint32_t x = 36; x < 40; ++x) {
        std::vector<Vec2f> of_pixel;
        std::set<int> quadrants;
        for (uint32_t turn = 0; turn < 16; ++turn) {
          of_pixel.push_back(point(x, y, period + turn));
          const Vec2f u = of_pixel.back();
          if (turn < 4) quadrants.insert(static_cast<int>(u.x * 2) + 2 * static_cast<int>(u.y * 2));
        }
        EXPECT_EQ(squares_of(of_pixel), 16u) << "of one pixel over 16 turns";
        EXPECT_EQ(quadrants.size(), 4u) << "of one pixel over its first four turns";
      }
    }
  }
  for (uint32_t turn = 0; turn < 20; ++turn) {
    std::vector<Vec2f> of_block;
    for (uint32_t i = 0; i < 16; ++i) of_block.push_back(point(36 + i % 4, 20 + i / 4, turn));
    EXPECT_EQ(squares_of(of_block), 16u) << "of four by four pixels in turn " << turn;
  }
  EXPECT_NE(point(3, 5, 0).x, point(3, 5, 16).x) << "after 16 turns there are new points";
}

TEST(Sampling, SineAndCosineOfTurns) {
  for (int i = 0; i < 10000; ++i) {
    const float u = static_cast<float>(i) / 10000;
    float s = 0, c = 0;
    sincos_turn(u, &s, &c);
    EXPECT_NEAR(s, std::sin(2 * M_PI * u), 2e-6);
    EXPECT_NEAR(c, std::cos(2 * M_PI * u), 2e-6);
  }
}

TEST(Sampling, LogarithmsOfNumbersDownToTheLeastNormalOne) {
  for (int i = 0; i < 10000; ++i) {
    const float x =
        i < 5000 ? 1.0f - static_cast<float>(i) / 5000 : std::exp2(0.025f * (i - 10000));
    const double expected = std::log(static_cast<double>(x));
    EXPECT_NEAR(natural_log(x), expected, 2e-7 + 1e-6 * std::fabs(expected)) << x;
  }
  EXPECT_EQ(natural_log(1.0f), 0.0f);
}

/// At a surface point, the mean over all three ways to use the two techniques must agree: BSDF
/// alone, next event alone, and (through the whole renderer) both with their weights.
TEST(Sampling, EmittersAreSampledByTheDensityTheyReport) {
  const auto build = [](ShapeType shape, Vec3f size) {
    SceneBuilder b;
    const int material = b.add_emitter({900, 900, 900});
    if (shape == ShapeType::kMesh && size.x > 0) {  // a sheet, which shines on one side
      b.description.materials.back().emits_outwards = true;
      b.add(shape, {}, rigid(normalize(Vec3f{1, 2, 0}), 0.4f, {0.3f, 0.2f, 1.2f}), material, 0,
            b.add_mesh(make_panel()));
      return b;
    }
    const Affine3f pose = rigid(normalize(Vec3f{1, 2, 0.5f}), 0.7f, {0.3f, 0.2f, 1.2f});
    if (shape == ShapeType::kMesh) {
      b.add(shape, {}, pose, material, 0, b.add_mesh(make_ball(4, 0.2f)));
    } else if (shape == ShapeType::kPlane) {
      b.add(shape, size, rigid({1, 0, 0}, 2.6f, {0.3f, 0.2f, 1.2f}), material);
    } else {
      b.add(shape, size, pose, material);
    }
    return b;
  };
  const std::pair<ShapeType, Vec3f> cases[] = {{ShapeType::kBox, {0.5f, 0.1f, 0.3f}},
                                               {ShapeType::kSphere, {0.5f, 0, 0}},
                                               {ShapeType::kEllipsoid, {0.5f, 0.2f, 0.3f}},
                                               {ShapeType::kCapsule, {0.2f, 0.4f, 0}},
                                               {ShapeType::kCylinder, {0.3f, 0.3f, 0}},
                                               {ShapeType::kPlane, {0.4f, 0.6f, 0}},
                                               {ShapeType::kMesh, {}},
                                               {ShapeType::kMesh, {1, 1, 1}}};
  for (const auto& [shape, size] : cases) {
    const Probe probe(build(shape, size));
    const bool is_sheet = probe.view.lights[0].is_sheet;
    EXPECT_EQ(is_sheet, shape == ShapeType::kMesh && size.x > 0);
    Mean by_bsdf, by_light, total;
    const Vec3f n{0, 0, 1}, p{0, 0, 0};
    for (uint32_t i = 0; i < 200000; ++i) {
      const Vec3f wi = sample_cosine_hemisphere(random_2d(i, 0));
      RayHit hit;
      const Ray ray = make_ray(p, wi);
      double e = 0, density = 0;
      if (probe.tracer.trace(ray, false, &hit)) {
        const Surface s = make_surface(probe.view, ray, hit, {});
        e = s.emission.x * kPi;
        density = lights::instance_pdf(probe.view, probe.view.instances[s.instance], p, s.p,
                                       s.geometric, 0) *
                  kPi / wi.z;
      }
      by_bsdf.add(e);
      total.add(density);
      const LightSample light = sample_one_light(probe.view, 0, p, random_2d(i, 2), 0.0f);
      double direct = 0;
      Ray shadow = make_ray(p, light.wi);
      shadow.tmax = light.distance * 0.9999f;
      if (light.pdf > 0 && light.wi.z > 0 && !probe.tracer.trace(shadow, true, &hit)) {
        direct = light.radiance.x * dot(light.wi, n) / light.pdf;
      }
      by_light.add(direct);
    }
    const double error = std::hypot(by_bsdf.standard_error(), by_light.standard_error());
    EXPECT_NEAR(by_bsdf.mean, by_light.mean, 4 * error) << "shape " << int(shape);
    EXPECT_GT(by_light.mean, 10) << "shape " << int(shape);
    if (shape == ShapeType::kSphere || shape == ShapeType::kBox || shape == ShapeType::kPlane ||
        is_sheet) {
      EXPECT_NEAR(total.mean, 1, 4 * total.standard_error() + 2e-3) << "shape " << int(shape);
    }
  }
}

}  // namespace
}  // namespace gloam
