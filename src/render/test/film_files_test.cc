#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

#include "base/files.h"
#include "base/rng.h"
#include "base/srgb.h"
#include "geometry/image/image_exr.h"
#include "geometry/image/image_file.h"
#include "gloam/view.h"
#include "render/film/color_map.h"
#include "render/film/exr.h"
#include "render/film/png.h"
#include "render/film/tone_map.h"
#include "render/film/yuv.h"
#include "world/materials/visual_rules.h"

namespace gloam {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

std::vector<uint8_t> random_bytes(size_t n, uint64_t seed) {
  std::vector<uint8_t> out(n);
  for (size_t i = 0; i < n; ++i)
    out[i] = static_cast<uint8_t>(RandomStream{seed, 1}.draw(0, static_cast<uint32_t>(i)).v[0]);
  return out;
}

// --- tone map ---

TEST(ToneMap, SrgbMatchesTheStandard) {
  EXPECT_FLOAT_EQ(srgb_encode(0.0f), 0);
  EXPECT_NEAR(srgb_encode(1.0f), 1, 1e-6);
  EXPECT_NEAR(srgb_encode(0.0031308f), 0.04045f, 1e-5);  // where the two pieces meet
  EXPECT_NEAR(srgb_encode(0.18f), 0.46135613f, 1e-6);
  EXPECT_NEAR(srgb_encode(0.5f), 0.73535698f, 1e-6);
  for (int i = 0; i < 256; ++i) {
    const float v = static_cast<float>(i) / 255;
    EXPECT_NEAR(srgb_encode(srgb_decode(v)), v, 1e-6);
  }
}

TEST(ToneMap, AChartOfGreysComesOutAsItIs) {
  // A chart's patches, of 3 to 90 %, where a reflectance of 1 is at the top of the scale.
  const float greys[] = {0.02f, 0.031f, 0.09f, 0.18f, 0.36f, 0.5f, 0.59f, 0.75f, 0.9f};
  const float top = max_luminance(9);
  for (const bool dither : {false, true}) {
    for (const float grey : greys) {
      const Vec3f light = Vec3f{1, 1, 1} * (grey * top);
      std::vector<uint8_t> rgb;
      tone_map({light}, 1, 1, {.ev100 = 9, .dither = dither}, &rgb);
      for (const uint8_t level : rgb)
        EXPECT_NEAR(static_cast<float>(level), 255 * srgb_encode(grey), 2) << grey;
    }
  }
}

TEST(ToneMap, TheDefaultExposurePutsWhiteAtTheShoulder) { EXPECT_EQ(kShoulder, kWhiteExposed); }

TEST(ToneMap, ColoursBelowTheShoulderAreKept) {
  std::vector<uint8_t> rgb;
  const Vec3f color{0.84f, 0.2f, 0.01f};
  tone_map({color * max_luminance(3)}, 1, 1, {.ev100 = 3, .dither = false}, &rgb);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(rgb[static_cast<size_t>(c)], 255 * srgb_encode(color[c]), 0.51);
}

TEST(ToneMap, CurveIsSmoothMonotoneAndBounded) {
  constexpr float kStep = 1e-3f;
  float before = tone_curve(0), slope = 1;
  EXPECT_EQ(before, 0);
  for (int i = 1; i <= 20000; ++i) {
    const float y = tone_curve(static_cast<float>(i) * kStep), rise = (y - before) / kStep;
    EXPECT_GE(rise, 0);
    EXPECT_LE(y, 1);
    EXPECT_NEAR(rise, slope, 0.01) << "a kink at " << i;
    before = y;
    slope = rise;
  }
  EXPECT_EQ(before, 1) << "white is the end";
  EXPECT_NEAR(tone_curve(1), 0.945, 1e-3);
}

TEST(ToneMap, ChannelsFillUpOneByOne) {
  // Black body of 1500 K, overexposed more and more: orange, then yellow, never pink.
  float green = 0;
  for (float light = 1; light < 100; light *= 1.3f) {
    EXPECT_GT(tone_curve(light), 0.9f);
    const float out = tone_curve(0.133f * light);
    EXPECT_GE(out, green);
    green = out;
  }
  EXPECT_GT(green, 0.95f);
}

TEST(ToneMap, ExposureFollowsEv100) {
  EXPECT_FLOAT_EQ(max_luminance(0), 1.2f);
  EXPECT_FLOAT_EQ(max_luminance(10), 1228.8f);
  const float half = 0.5f * max_luminance(7);
  std::vector<uint8_t> rgb;
  tone_map({{half, half, half}}, 1, 1, {.ev100 = 7, .dither = false}, &rgb);
  EXPECT_EQ(rgb, (std::vector<uint8_t>(3, 188)));  // 187.5
}

TEST(ToneMap, DitherIsUnbiasedAndDeterministic) {
  // A grey between two levels must average out to itself over the picture.
  const int n = 128;
  const float level = 100.3f / 255;
  const float light = srgb_decode(level) * max_luminance(0);
  const std::vector<Vec3f> radiance(static_cast<size_t>(n * n), Vec3f{light, light, light});
  std::vector<uint8_t> a, b;
  tone_map(radiance, n, n, {.ev100 = 0}, &a);
  tone_map(radiance, n, n, {.ev100 = 0}, &b);
  EXPECT_EQ(a, b);
  double sum = 0;
  std::set<int> levels;
  for (const uint8_t v : a) {
    sum += v;
    levels.insert(v);
  }
  EXPECT_EQ(levels, (std::set<int>{100, 101}));
  EXPECT_NEAR(sum / static_cast<double>(a.size()), 100.3, 0.02);
}

TEST(ToneMap, TakesEveryNumber) {
  std::vector<uint8_t> rgb;
  tone_map({{NAN, -1, 0}, {kInf, kInf, kInf}, {0, 0, 0}}, 3, 1, {.ev100 = 3}, &rgb);
  EXPECT_EQ(rgb[0], 0);
  EXPECT_EQ(rgb[1], 0);
  EXPECT_EQ(rgb[3], 255);
  EXPECT_EQ(rgb[6], 0);
}

// --- PNG ---

TEST(Png, EightBitRoundTripsForEveryChannelCountAndOddSize) {
  for (const auto& [w, h] : {std::pair{1, 1}, {7, 3}, {640, 2}, {33, 65}}) {
    for (int channels = 1; channels <= 4; ++channels) {
      const auto pixels = random_bytes(static_cast<size_t>(w * h * channels), 3);
      const Result<Image8> read = decode_png(encode_png8(w, h, channels, pixels), "test.png");
      ASSERT_TRUE(read.ok()) << read.error().to_string();
      EXPECT_EQ(read->width, w);
      EXPECT_EQ(read->height, h);
      EXPECT_EQ(read->channels, channels);
      EXPECT_EQ(read->texels, pixels);
    }
  }
}

TEST(Png, SixteenBitRoundTripsAndIsBigEndianInTheFile) {
  std::vector<uint16_t> values = {0, 1, 255, 256, 1000, 65535};
  const std::vector<uint8_t> file = encode_png16(3, 2, values);
  const Result<Image16> read = decode_png16(file, "test.png");
  ASSERT_TRUE(read.ok()) << read.error().to_string();
  EXPECT_EQ(read->texels, values);
  // As 8 bits the high byte survives: 65535 -> 255, 256 -> 1.
  const Result<Image8> reduced = decode_png(file, "test.png");
  ASSERT_TRUE(reduced.ok());
  EXPECT_EQ(reduced->texels[5], 255);
  EXPECT_EQ(reduced->texels[3], 1);
  EXPECT_FALSE(decode_png16(encode_png8(2, 2, 1, random_bytes(4, 1)), "test.png").ok());
}

TEST(Png, DepthIsRoundedToMillimetresAndLimited) {
  const float depth[] = {0,      0.0004f, 0.0006f, 1.2344f, 1.2346f, 65.535f,
                         65.54f, kInf,    NAN,     -2,      100};
  EXPECT_EQ(depth_to_millimetres(depth),
            (std::vector<uint16_t>{0, 0, 1, 1234, 1235, 65535, 0, 0, 0, 0, 0}));
}

TEST(Png, DamagedFilesAreErrorsNotCrashes) {
  const auto pixels = random_bytes(3 * 40 * 30, 5);
  const std::vector<uint8_t> good = encode_png8(40, 30, 3, pixels);
  for (size_t n = 0; n + 12 < good.size(); n += 7) {  // the last chunk, IEND, may be missing
    const Result<Image8> read = decode_png({good.data(), n}, "cut.png");
    ASSERT_FALSE(read.ok()) << "cut at " << n;
    EXPECT_NE(read.error().to_string().find("cut.png"), std::string::npos);
  }
  std::vector<uint8_t> bad = good;
  bad[40] ^= 0x55;
  EXPECT_FALSE(decode_png(bad, "bad.png").ok());
}

TEST(Png, AbsurdSizesAreRefusedBeforeMemoryIsAskedFor) {
  std::vector<uint8_t> file = encode_png8(4, 4, 3, random_bytes(48, 1));
  // Width and height of the header, and its checksum recomputed bit by bit (CRC-32).
  for (int i = 0; i < 8; ++i) file[16 + static_cast<size_t>(i)] = i % 4 == 1 ? 0x0f : 0xff;
  file[16] = file[20] = 0;
  uint32_t crc = 0xffffffff;
  for (size_t i = 12; i < 29; ++i) {
    crc ^= file[i];
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320 : 0);
  }
  crc = ~crc;
  for (size_t i = 0; i < 4; ++i) file[29 + i] = static_cast<uint8_t>(crc >> (24 - 8 * i));
  const Result<Image8> read = decode_png(file, "huge.png");
  ASSERT_FALSE(read.ok());
}

