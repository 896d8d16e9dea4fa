// Panes: a sheet's transmission is the mean of those of both polarisations.

#include <gtest/gtest.h>

#include <cmath>

#include "render/kernel/bsdf/microfacet.h"
#include "render/test/scene_builder.h"

namespace gloam {
namespace {

/// Mean over both polarisations of the series of reflections between two faces.
double pane_transmission(double degrees, double ior) {
  const double ci = std::cos(degrees * M_PI / 180), sine = std::sin(degrees * M_PI / 180) / ior;
  const double ct = std::sqrt(1 - sine * sine);
  double sum = 0;
  for (const double r : {(ci - ior * ct) / (ci + ior * ct), (ior * ci - ct) / (ior * ci + ct)}) {
    const double face = r * r;
    double passed = 0, inside = 1 - face;
    for (int i = 0; i < 400; ++i, inside *= face * face) passed += inside * (1 - face);
    sum += passed / 2;
  }
  return sum;
}

TEST(Pane, SheetsReflectAsBothPolarisationsDo) {
  EXPECT_NEAR(pane_transmission(75, 1.5), 0.618, 5e-4);
  for (const float ior : {1.3f, 1.5f, 1.9f}) {
    for (const int degrees : {0, 30, 56, 75, 85}) {
      float cos_t;
      const auto cosine = static_cast<float>(std::cos(degrees * M_PI / 180));
      EXPECT_NEAR(1 - static_cast<double>(fresnel_sheet(cosine, ior, &cos_t)),
                  pane_transmission(degrees, static_cast<double>(ior)), 1e-4)
          << degrees << " degrees, " << ior;
    }
  }
}

// A white emitter seen through a pane, clear or frosted, in the path and the direct tier.
TEST(Pane, CamerasSeeThroughIt) {
  for (const int degrees : {0, 60, 75}) {
    SceneBuilder b;
    MaterialDescription pane;
    pane.transmission_weight = 1;
    pane.thin_walled = true;
    pane.roughness = 0;
    b.add(ShapeType::kPlane, {50, 50, 0}, translation({0, 0, 1}), b.add_material(pane));
    b.add(ShapeType::kPlane, {}, {}, b.add_emitter({50, 50, 50}));
    const float angle = static_cast<float>(degrees) * kPi / 180;
    const Vec3f eye{3 * std::sin(angle), 0.001f, 1 + 3 * std::cos(angle)};
    const CameraView view = SceneBuilder::camera(look_at(eye, {0, 0, 1}), 8, 8, 0.2);
    for (const RenderTier tier : {RenderTier::kPath, RenderTier::kDirect}) {
      RenderSettings settings;
      settings.tier = tier;
      settings.spp = tier == RenderTier::kPath ? 1024 : 1;
      const Film film = b.render(view, settings);
      double mean = 0;
      for (const Vec3f& c : film.radiance) mean += static_cast<double>(c.x) / 64;
      EXPECT_NEAR(mean / 50, pane_transmission(degrees, 1.5), 0.006)
          << degrees << " degrees, tier " << static_cast<int>(tier);
    }
  }
}

}  // namespace
}  // namespace gloam
