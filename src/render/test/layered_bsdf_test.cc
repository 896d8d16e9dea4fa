// Coats, fuzz, glass and thin sheets: densities, energy, reciprocity, closed forms.

#include <fmt/format.h>

#include <memory>

#include "render/scene/albedo_table.h"
#include "render/test/direction_check.h"
#include "render/test/probe.h"

namespace gloam {
namespace {

class LayeredBsdfTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    tables_ = std::make_unique<Tables>();
    fill_albedo_table(&tables_->albedo);
    fill_glass_table(&tables_->glass);
  }
  static LayeredBsdf make(const MaterialLayers& m, SurfaceParameters s, Vec3f wo) {
    s.coat_weight = m.coat_weight;
    s.coat_roughness = m.coat_roughness;
    s.coat_f0 = m.coat_f0;
    s.coat_darkening = m.coat_darkening;
    s.fuzz_weight = m.fuzz_weight;
    s.transmission = m.transmission;
    SceneView view;
    view.albedo = &tables_->albedo;
    view.glass = &tables_->glass;
    return make_layered(view, m, s, wo);
  }
  struct Tables {
    AlbedoTable albedo;
    GlassTable glass;
  };
  inline static std::unique_ptr<Tables> tables_;
};

struct Case {
  std::string name;
  MaterialLayers layers;
  SurfaceParameters surface;
};

SurfaceParameters base(float roughness, float metallic = 0) {
  SurfaceParameters s;
  s.base_color = {0.8f, 0.6f, 0.4f};
  s.roughness = roughness;
  s.metallic = metallic;
  s.f0 = 0.04f;
  s.f90 = 1;
  return s;
}

std::vector<Case> cases() {
  std::vector<Case> out;
  MaterialLayers coat;
  coat.coat_weight = 1;
  coat.coat_roughness = 0.5f;
  coat.coat_f0 = 0.05f;
  out.push_back({"coat", coat, base(0.7f, 0.5f)});
  MaterialLayers fuzz;
  fuzz.fuzz_weight = 0.8f;
  fuzz.fuzz_roughness = 0.6f;
  out.push_back({"fuzz", fuzz, base(0.6f)});
  MaterialLayers glass;
  glass.transmission = 1;
  out.push_back({"glass", glass, base(0.6f)});
  out.push_back({"glass from inside", glass, base(0.6f)});
  out.back().surface.outside = false;
  MaterialLayers half = glass;
  half.transmission = 0.5f;
  half.coat_weight = 0.5f;
  half.coat_roughness = 0.6f;
  half.fuzz_weight = 0.5f;
  out.push_back({"everything", half, base(0.5f, 0.3f)});
  MaterialLayers sheet = glass;
  sheet.thin = true;
  out.push_back({"frosted sheet", sheet, base(0.6f)});
  MaterialLayers leaf;
  leaf.thin = true;
  leaf.subsurface = 1;
  out.push_back({"leaf", leaf, base(0.5f)});
  MaterialLayers brushed;
  brushed.anisotropy = 0.6f;
  out.push_back({"brushed metal", brushed, base(0.6f, 1)});
  return out;
}

Vec3f direction(float cosine, float turn = 0.1f) {
  const float r = std::sqrt(1 - cosine * cosine);
  return {r * std::cos(2 * kPi * turn), r * std::sin(2 * kPi * turn), cosine};
}

TEST_F(LayeredBsdfTest, SamplesMatchTheirDensity) {
  for (const Case& c : cases()) {
    for (const float cos_o : {0.9f, 0.35f}) {
      const Vec3f wo = direction(cos_o);
      const LayeredBsdf bsdf = make(c.layers, c.surface, wo);
      EXPECT_NEAR(bsdf.p_base + bsdf.p_coat + bsdf.p_fuzz + bsdf.p_glass + bsdf.p_beyond, 1, 1e-5f);
      check_bsdf(bsdf, wo, fmt::format("{} cos {}", c.name, cos_o));
    }
  }
}

/// Mean energy that leaves, radiance squeezed in glass counted back.
Mean energy(const LayeredBsdf& bsdf, Vec3f wo, uint32_t draws) {
  Mean mean;
  for (uint32_t i = 0; i < draws; ++i) {
    const BsdfSample s = sample_bsdf(bsdf, wo, random_2d(i, 1).x, random_2d(i, 0));
    const bool bent = s.wi.z < 0 && bsdf.p_glass > 0 && !bsdf.thin;
    mean.add(s.pdf > 0 ? s.weight.x * (bent ? sqr(bsdf.eta) : 1.0f) : 0);
  }
  return mean;
}