// --- JPEG ---

TEST(Jpeg, RoundTripIsClose) {
  std::vector<uint8_t> rgb;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      for (const int v : {x * 4, y * 5, 128}) rgb.push_back(static_cast<uint8_t>(v));
  const std::vector<uint8_t> file = encode_jpeg(64, 48, rgb, 90).value();
  const Result<Image8> read = decode_jpeg(file, "test.jpg");
  ASSERT_TRUE(read.ok()) << read.error().to_string();
  ASSERT_EQ(read->texels.size(), rgb.size());
  double error = 0;
  for (size_t i = 0; i < rgb.size(); ++i) error += std::abs(read->texels[i] - rgb[i]);
  EXPECT_LT(error / static_cast<double>(rgb.size()), 3);
  EXPECT_LT(encode_jpeg(64, 48, rgb, 30)->size(), file.size());
}

TEST(Jpeg, DamagedFilesAreErrorsNotCrashes) {
  const std::vector<uint8_t> good = encode_jpeg(40, 30, random_bytes(3 * 40 * 30, 5)).value();
  for (size_t n = 0; n + 2 < good.size(); n += 11)
    EXPECT_FALSE(decode_jpeg({good.data(), n}, "cut.jpg").ok()) << "cut at " << n;
  EXPECT_FALSE(decode_jpeg(random_bytes(200, 9), "noise.jpg").ok());
  EXPECT_FALSE(encode_jpeg(4, 4, {}).ok());
  EXPECT_FALSE(encode_jpeg(0, 0, {}).ok());
  EXPECT_FALSE(encode_jpeg(70000, 1, random_bytes(3 * 70000, 6)).ok());
  EXPECT_FALSE(encode_jpeg(-1, -1, random_bytes(3, 6)).ok());
  EXPECT_FALSE(decode_jpeg(good, "large.jpg", 100).ok());
}

