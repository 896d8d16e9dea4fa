// Lens models against values worked out by hand and against their own inverses.
#include "geometry/lens.h"

#include <gmock/gmock.h>

#include <random>

namespace gloam {
namespace {

using ::testing::HasSubstr;

Intrinsics camera(LensModel model, std::array<double, 8> d, double f = 400) {
  Intrinsics k{.width = 640, .height = 480, .fx = f, .fy = f, .cx = 320, .cy = 240};
  k.lens = model;
  k.distortion = d;
  return k;
}

// Calibrations as they occur: a webcam, a wide machine-vision lens, a fisheye beyond a half space.
const Intrinsics kLenses[] = {
    camera(LensModel::kPinhole, {}),
    camera(LensModel::kPlumbBob, {-0.28, 0.09, 0.001, -0.0007, -0.012}),
    camera(LensModel::kPlumbBob, {0.15, -0.2, 0.0015, 0.0009, 0.1}),
    camera(LensModel::kRationalPolynomial, {5.2, 3.1, 0.0002, -0.0001, 0.12, 5.5, 4.9, 0.75}),
    camera(LensModel::kEquidistant, {-0.012, 0.0041, -0.0021, 0.0003}, 190),
    camera(LensModel::kEquirectangular, {}, 640 / (2 * M_PI))};

TEST(Lens, OfKnownPointsAreWhatTheFormulasSay) {
  double x, y;
  // Radius 0.5 at k1 = 0.1, k2 = 0.01, k3 = 0.001: 1 + 0.025 + 0.000625 + 0.000015625.
  auto lens = make_lens<double>(camera(LensModel::kPlumbBob, {0.1, 0.01, 0, 0, 0.001}));
  ASSERT_TRUE(lens_project(lens, 0.3, 0.4, 1.0, &x, &y));
  EXPECT_NEAR(x, 0.3 * 1.025640625, 1e-12);
  EXPECT_NEAR(y, 0.4 * 1.025640625, 1e-12);
  // Tangential terms alone: x += 2 p1 x y + p2 (r² + 2 x²), y += p1 (r² + 2 y²) + 2 p2 x y.
  lens = make_lens<double>(camera(LensModel::kPlumbBob, {0, 0, 0.01, 0.02}));
  ASSERT_TRUE(lens_project(lens, 0.3, 0.4, 1.0, &x, &y));
  EXPECT_NEAR(x, 0.3 + 2 * 0.01 * 0.12 + 0.02 * (0.25 + 0.18), 1e-12);
  EXPECT_NEAR(y, 0.4 + 0.01 * (0.25 + 0.32) + 2 * 0.02 * 0.12, 1e-12);
  // Numerator 1.025, denominator 1 + 0.2 * 0.25.
  lens = make_lens<double>(camera(LensModel::kRationalPolynomial, {0.1, 0, 0, 0, 0, 0.2}));
  ASSERT_TRUE(lens_project(lens, 0.3, 0.4, 1.0, &x, &y));
  EXPECT_NEAR(x, 0.3 * 1.025 / 1.05, 1e-12);
  // A right angle off the axis: the radius is pi/2 (1 + k1 pi²/4).
  lens = make_lens<double>(camera(LensModel::kEquidistant, {0.05}));
  ASSERT_TRUE(lens_project(lens, -2.0, 0.0, 0.0, &x, &y));
  EXPECT_NEAR(x, -M_PI_2 * (1 + 0.05 * M_PI * M_PI / 4), 1e-12);
  EXPECT_NEAR(y, 0, 1e-12);
  lens = make_lens<double>(camera(LensModel::kEquirectangular, {}));
  ASSERT_TRUE(lens_project(lens, -1.0, 0.0, 0.0, &x, &y));
  EXPECT_NEAR(x, -M_PI_2, 1e-12);
  ASSERT_TRUE(lens_project(lens, 0.0, -1.0, 1.0, &x, &y));
  EXPECT_NEAR(y, -M_PI_4, 1e-12);
}

TEST(Lens, ARootThatIsMetIsKept) {
  int asked = 0;
  const auto line = [&](float at, float* slope) {
    ++asked;
    *slope = 1;
    return at - 0.3f;
  };
  EXPECT_EQ(lenses::rising_root(0.3f, 2.0f, line), 0.3f);
  EXPECT_EQ(asked, 1) << "the first guess is the root";
  EXPECT_EQ(lenses::rising_root(1.0f, 2.0f, line), 0.3f);
  EXPECT_EQ(asked, 3) << "Newton's first step leads to the root of a line";
  // A fisheye without coefficients: the radius is the angle.
  const auto lens = make_lens<float>(camera(LensModel::kEquidistant, {}));
  for (const float radius : {0.0f, 0.1f, 0.7f, 1.3f}) {
    float X, Y, Z, angle;
    ASSERT_TRUE(lens_unproject(lens, radius, 0.0f, &X, &Y, &Z, &angle));
    EXPECT_EQ(X, std::sin(radius));
    EXPECT_EQ(Z, std::cos(radius));
  }
}

// In single precision, as kernels run it: 0.01 px over the whole picture.
TEST(Lens, ProjectsBackWhatItUnprojects) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> u(0, 640), v(0, 480);
  for (const Intrinsics& k : kLenses) {
    const auto lens = make_lens<float>(k);
    EXPECT_EQ(lens_fault(k), "");
    int seen = 0;
    for (int i = 0; i < 20000; ++i) {
      const float fx = static_cast<float>(k.fx);
      const float x = (u(random) - 320) / fx, y = (v(random) - 240) / fx;
      float X, Y, Z, angle, back_x, back_y;
      if (!lens_unproject(lens, x, y, &X, &Y, &Z, &angle)) continue;
      ++seen;
      ASSERT_NEAR(X * X + Y * Y + Z * Z, 1, 1e-5);
      ASSERT_TRUE(lens_project(lens, X * 3, Y * 3, Z * 3, &back_x, &back_y));
      ASSERT_NEAR(back_x * fx, x * fx, 0.01)
          << static_cast<int>(k.lens) << " at " << x << ", " << y;
      ASSERT_NEAR(back_y * fx, y * fx, 0.01);
    }
    EXPECT_GT(seen, 13000);
  }
}

// The angle of a pixel is that between directions of neighbouring pixels, the mean over both axes.
TEST(Lens, TellsTheAngleOfAPixel) {
  for (const Intrinsics& k : kLenses) {
    const auto lens = make_lens<double>(k);
    for (const double x : {0.0, 0.31, -0.55}) {
      for (const double y : {0.02, 0.37}) {
        double d[3][3], angle, unused;
        const double h = 1e-4;
        ASSERT_TRUE(lens_unproject(lens, x, y, &d[0][0], &d[0][1], &d[0][2], &angle));
        ASSERT_TRUE(lens_unproject(lens, x + h, y, &d[1][0], &d[1][1], &d[1][2], &unused));
        ASSERT_TRUE(lens_unproject(lens, x, y + h, &d[2][0], &d[2][1], &d[2][2], &unused));
        double a[3], b[3];
        for (int i = 0; i < 3; ++i) a[i] = (d[1][i] - d[0][i]) / h, b[i] = (d[2][i] - d[0][i]) / h;
        const double area = std::sqrt(std::pow(a[1] * b[2] - a[2] * b[1], 2) +
                                      std::pow(a[2] * b[0] - a[0] * b[2], 2) +
                                      std::pow(a[0] * b[1] - a[1] * b[0], 2));
        // The pinhole's, which textures have always been filtered by, is a little wider.
        const bool flat = !is_wide(k.lens);
        const double scale = flat ? 1 / std::sqrt(d[0][2]) : 1;
        EXPECT_NEAR(angle, std::sqrt(area) * scale, 2e-3) << static_cast<int>(k.lens);
      }
    }
  }
}

TEST(Lens, SeesNothingWhereItsModelEnds) {
  double X, Y, Z, angle, x, y;
  // r (1 - 0.3 r²) has its top at r = 1 / sqrt(0.9), of 2/3 of that.
  const auto barrel = make_lens<double>(camera(LensModel::kPlumbBob, {-0.3}));
  EXPECT_NEAR(barrel.reach, 1 / std::sqrt(0.9), 1e-6);
  EXPECT_TRUE(lens_unproject(barrel, 0.70, 0.0, &X, &Y, &Z, &angle));
  EXPECT_FALSE(lens_unproject(barrel, 0.71, 0.0, &X, &Y, &Z, &angle));
  EXPECT_FALSE(lens_project(barrel, 1.1, 0.0, 1.0, &x, &y))
      << "it would come back into the picture";
  EXPECT_FALSE(lens_project(barrel, 0.0, 0.0, -1.0, &x, &y)) << "behind the camera";
  // A fisheye without distortion ends at the point behind it.
  const auto fisheye = make_lens<double>(camera(LensModel::kEquidistant, {}));
  EXPECT_TRUE(lens_unproject(fisheye, 3.1, 0.0, &X, &Y, &Z, &angle));
  EXPECT_FALSE(lens_unproject(fisheye, 3.2, 0.0, &X, &Y, &Z, &angle));
  // A panorama's borders.
  const auto all = make_lens<double>(camera(LensModel::kEquirectangular, {}));
  EXPECT_TRUE(lens_unproject(all, 3.1, 1.5, &X, &Y, &Z, &angle));
  EXPECT_FALSE(lens_unproject(all, 3.2, 0.0, &X, &Y, &Z, &angle));
  EXPECT_FALSE(lens_unproject(all, 0.0, 1.6, &X, &Y, &Z, &angle));
}

TEST(Lens, FaultsAreTold) {
  EXPECT_THAT(lens_fault(camera(LensModel::kPlumbBob, {-0.9})), HasSubstr("folds"));
  EXPECT_EQ(lens_fault(camera(LensModel::kPlumbBob, {-0.9}, 4000)), "")
      << "of a long lens the fold lies far outside of the picture";
  EXPECT_THAT(lens_fault(camera(LensModel::kEquidistant, {-0.5}, 300)), HasSubstr("folds"));
  EXPECT_EQ(lens_fault(camera(LensModel::kEquidistant, {}, 100)), "") << "black corners are usual";
  EXPECT_THAT(lens_fault(camera(LensModel::kPlumbBob, {NAN})), HasSubstr("finite"));
  EXPECT_THAT(lens_fault(camera(LensModel::kPinhole, {}, 0)), HasSubstr("positive"));
}

// Whatever the coefficients, nothing hangs or leaves the unit sphere.
TEST(Lens, WildCoefficientsDoNoHarm) {
  std::mt19937 random(2);
  std::normal_distribution<float> wild(0, 3);
  for (int i = 0; i < 3000; ++i) {
    Intrinsics k =
        camera(i % 2 == 0 ? LensModel::kRationalPolynomial : LensModel::kEquidistant, {});
    for (double& d : k.distortion) d = wild(random);
    const auto lens = make_lens<float>(k);
    const float x = wild(random), y = wild(random);
    float X, Y, Z, angle, bx, by;
    if (!lens_unproject(lens, x, y, &X, &Y, &Z, &angle)) continue;
    ASSERT_NEAR(X * X + Y * Y + Z * Z, 1, 1e-4);
    ASSERT_TRUE(std::isfinite(angle));
    if (lens_project(lens, X, Y, Z, &bx, &by)) {
      ASSERT_NEAR(bx, x, 2e-3 * (1 + std::fabs(x)));
      ASSERT_NEAR(by, y, 2e-3 * (1 + std::fabs(y)));
    }
  }
}

}  // namespace
}  // namespace gloam
