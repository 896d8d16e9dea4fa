// The imager against the parameters of its models, from 10^5 pixels and more.
#include "sensors/imager/imager.h"

#include <algorithm>
#include <array>
#include <random>

#include "base/parallel.h"
#include "render/film/tone_map.h"
#include "sensors/imager/vignetting.h"
#include "sensors/test/statistics.h"

namespace gloam {
namespace {

constexpr int kImagerWidth = 400, kImagerHeight = 300;
constexpr size_t kImagerPixels = size_t{kImagerWidth} * kImagerHeight;

Intrinsics imager_intrinsics() {
  return {kImagerWidth, kImagerHeight, 250, 250, kImagerWidth / 2.0, kImagerHeight / 2.0};
}

std::vector<Vec3f> even(float r, float g, float b) {
  return std::vector<Vec3f>(kImagerPixels, {r, g, b});
}

const Exposure kDay{4, 0.005, 200};

/// A quiet sensor of twelve bits without a mosaic.
ImagerOptions plain() {
  ImagerOptions options;
  options.pixel = PixelOptions{.full_well = 12000, .bits = 12, .black_level = 200};
  options.mosaic = "mono";
  return options;
}

std::vector<double> raw_of(const ImagerOptions& options, const std::vector<Vec3f>& light,
                           int64_t frame = 0, const Exposure& exposure = kDay, uint64_t seed = 3) {
  Imager imager(options, imager_intrinsics(), seed);
  std::vector<uint16_t> raw;
  imager.develop(light, exposure, frame, nullptr, &raw);
  return {raw.begin(), raw.end()};
}

TEST(Exposure, FollowsTheSaturationBasedSpeed) {
  EXPECT_NEAR((Exposure{1, 1, 100}).ev100(), 0, 1e-12);
  EXPECT_NEAR((Exposure{16, 1.0 / 100, 100}).ev100(), 14.64, 0.01) << "the sunny-16 rule";
  EXPECT_NEAR((Exposure{16, 1.0 / 100, 400}).ev100(), 12.64, 0.01);
  const Exposure back = exposure_at(9.5, 2);
  EXPECT_NEAR(back.ev100(), 9.5, 1e-12);
  // H = 0.65 L t / N² of the brightest luminance is 78 / S lx s.
  const double top = 1.2 * std::exp2(kDay.ev100());
  EXPECT_NEAR(0.65 * top * kDay.shutter / 16, 78 / kDay.iso, 1e-9);
}

TEST(Exposure, TheProgramOpensTheShutterThenRaisesTheSpeed) {
  const AutoExposureOptions options{.max_shutter = 0.02, .max_iso = 1600};
  const Exposure bright = program_exposure(12, 2, options);
  EXPECT_NEAR(bright.iso, 100, 1e-9);
  EXPECT_NEAR(bright.ev100(), 12, 1e-9);
  const Exposure dim = program_exposure(5, 2, options);
  EXPECT_EQ(dim.shutter, 0.02);
  EXPECT_NEAR(dim.ev100(), 5, 1e-9);
  EXPECT_GT(dim.iso, 100);
  const Exposure dark = program_exposure(-5, 2, options);
  EXPECT_EQ(dark.iso, 1600);
  EXPECT_NEAR(dark.ev100(), std::log2(4 / 0.02 / 16), 1e-9) << "it can do no more";
}

TEST(AutoExposure, ApproachesTheMetersValueWithItsTimeConstant) {
  AutoExposure automatic({.time_constant = 0.4});
  const double grey = 0.125, lit = grey * 64;  // EV 0 and 6
  automatic.meter(grey, 0);
  EXPECT_NEAR(automatic.ev100(), 0, 1e-12) << "the first reading counts at once";
  for (int k = 1; k <= 30; ++k) {
    automatic.meter(lit, k / 30.0);
    EXPECT_NEAR(automatic.ev100(), 6 * (1 - std::exp(-k / 30.0 / 0.4)), 1e-9);
  }
  AutoExposure coarse({.time_constant = 0.4});
  coarse.meter(grey, 0);
  for (int k = 1; k <= 5; ++k) coarse.meter(lit, k / 5.0);
  EXPECT_NEAR(coarse.ev100(), automatic.ev100(), 1e-9) << "whatever the rate";
  automatic.meter(grey, 0);
  EXPECT_NEAR(automatic.ev100(), 0, 1e-12) << "a simulation that began anew";
  AutoExposure bounded({.compensation = 1, .min_ev100 = 2, .max_ev100 = 4});
  bounded.meter(grey * 8, 0);
  EXPECT_NEAR(bounded.ev100(), 2, 1e-12);
  bounded.meter(0, 0);
  EXPECT_EQ(bounded.ev100(), 2);
}

TEST(AutoExposure, MetersTheMeanOrTheMiddle) {
  std::vector<float> light(3 * 32 * 24, 10);
  const MeterImage average{32, 24, false, saturation_of({})},
      center{32, 24, true, average.saturation};
  EXPECT_NEAR(metered_luminance(light.data(), average), 10, 1e-4);
  for (int y = 10; y < 14; ++y) {
    for (int x = 14; x < 18; ++x) std::fill_n(light.begin() + 3 * (32 * y + x), 3, 100.0f);
  }
  const double mean = metered_luminance(light.data(), average);
  EXPECT_NEAR(mean, 10 + 90.0 * 16 / 768, 1e-3);
  EXPECT_GT(metered_luminance(light.data(), center), 1.8 * mean - 10);
}

TEST(AutoExposure, MetersAWindowAsTheSaturatedPixelsOfItsOwnImage) {
  // A quarter of the image is a window, 100 or 10,000 times as bright as the room.
  for (const double window : {1e3, 1e5}) {
    std::vector<float> light(3 * 32 * 24, 10);
    for (size_t i = 0; i < light.size(); ++i)
      if (i / 3 % 32 < 8) light[i] = static_cast<float>(window);
    const AutoExposureOptions options{.compensation = 1.5};
    const double saturation = saturation_of(options);
    const double mean = metered_luminance(light.data(), {32, 24, false, saturation});
    // The fixed point: mean = 10 * 3/4 + saturation * mean / 4.
    EXPECT_NEAR(mean, 7.5 / (1 - saturation / 4), 0.2) << window;
    AutoExposure automatic(options);
    automatic.meter(mean, 0);
    EXPECT_NEAR(1.2 * std::exp2(automatic.ev100()), saturation * mean, 1e-6 * mean)
        << "saturation is the top of the scale";
  }
}

TEST(AutoExposure, MetersSmokeOfWhichFewSamplesAreBright) {
  // One pixel in eight is bright, at random, as in smoke that light reaches on long paths.
  std::mt19937 random(3);
  std::vector<float> light(3 * 32 * 24, 0.01f);
  int bright = 0;
  for (size_t pixel = 0; pixel < light.size() / 3; ++pixel) {
    if (random() % 8 != 0) continue;
    std::fill_n(light.begin() + static_cast<std::ptrdiff_t>(3 * pixel), 3, 200.0f);
    ++bright;
  }
  const double mean = 200.0 * bright / (32 * 24);
  EXPECT_NEAR(
      metered_luminance(light.data(), {32, 24, false, saturation_of({.compensation = 0.7})}), mean,
      0.1 * mean);
}

TEST(Vignetting, IsTheFourthPowerOfTheCosineOfTheLenssRay) {
  Intrinsics k{.width = 4, .height = 1, .fx = 2, .fy = 2, .cx = 0.5, .cy = 0.5};
  k.lens = LensModel::kEquidistant;  // half a radian per pixel
  for (int x = 0; x < 4; ++x) {
    EXPECT_NEAR(vignetting({.cos4 = true}, k)[static_cast<size_t>(x)],
                std::pow(std::cos(0.5 * x), 4), 1e-6);
  }
  k.width = 8;
  EXPECT_EQ(vignetting({.cos4 = true}, k)[4], 0) << "from behind no light comes through a hole";
}

TEST(Vignetting, OfAPinholeIsThatOfItsTangent) {
  const Intrinsics k = imager_intrinsics();
  const auto at = [](int x, int y) { return static_cast<size_t>(y * kImagerWidth + x); };
  const std::vector<float> cos4 = vignetting({.cos4 = true}, k);
  for (const auto& [x, y] : {std::pair{0, 0}, {200, 150}, {399, 20}}) {
    const double a = (x + 0.5 - k.cx) / k.fx, b = (y + 0.5 - k.cy) / k.fy;
    EXPECT_NEAR(cos4[at(x, y)], std::pow(std::cos(std::atan(std::hypot(a, b))), 4), 1e-6);
  }
  const float corner = vignetting({.polynomial = {-0.3, -0.1, 0.02}}, k)[0];
  const double r2 = (199.5 * 199.5 + 149.5 * 149.5) / (200.0 * 200 + 150 * 150);
  EXPECT_NEAR(corner, 1 - 0.3 * r2 - 0.1 * r2 * r2 + 0.02 * r2 * r2 * r2, 1e-6);
  EXPECT_EQ(vignetting({.polynomial = {-3, 0, 0}}, k)[0], 0) << "light is never negative";
}

TEST(Imager, NumbersAreProportionalToLightAndFullAtTheTopOfTheScale) {
  const float top = 1.2f * static_cast<float>(std::exp2(kDay.ev100()));
  ImagerOptions options = plain();
  options.pixel->full_well = 1e6;
  for (const float share : {0.0f, 0.1f, 0.5f, 0.9f, 1.0f, 2.0f}) {
    const float light = top * share;
    const double expected = std::min(4095.0, std::round(200 + (4095 - 200) * double{share}));
    EXPECT_NEAR(raw_of(options, even(light, light, light))[5], expected, 1) << share;
  }
  // Electrons are counted from the photons: 555 nm, 3.5 µm, 0.6 e-/photon.
  const PixelArray pixels({.full_well = 1e6}, 1, 1);
  const double lux_seconds = 0.65 * 100 * kDay.shutter / 16;
  const double watts = lux_seconds / 683, photon = 6.62607015e-34 * 299792458 / 555e-9;
  EXPECT_NEAR(pixels.gains(kDay).electrons_per_light * 100, 0.6 * watts / photon * 3.5e-6 * 3.5e-6,
              1e-3 * 0.6 * watts / photon * 1.2e-11);
}

// The photon transfer method of EMVA 1288: the variance over the mean of the signal is the gain K
// [DN/e-], at the dark end the read noise is left.
TEST(Imager, ThePhotonTransferCurveHasTheGainForItsSlope) {
  ImagerOptions options = plain();
  options.pixel->full_well = 1e6;
  options.pixel->shot_noise = true;
  options.pixel->read_noise = 6;
  const PixelArray pixels(*options.pixel, 1, 1);
  const double gain = pixels.gains(kDay).numbers_per_electron;
  const double rounding = 1.0 / 12;
  std::vector<double> means, variances, errors;
  for (const float light : {0.0f, 200.0f, 800.0f, 1600.0f}) {
    const std::vector<double> raw = raw_of(options, even(light, light, light));
    const Moments m = moments(raw);
    const double signal = pixels.gains(kDay).electrons_per_light * double{light} * gain;
    expect_within(m.mean, 200 + signal, m.mean_error, "mean");
    expect_within(m.variance, gain * signal + gain * gain * 36 + rounding, m.variance_error,
                  "variance");
    means.push_back(m.mean - 200);
    variances.push_back(m.variance);
    errors.push_back(m.variance_error);
  }
  expect_within((variances[3] - variances[0]) / (means[3] - means[0]), gain,
                std::hypot(errors[3], errors[0]) / (means[3] - means[0]), "slope");
}

TEST(Imager, AFullWellAndATopOfTheScaleCut) {
  ImagerOptions options = plain();
  options.pixel->full_well = 2000;
  options.pixel->shot_noise = true;
  const double gain = PixelArray(*options.pixel, 1, 1).gains(kDay).numbers_per_electron;
  for (const double number : raw_of(options, even(1e9f, INFINITY, 1e9f)))
    EXPECT_EQ(number, std::round(200 + 2000 * gain));
  options.pixel->full_well = 1e6;
  for (const double number : raw_of(options, even(1e9f, 1e9f, 1e9f))) EXPECT_EQ(number, 4095);
  const float no_number = NAN;
  for (const double number : raw_of(options, even(no_number, no_number, no_number)))
    EXPECT_EQ(number, 200);
}

TEST(Imager, DarkCurrentGrowsWithTheShutterAndIsPoissons) {
  ImagerOptions options = plain();
  options.pixel->shot_noise = true;
  options.pixel->dark_current = 400;
  const Exposure slow{4, 0.5, 1600};
  const double gain = PixelArray(*options.pixel, 1, 1).gains(slow).numbers_per_electron;
  expect_moments(raw_of(options, even(0, 0, 0), 0, slow), 200 + 200 * gain,
                 gain * gain * 200 + 1.0 / 12, "dark");
}

TEST(Imager, TheFixedPatternIsThePixelsOwn) {
  ImagerOptions options = plain();
  options.pixel->full_well = 1e6;
  options.pixel->dsnu = 30;
  const double gain = PixelArray(*options.pixel, 1, 1).gains(kDay).numbers_per_electron;
  expect_moments(raw_of(options, even(0, 0, 0)), 200, 900 * gain * gain + 1.0 / 12, "DSNU");
  EXPECT_EQ(raw_of(options, even(0, 0, 0), 0), raw_of(options, even(0, 0, 0), 9))
      << "in all frames";
  EXPECT_NE(raw_of(options, even(0, 0, 0)), raw_of(options, even(0, 0, 0), 0, kDay, 4));
  options.pixel->dsnu = 0;
  options.pixel->prnu = 0.02;
  const double electrons = PixelArray(*options.pixel, 1, 1).gains(kDay).electrons_per_light * 1000;
  expect_moments(raw_of(options, even(1000, 1000, 1000)), 200 + electrons * gain,
                 std::pow(0.02 * electrons * gain, 2) + 1.0 / 12, "PRNU");
  // The mean of many noisy frames is the pattern again (EMVA 1288's separation).
  options.pixel->shot_noise = true;
  options.seed = 5;
  const std::vector<double> a = raw_of(options, even(1000, 1000, 1000), 1),
                            b = raw_of(options, even(1000, 1000, 1000), 2);
  std::vector<double> product;
  const double mean = moments(a).mean;
  for (size_t i = 0; i < a.size(); ++i) product.push_back((a[i] - mean) * (b[i] - mean));
  const Moments common = moments(product);
  expect_within(common.mean, std::pow(0.02 * electrons * gain, 2), common.mean_error,
                "what two frames have in common");
}

TEST(Imager, WithNothingOnItsPictureIsTheToneMaps) {
  std::vector<Vec3f> light(kImagerPixels);
  for (size_t i = 0; i < kImagerPixels; ++i) {
    const auto x = static_cast<float>(i % kImagerWidth), y = static_cast<float>(i) / kImagerWidth;
    light[i] = {x * 9, y * 12, 700 + x};
  }
  Imager imager({}, imager_intrinsics(), 1);
  std::vector<uint8_t> rgb, plain_rgb;
  imager.develop(light, kDay, 0, &rgb, nullptr);
  tone_map(light, kImagerWidth, kImagerHeight, {.ev100 = static_cast<float>(kDay.ev100())},
           &plain_rgb);
  ASSERT_EQ(rgb.size(), plain_rgb.size());
  int largest = 0;
  for (size_t i = 0; i < rgb.size(); ++i)
    largest = std::max(largest, std::abs(int{rgb[i]} - int{plain_rgb[i]}));
  EXPECT_LE(largest, 1) << "but for the rounding of a division";
}

TEST(Imager, EveryDrawIsKeyedAndThreadsDoNotMatter) {
  ImagerOptions options = plain();
  options.mosaic = "rggb";
  options.pixel->shot_noise = true;
  options.pixel->read_noise = 3;
  options.pixel->prnu = 0.01;
  const auto reference = raw_of(options, even(900, 800, 700), 5);
  for (const int threads : {1, 2, 3}) {
    set_thread_count(threads);
    EXPECT_EQ(raw_of(options, even(900, 800, 700), 5), reference) << threads;
  }
  set_thread_count(0);
  EXPECT_NE(raw_of(options, even(900, 800, 700), 6), reference) << "another frame";
  options.seed = 1;
  EXPECT_NE(raw_of(options, even(900, 800, 700), 5), reference) << "another seed";
}

// Malvar, He and Cutler's filters give back every picture whose colours change linearly.
TEST(Mosaic, DemosaicingKeepsRampsOfEveryColour) {
  for (const char* name : {"rggb", "bggr", "grbg", "gbrg"}) {
    const Mosaic mosaic(name);
    const auto truth = [](int x, int y) {
      return Vec3f{10 + 0.5f * static_cast<float>(x), 20 + 0.25f * static_cast<float>(y),
                   5 + 0.1f * static_cast<float>(x + y)};
    };
    std::vector<float> values;
    for (int y = 0; y < 30; ++y) {
      for (int x = 0; x < 40; ++x) values.push_back(truth(x, y)[mosaic.color(x, y)]);
    }
    std::vector<Vec3f> out;
    demosaic(mosaic, values, 40, 30, &out);
    for (int y = 2; y < 28; ++y) {
      for (int x = 2; x < 38; ++x) {
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(out[static_cast<size_t>(40 * y + x)][c], truth(x, y)[c], 1e-4)
              << name << " " << x << ", " << y << ", " << c;
      }
    }
  }
  // Their letters are the top left 2 x 2.
  const Mosaic grbg("grbg");
  EXPECT_EQ((std::array{grbg.color(0, 0), grbg.color(1, 0), grbg.color(0, 1), grbg.color(1, 1)}),
            (std::array{1, 0, 2, 1}));
}

TEST(Imager, AMosaicOfAnEvenGreyStaysGreyAndWhiteBalanceIsNeutral) {
  ImagerOptions options;
  options.mosaic = "gbrg";
  options.pixel = PixelOptions{.full_well = 1e6, .bits = 14};
  options.white_balance = {2.1, 1, 1.6};
  Imager imager(options, imager_intrinsics(), 1);
  std::vector<uint8_t> rgb;
  std::vector<uint16_t> raw;
  imager.develop(even(900, 900, 900), kDay, 0, &rgb, &raw);
  EXPECT_EQ(raw.size(), kImagerPixels);
  EXPECT_NEAR(raw[0] / 2.1, raw[kImagerWidth] / 1.0, 1) << "red has less than half";
  int largest = 0;
  for (size_t i = 0; i < kImagerPixels; ++i) {
    const auto [low, high] = std::minmax({rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]});
    largest = std::max(largest, high - low);
  }
  EXPECT_LE(largest, 1);
  imager.develop(even(1e6f, 1e6f, 1e6f), kDay, 0, &rgb, nullptr);
  EXPECT_EQ(rgb[0], rgb[1]) << "what is full is white, not pink";
  options.pixel->full_well = 2000;  // full below the top of the scale
  Imager shallow(options, imager_intrinsics(), 1);
  shallow.develop(even(1e6f, 1e6f, 1e6f), kDay, 0, &rgb, nullptr);
  EXPECT_NEAR(rgb[0], rgb[1], 1);
  EXPECT_NEAR(rgb[2], rgb[1], 1);
}

TEST(Imager, CompressesAndCuts) {
  std::vector<Vec3f> light(kImagerPixels);
  for (size_t i = 0; i < kImagerPixels; ++i) {
    const auto x = static_cast<float>(i % kImagerWidth);
    light[i] = {300 + 200 * std::sin(x / 9), 2 * x, 400 + 300 * std::cos(x / 23)};
  }
  const auto picture = [&](const ImagerOptions& options) {
    Imager imager(options, imager_intrinsics(), 1);
    std::vector<uint8_t> rgb;
    imager.develop(light, kDay, 0, &rgb, nullptr);
    return rgb;
  };
  const auto difference = [](const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::abs(int{a[i]} - int{b[i]});
    return sum / static_cast<double>(a.size());
  };
  const auto none = picture({}), good = picture({.jpeg = 95}), bad = picture({.jpeg = 10});
  ASSERT_EQ(good.size(), none.size());
  EXPECT_GT(difference(none, good), 0.1);
  EXPECT_GT(difference(none, bad), difference(none, good));
  EXPECT_LT(difference(none, good), 4);
  for (Vec3f& l : light) l = {1920, 1920, 1920};  // the top of the scale
  ImagerOptions srgb;
  srgb.curve = "srgb";
  EXPECT_GE(picture(srgb)[0], 254);
  EXPECT_LT(picture({})[0], 250) << "the neutral curve leaves room for highlights";
}

}  // namespace
}  // namespace gloam