TEST_F(LayeredBsdfTest, WhiteLosesNoEnergyAndNothingGains) {
  for (Case c : cases()) {
    c.surface.base_color = {1, 1, 1};
    c.layers.subsurface_color = {1, 1, 1};
    for (const float cos_o : {1.0f, 0.6f, 0.25f}) {
      const Vec3f wo = direction(cos_o);
      const Mean m = energy(make(c.layers, c.surface, wo), wo, 40000);
      // Drawn-out highlights and mixed glass use the tables of round ones: not exact.
      const double slack = c.layers.anisotropy > 0 ? 0.05 : 0.012;
      EXPECT_NEAR(m.mean, 1, 4 * m.standard_error() + slack) << c.name << " cos " << cos_o;
    }
  }
}

/// Of a matt base under a smooth coat the light that is thrown back and forth between them is a
/// geometric series (Elias et al. 2001, the interfaced Lambertian surface).
TEST_F(LayeredBsdfTest, CoatThrowsLightBackOnItsBase) {
  MaterialLayers coat;
  coat.coat_weight = 1;
  coat.coat_f0 = sqr(0.5f / 2.5f);  // of index 1.5
  SurfaceParameters matt = base(0.5f);
  matt.f0 = matt.f90 = 0;
  const float mean = 0.04f + 0.96f / 21;  // of Schlick's term over the cosine
  const float back = 1 - (1 - mean) / sqr(1.5f);
  for (const float albedo : {0.1f, 0.5f, 0.9f}) {
    matt.base_color = {albedo, albedo, albedo};
    for (const float cos_o : {1.0f, 0.4f}) {
      const Vec3f wo = direction(cos_o);
      const float reflected = lerp(0.04f, 1.0f, ggx::schlick(cos_o));
      const float truth = reflected + (1 - reflected) * albedo * (1 - back) / (1 - back * albedo);
      const Mean m = energy(make(coat, matt, wo), wo, 40000);
      EXPECT_NEAR(m.mean, truth, 4 * m.standard_error() + 0.003)
          << "albedo " << albedo << " cos " << cos_o;
    }
  }
  coat.coat_darkening = 0;
  const Vec3f up{0, 0, 1};
  const Mean m = energy(make(coat, matt, up), up, 40000);
  EXPECT_NEAR(m.mean, 0.04 + 0.96 * 0.9, 4 * m.standard_error() + 0.003)
      << "without darkening the base keeps its colour";
}

TEST_F(LayeredBsdfTest, RoughCoatBlursWhatLiesUnderIt) {
  MaterialLayers coat;
  coat.coat_weight = 1;
  const Vec3f wo = direction(0.8f);
  const auto width = [&](float roughness) {
    return make(coat, base(roughness, 1), wo).base.alpha.x;
  };
  EXPECT_EQ(width(0.2f), sqr(0.2f)) << "a smooth coat blurs nothing";
  coat.coat_roughness = 0.4f;
  // Gaussians of slopes: the coat's counts on the way in and out.
  const float both = std::sqrt(std::pow(0.2f, 4.0f) + 2 * std::pow(0.4f, 4.0f));
  EXPECT_NEAR(width(0.2f), both, 1e-5f);
  EXPECT_NEAR(width(1.0f), 1, 1e-5f) << "nothing is rougher than rough";
}

