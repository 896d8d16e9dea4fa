#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "geometry/image/image_file.h"
#include "geometry/image/small_float.h"
#include "geometry/test/image_writer.h"
#include "geometry/test/read_helper.h"

namespace gloam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// 300 x 2: long runs, changing texels, zeros.
std::vector<uint8_t> some_texels() {
  std::vector<uint8_t> out;
  for (int i = 0; i < 600; ++i) {
    const auto v = static_cast<uint8_t>(i % 300 < 280 ? i / 100 : i * 7);
    out.insert(out.end(),
               {v, 128, static_cast<uint8_t>(255 - v), static_cast<uint8_t>(120 + v % 9)});
  }
  return out;
}

TEST(Hdr, AllPackingsGiveTheSameTexels) {
  const std::vector<uint8_t> texels = some_texels();
  for (const HdrPacking packing : {HdrPacking::kNone, HdrPacking::kOld, HdrPacking::kNew}) {
    const std::string file = hdr_file(300, 2, texels, packing);
    const Result<ImageF> image = decode_float_image(as_bytes(file), "a.hdr");
    ASSERT_TRUE(image.ok()) << image.error().to_string();
    ASSERT_EQ(image->width, 300);
    ASSERT_EQ(image->height, 2);
    ASSERT_EQ(image->texels.size(), 1800u);
    for (size_t i = 0; i < 600; ++i)
      for (size_t c = 0; c < 3; ++c)
        ASSERT_EQ(image->texels[3 * i + c],
                  texels[4 * i + c] * std::exp2(texels[4 * i + 3] - 136.0f));
  }
}

TEST(Hdr, ExposureAndRowOrderCount) {
  const std::vector<uint8_t> texels = {128, 0, 64, 129, 1, 2, 3, 0};
  Result<ImageF> image = decode_hdr(
      as_bytes(hdr_file(1, 2, texels, HdrPacking::kNone, "EXPOSURE=4\nEXPOSURE= 0.5\n")), "a");
  ASSERT_TRUE(image.ok());
  EXPECT_THAT(image->texels, ElementsAre(0.5f, 0, 0.25f, 0, 0, 0));
  image = decode_hdr(as_bytes(hdr_file(1, 2, texels, HdrPacking::kNone, "", "+Y")), "a");
  ASSERT_TRUE(image.ok());
  EXPECT_THAT(image->texels, ElementsAre(0, 0, 0, 1, 0, 0.5f));
}

// Heads as cameras, Windows editors and other programs write them.
TEST(Hdr, HeadsOfOtherProgramsAreRead) {
  const std::string texels("\x80\x00\x40\x81\x01\x02\x03\x00", 8);
  for (const std::string& head : {
           std::string("#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n"),
           std::string("#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 2 +X 1\r\n"),
           std::string("#?RADIANCE\n\n-Y 2 +X 1\n"),
           std::string(
               "#?RADIANCE\nSOFTWARE=x\n# FORMAT=32-bit_rle_xyze\nGAMMA=1\n\n-Y  2\t+X 1\n"),
           std::string("\xEF\xBB\xBF#?RADIANCE\nFORMAT=32-bit_rle_rgbe \n\n-Y 2 +X 1\n"),
       }) {
    const std::string file = head + texels;
    const Result<ImageF> image = decode_float_image(as_bytes(file), "a.hdr");
    ASSERT_TRUE(image.ok()) << head << image.error().to_string();
    EXPECT_THAT(image->texels, ElementsAre(1, 0, 0.5f, 0, 0, 0)) << head;
  }
}

TEST(Hdr, DamageIsNamed) {
  for (const HdrPacking packing : {HdrPacking::kNone, HdrPacking::kOld, HdrPacking::kNew}) {
    const std::string file = hdr_file(300, 2, some_texels(), packing);
    for (size_t n = 0; n < file.size(); n += 3)
      EXPECT_FALSE(decode_hdr(as_bytes(file.substr(0, n)), "a.hdr").ok()) << n;
  }
  const auto error = [](std::string file, const std::string& from, const std::string& to) {
    file.replace(file.find(from), from.size(), to);
    const Result<ImageF> image = decode_hdr(as_bytes(file), "a.hdr");
    return image.ok() ? "" : image.error().to_string();
  };
  const std::string file = hdr_file(300, 2, some_texels(), HdrPacking::kNew);
  EXPECT_THAT(error(file, "+X 300", "+X 99999999999"), HasSubstr("size"));
  EXPECT_THAT(error(file, "-Y 2 +X 300", "-Y 65000 +X 65000"), HasSubstr("the limit is"));
  EXPECT_THAT(error(file, "-Y 2 +X", "-X 2 +Y"), HasSubstr("-Y height +X width"));
  EXPECT_THAT(error(file, "rgbe", "xyze"), HasSubstr("is not supported"));
  EXPECT_THAT(error(file, "-Y 2 ", "-Y 3 "), HasSubstr("row 2 is damaged or missing"));
}