// --- EXR ---

TEST(Exr, FloatChannelsRoundTripWithoutLoss) {
  const int w = 37, h = 21;
  std::vector<float> depth(static_cast<size_t>(w * h)), rgb(3 * depth.size());
  for (size_t i = 0; i < depth.size(); ++i)
    depth[i] = i % 5 == 0 ? kInf : 0.1f * static_cast<float>(i);
  for (size_t i = 0; i < rgb.size(); ++i) rgb[i] = std::exp(static_cast<float>(i % 100) - 50);
  const ExrChannel channels[] = {{"Z", depth.data()},
                                 {"R", rgb.data(), 3},
                                 {"G", rgb.data() + 1, 3},
                                 {"B", rgb.data() + 2, 3, true}};
  const Result<std::vector<uint8_t>> file = encode_exr(w, h, channels);
  ASSERT_TRUE(file.ok()) << file.error().to_string();
  const Result<ExrImage> read = decode_exr(file.value(), "test.exr");
  ASSERT_TRUE(read.ok()) << read.error().to_string();
  EXPECT_EQ(read->width, w);
  EXPECT_EQ(read->height, h);
  EXPECT_EQ(read->names, (std::vector<std::string>{"B", "G", "R", "Z"}));
  EXPECT_EQ(*read->find("Z"), depth);
  for (size_t i = 0; i < depth.size(); ++i) {
    EXPECT_EQ((*read->find("R"))[i], rgb[3 * i]);
    const float half = (*read->find("B"))[i];  // 11 bits, 6e-5 … 65504
    if (rgb[3 * i + 2] > 1e-4f && rgb[3 * i + 2] < 6e4f) {
      EXPECT_NEAR(half / rgb[3 * i + 2], 1, 1.0 / 2048);
    }
  }
  EXPECT_EQ(read->find("X"), nullptr);
}

TEST(Exr, FilesOfOneRowAndUnfitForCompressionRoundTrip) {
  for (const int h : {1, 15, 16, 17, 33}) {
    std::vector<float> noise(static_cast<size_t>(3 * h));
    const std::vector<uint8_t> bytes = random_bytes(noise.size() * 4, 77);
    for (size_t i = 0; i < noise.size(); ++i)
      noise[i] =
          static_cast<float>(bytes[4 * i] * 65536 + bytes[4 * i + 1] * 256 + bytes[4 * i + 2]);
    const ExrChannel channel{"Z", noise.data()};
    const Result<std::vector<uint8_t>> file = encode_exr(3, h, {&channel, 1});
    ASSERT_TRUE(file.ok());
    const Result<ExrImage> read = decode_exr(file.value(), "noise.exr");
    ASSERT_TRUE(read.ok()) << read.error().to_string();
    EXPECT_EQ(*read->find("Z"), noise);
  }
}