TEST_F(LayeredBsdfTest, SmoothGlassFollowsFresnelAndSnell) {
  MaterialLayers glass;
  glass.transmission = 1;
  SurfaceParameters s = base(0);
  for (const bool outside : {true, false}) {
    s.outside = outside;
    for (const float cos_o : {1.0f, 0.8f, 0.5f, 0.2f}) {
      const Vec3f wo = direction(cos_o);
      const LayeredBsdf b = make(glass, s, wo);
      const double eta = outside ? 1.5 : 1 / 1.5, sin_t = std::sqrt(1 - cos_o * cos_o) / eta;
      double reflected = 1;
      if (sin_t < 1) {
        const double cos_t = std::sqrt(1 - sin_t * sin_t);
        const double rs = (cos_o - eta * cos_t) / (cos_o + eta * cos_t);
        const double rp = (eta * cos_o - cos_t) / (eta * cos_o + cos_t);
        reflected = 0.5 * (rs * rs + rp * rp);
      }
      Mean up, astray;
      for (uint32_t i = 0; i < 20000; ++i) {
        const BsdfSample d = sample_bsdf(b, wo, random_2d(i, 1).x, random_2d(i, 0));
        ASSERT_GT(d.pdf, 0);
        up.add(d.wi.z > 0);
        // The narrowest lobe still has the long tail of GGX.
        if (d.wi.z < 0) astray.add(std::fabs(std::hypot(d.wi.x, d.wi.y) - sin_t) > 0.02);
      }
      if (astray.n > 0) {
        EXPECT_LT(astray.mean, 0.02) << "refracted to wrong angles";
      }
      EXPECT_NEAR(up.mean, reflected, 4 * up.standard_error() + 4e-3) << "cos " << cos_o;
    }
  }
}

TEST_F(LayeredBsdfTest, SingleScatteringOfGlassIsReciprocal) {
  MaterialLayers glass;
  glass.transmission = 1;
  for (uint32_t i = 0; i < 300; ++i) {
    const Vec3f up = direction(0.05f + 0.9f * random_2d(i, 0).x, random_2d(i, 0).y);
    const Vec3f down = -direction(0.05f + 0.9f * random_2d(i, 1).x, random_2d(i, 1).y);
    SurfaceParameters s = base(0.5f);
    LayeredBsdf from_up = make(glass, s, up);
    s.outside = false;
    LayeredBsdf from_down = make(glass, s, -down);  // its frame looks to the other side
    from_up.glass = from_down.glass = 1;            // without the compensation, which is by wo
    float pdf;
    const float a = eval_bsdf(from_up, up, down, &pdf).x / -down.z;
    const float b = eval_bsdf(from_down, -down, -up, &pdf).x / up.z;
    // Radiance over the square of the index is what is the same both ways (Veach 1997, 5.2).
    EXPECT_NEAR(a * 2.25f, b, 2e-3f * (a * 2.25f + b) + 1e-6f) << i;
  }
}

TEST_F(LayeredBsdfTest, CoatAndFuzzShowInPictures) {
  const auto brightness = [](float coat, float fuzz) {
    SceneBuilder b;
    b.description.sky.ambient = {1, 1, 1};
    MaterialDescription m;
    m.base_color = {0, 0, 0};
    m.specular_weight = 0;
    m.coat_weight = coat;
    m.fuzz_weight = fuzz;
    b.add(ShapeType::kBox, {1, 1, 1}, {}, b.add_material(m));
    RenderSettings settings;
    settings.spp = 16;
    settings.variance = true;
    return picture_mean(b.render(b.camera(look_at({0, 0, 3}, {}), 8, 8), settings)).mean;
  };
  EXPECT_EQ(brightness(0, 0), 0);
  // A smooth coat of index 1.6 reflects 5.3 % of even light where it faces the viewer.
  EXPECT_NEAR(brightness(1, 0), 0.0533, 0.003);
  EXPECT_GT(brightness(0, 1), 0.01);
}

TEST_F(LayeredBsdfTest, OddValuesGiveNumbers) {
  for (const Case& c : cases()) {
    for (const float roughness : {0.0f, 1.0f}) {
      for (const float cos_o : {1e-4f, 1.0f}) {
        SurfaceParameters s = c.surface;
        s.roughness = roughness;
        const Vec3f wo = direction(cos_o);
        const LayeredBsdf b = make(c.layers, s, wo);
        for (uint32_t i = 0; i < 2000; ++i) {
          const BsdfSample d = sample_bsdf(b, wo, random_2d(i, 1).x, random_2d(i, 0));
          ASSERT_TRUE(std::isfinite(d.pdf) && std::isfinite(max_component(d.weight))) << c.name;
          ASSERT_GE(d.weight.x, 0) << c.name;
          float pdf;
          const Vec3f f = eval_bsdf(b, wo, sample_sphere(random_2d(i, 2)), &pdf);
          ASSERT_TRUE(std::isfinite(pdf) && std::isfinite(max_component(f))) << c.name;
        }
      }
    }
  }
}

}  // namespace
}  // namespace gloam