TEST(Exr, ChannelsBecomeTexels) {
  const std::string color = exr_file(2, 2, {"A", "B", "G", "R"},
                                     {{1, 1, 1, 1}, {0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 1e9f}});
  Result<ImageF> image = decode_float_image(as_bytes(color), "a.exr");
  ASSERT_TRUE(image.ok()) << image.error().to_string();
  EXPECT_EQ(image->channels, 4);
  EXPECT_THAT(image->texels, ElementsAre(8, 4, 0, 1, 9, 5, 1, 1, 10, 6, 2, 1, 1e9f, 7, 3, 1));
  image = decode_float_image(as_bytes(exr_file(2, 1, {"Y"}, {{0.5f, 2}})), "a.exr");
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(image->channels, 1);
  EXPECT_THAT(image->texels, ElementsAre(0.5f, 2));
  image = decode_float_image(as_bytes(exr_file(1, 1, {"Q", "Z"}, {{0}, {1}})), "a.exr");
  ASSERT_FALSE(image.ok());
  EXPECT_THAT(image.error().to_string(),
              HasSubstr("neither R, G and B channels nor a single grey channel"));
  for (size_t n = 0; n < color.size(); ++n)
    EXPECT_FALSE(decode_float_image(as_bytes(color.substr(0, n)), "a.exr").ok()) << n;
}

TEST(Ktx, BytesOfEveryLayoutAreRead) {
  const auto read = [](const std::string& file) {
    Result<KtxImage> image = decode_ktx(as_bytes(file), "a.ktx");
    EXPECT_TRUE(image.ok()) << image.error().to_string();
    return image.ok() ? std::move(*image) : KtxImage{};
  };
  // RGB rows of 3 texels are padded from 9 to 12 bytes.
  KtxImage image = read(ktx_file(0x1401, 0x1907, 0x8C41, 3, 2, {"abcdefghi...jklmnopqr..."}));
  ASSERT_EQ(image.faces.size(), 1u);
  EXPECT_EQ(image.faces[0].channels, 3);
  EXPECT_EQ(image.faces[0].color_space, ColorSpace::kSrgb);
  EXPECT_EQ(std::string(image.faces[0].texels.begin(), image.faces[0].texels.end()),
            "abcdefghijklmnopqr");
  image = read(ktx_file(0x1401, 0x1907, 0x8051, 3, 2, {"abcdefghi...jklmnopqr..."},
                        std::string("\x18\0\0\0KTXorientation\0S=r,T=u\0", 28)));
  EXPECT_EQ(image.faces.at(0).color_space, ColorSpace::kLinear);
  EXPECT_EQ(std::string(image.faces[0].texels.begin(), image.faces[0].texels.end()),
            "jklmnopqrabcdefghi");
  image = read(
      ktx_file(0x1401, 0x1908, 0x8058, 1, 1, {"xp..", "xm..", "yp..", "ym..", "zp..", "zm.."}));
  ASSERT_EQ(image.faces.size(), 6u);
  EXPECT_EQ(image.faces[3].texels, (std::vector<uint8_t>{'y', 'm', '.', '.'}));
  // R11F_G11F_B10F: 1, 0.5 and 2.
  const uint32_t packed = 0x3C0u | 0x380u << 11 | 0x200u << 22;
  image = read(ktx_file(0x8C3B, 0x1907, 0x8C3A, 1, 1, {raw(packed)}));
  ASSERT_EQ(image.float_faces.size(), 1u);
  EXPECT_THAT(image.float_faces[0].texels, ElementsAre(1, 0.5f, 2));
  image = read(ktx_file(0x1406, 0x1903, 0x822E, 1, 1, {raw(1e9f)}));
  EXPECT_THAT(image.float_faces.at(0).texels, ElementsAre(1e9f));
  image = read(ktx_file(0x140B, 0x8227, 0x822F, 1, 1, {raw(0xC0003555u)}));
  EXPECT_THAT(image.float_faces.at(0).texels, ElementsAre(0.333251953125f, -2));
}

TEST(Ktx, DamageIsNamed) {
  const std::string file = ktx_file(0x1401, 0x1908, 0x8058, 1, 1, {"abcd"});
  for (size_t n = 0; n < file.size(); ++n)
    EXPECT_FALSE(decode_ktx(as_bytes(file.substr(0, n)), "a.ktx").ok()) << n;
  const auto error = [&](size_t at, uint32_t value) {
    std::string changed = file;
    std::memcpy(changed.data() + at, &value, 4);
    const Result<KtxImage> image = decode_ktx(as_bytes(changed), "a.ktx");
    return image.ok() ? "" : image.error().to_string();
  };
  EXPECT_THAT(error(16, 0), HasSubstr("it is compressed"));
  EXPECT_THAT(error(36, 5000), HasSubstr("it is truncated"));
  EXPECT_THAT(error(36, 0xffffffff), HasSubstr("its size is"));
  EXPECT_THAT(error(44, 4), HasSubstr("3-D"));
  EXPECT_THAT(error(52, 6), HasSubstr("it is truncated"));
  EXPECT_THAT(error(60, 0xfffffff0), HasSubstr("it is truncated"));
}

TEST(SmallFloat, HalvesAreIeees) {
  EXPECT_EQ(half_to_float(0x3C00), 1);
  EXPECT_EQ(half_to_float(0xC000), -2);
  EXPECT_EQ(half_to_float(0x7BFF), 65504);
  EXPECT_EQ(half_to_float(0x0001), std::exp2(-24.0f));
  EXPECT_EQ(half_to_float(0xFC00), -std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(half_to_float(0x7C01)));
}

}  // namespace
}  // namespace gloam