TEST(Exr, DamagedAndLargeFilesAreErrors) {
  std::vector<float> depth(64 * 64, 1.5f);
  const ExrChannel channel{"Z", depth.data()};
  const Result<std::vector<uint8_t>> file = encode_exr(64, 64, {&channel, 1});
  ASSERT_TRUE(file.ok());
  EXPECT_FALSE(decode_exr(file.value(), "large.exr", 1000).ok());
  for (size_t n = 0; n < file->size(); n += 13)
    EXPECT_FALSE(decode_exr({file->data(), n}, "cut.exr").ok()) << "cut at " << n;
  EXPECT_FALSE(decode_exr(random_bytes(100, 1), "noise.exr").ok());
}

// --- readers by content ---

TEST(ReadImage, GoesByContentNotByName) {
  const std::filesystem::path folder =
      testing::TempDir() + "gloam_read_image_" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const std::vector<uint8_t>& bytes) {
    EXPECT_TRUE(write_file_atomic(folder / name, bytes).ok());
    return folder / name;
  };
  const auto pixels = random_bytes(3 * 16 * 16, 1);
  EXPECT_TRUE(read_image(write("png.jpg", encode_png8(16, 16, 3, pixels))).ok());
  EXPECT_TRUE(read_image(write("jpg.png", *encode_jpeg(16, 16, pixels))).ok());
  const std::string text = "not a picture";
  const Result<Image8> bad = read_image(write("text.png", {text.begin(), text.end()}));
  ASSERT_FALSE(bad.ok());
  EXPECT_NE(bad.error().to_string().find("text.png"), std::string::npos);
  EXPECT_FALSE(read_image(folder / "missing.png").ok());
  std::filesystem::remove_all(folder);
}

// --- YUV ---

TEST(Yuv, MatchesBt709LimitedRange) {
  const auto one = [](uint8_t r, uint8_t g, uint8_t b) {
    const std::array<uint8_t, 12> rgb = {r, g, b, r, g, b, r, g, b, r, g, b};
    Yuv420 out;
    rgb_to_yuv420(2, 2, rgb, &out);
    return std::array<int, 3>{out.y[0], out.u[0], out.v[0]};
  };
  // ITU-R BT.709-6: 100 % colour bars.
  EXPECT_EQ(one(255, 255, 255), (std::array{235, 128, 128}));
  EXPECT_EQ(one(0, 0, 0), (std::array{16, 128, 128}));
  EXPECT_EQ(one(255, 0, 0), (std::array{63, 102, 240}));
  EXPECT_EQ(one(0, 255, 0), (std::array{173, 42, 26}));
  EXPECT_EQ(one(0, 0, 255), (std::array{32, 240, 118}));
  for (int v = 0; v < 256; ++v) {
    const auto grey =
        one(static_cast<uint8_t>(v), static_cast<uint8_t>(v), static_cast<uint8_t>(v));
    EXPECT_EQ(grey[1], 128);
    EXPECT_EQ(grey[2], 128);
    EXPECT_EQ(grey[0], static_cast<int>(std::lround(16 + 219.0 * v / 255)));
  }
}

TEST(Yuv, OddSizesRepeatTheLastLine) {
  Yuv420 out;
  rgb_to_yuv420(3, 3, std::vector<uint8_t>(27, 200), &out);
  EXPECT_EQ(out.width, 4);
  EXPECT_EQ(out.height, 4);
  for (const uint8_t y : out.y) EXPECT_EQ(y, out.y[0]);
}

// --- colours ---

TEST(ColorMap, TurboGoesFromBlueOverGreenToRed) {
  EXPECT_GT(turbo_color(0.15f)[2], turbo_color(0.15f)[0]);
  EXPECT_GT(turbo_color(0.5f)[1], 200);
  EXPECT_GT(turbo_color(0.9f)[0], turbo_color(0.9f)[2] + 100);
  EXPECT_EQ(turbo_color(-3), turbo_color(0));
  EXPECT_EQ(turbo_color(7), turbo_color(1));
}

TEST(ColorMap, LabelsAreDistinct) {
  for (uint32_t a = 0; a < 24; ++a) {
    for (uint32_t b = a + 1; b < 24; ++b) {
      int distance = 0;
      for (size_t c = 0; c < 3; ++c) distance += std::abs(label_color(a)[c] - label_color(b)[c]);
      EXPECT_GT(distance, 18) << a << " and " << b;
    }
  }
}

}  // namespace
}  // namespace gloam
