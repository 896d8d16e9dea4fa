#include "studio/picture_sender.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <vector>
// After cstdio: it needs FILE.
#include <jpeglib.h>

namespace gloam::studio {
namespace {

std::vector<uint8_t> decode(std::span<const uint8_t> jpeg, int& width, int& height) {
  jpeg_decompress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, jpeg.data(), jpeg.size());
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  width = static_cast<int>(info.output_width);
  height = static_cast<int>(info.output_height);
  std::vector<uint8_t> rgb(size_t{3} * info.output_width * info.output_height);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = &rgb[size_t{3} * info.output_scanline * info.output_width];
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return rgb;
}

/// A smooth picture: JPEG keeps it within a few grey levels.
CameraFrame ramp(int width, int height) {
  CameraFrame frame;
  frame.intrinsics = {width, height, 50, 60, 7.5, 8.5};
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      for (const int value : {255 * u / width, 255 * v / height, 128})
        frame.rgb.push_back(static_cast<uint8_t>(value));
  return frame;
}

TEST(Picture, KeepsTheColours) {
  const CameraFrame frame = ramp(97, 61);
  const auto packet = jpeg_packet({std::make_shared<CameraFrame>(frame)});
  ASSERT_TRUE(packet.ok());
  int width = 0, height = 0;
  const auto rgb = decode(std::span(*packet).subspan(kPictureHeaderSize), width, height);
  ASSERT_EQ(width, 97);
  ASSERT_EQ(height, 61);
  double sum = 0;
  for (size_t i = 0; i < rgb.size(); ++i) sum += std::abs(rgb[i] - frame.rgb[i]);
  EXPECT_LT(sum / static_cast<double>(rgb.size()), 3.0);
}

TEST(Picture, HeaderHoldsWhatThePageProjectsWith) {
  CameraFrame frame = ramp(32, 24);
  frame.index = 77;
  frame.time = 3.85;
  frame.X_WC = {{1, 2, 3}, {0.5, -0.5, 0.5, -0.5}};
  frame.intrinsics.lens = LensModel::kEquidistant;
  frame.intrinsics.distortion = {0.25, 0, 0, 0, 0, 0, 0, -0.5};
  const auto packet = jpeg_packet({std::make_shared<CameraFrame>(frame), 12, 2});
  ASSERT_TRUE(packet.ok());
  const auto at = [&]<class T>(size_t offset, T) {
    T value;
    std::memcpy(&value, packet->data() + offset, sizeof value);
    return value;
  };
  EXPECT_EQ(std::memcmp(packet->data(), "GLV1", 4), 0);
  EXPECT_EQ(at(4, uint32_t{}), kPictureHeaderSize);
  EXPECT_EQ(at(8, uint64_t{}), 12u);
  EXPECT_EQ(at(16, int64_t{}), 77);
  EXPECT_EQ(at(24, double{}), 3.85);
  EXPECT_EQ(at(32, uint16_t{}), 32);
  EXPECT_EQ(at(34, uint16_t{}), 24);
  EXPECT_EQ(at(36, uint32_t{}), 2u);
  EXPECT_EQ(at(40, uint32_t{}), 4u);
  EXPECT_EQ(at(44, float{}), 50.f);
  EXPECT_EQ(at(48, float{}), 60.f);
  EXPECT_EQ(at(52, float{}), 7.5f);
  EXPECT_EQ(at(56, float{}), 8.5f);
  EXPECT_EQ(at(60, double{}), 1.0);
  EXPECT_EQ(at(76, double{}), 3.0);
  EXPECT_EQ(at(84, double{}), 0.5);
  EXPECT_EQ(at(108, double{}), -0.5);
  EXPECT_EQ(at(116, uint32_t{}), 3u);
  EXPECT_EQ(at(120, float{}), 0.25f);
  EXPECT_EQ(at(148, float{}), -0.5f);
  int width = 0, height = 0;
  decode(std::span(*packet).subspan(kPictureHeaderSize), width, height);
  EXPECT_EQ(width, 32);
}

TEST(Picture, ImpossibleOnesAreRefused) {
  CameraFrame without_colours;
  without_colours.intrinsics.width = without_colours.intrinsics.height = 4;
  EXPECT_FALSE(jpeg_packet({std::make_shared<CameraFrame>(without_colours)}).ok());
}

uint32_t flags_of(const web::Frame& frame) {
  uint32_t flags = 0;
  std::memcpy(&flags, frame.body->data() + 40, 4);
  return flags;
}

web::ClientPtr viewer(int64_t id) {
  return std::make_shared<web::Client>(id, web::Answer{}, [] {}, web::OutboxOptions{.slots = {0}});
}

TEST(PictureSender, SendsEachClientItsCodec) {
  PictureSender sender(0, 20);
  const auto page = viewer(1), video = viewer(2);
  const auto frame = std::make_shared<CameraFrame>(ramp(97, 61));
  sender.send({frame});
  sender.add(page);
  sender.add(video);
  EXPECT_EQ(flags_of(*page->outbox.next()), 4u) << "the newest picture, for one that comes later";
  EXPECT_EQ(flags_of(*video->outbox.next()), 4u);
  sender.set_codec(2, Codec::kH264);
  sender.send({frame, 1});
  EXPECT_EQ(flags_of(*page->outbox.next()), 4u);
  const auto key = video->outbox.next();
  ASSERT_TRUE(key);
  EXPECT_EQ(flags_of(*key), 2u + 4u);
  const std::vector<uint8_t> start(key->body->begin() + kPictureHeaderSize,
                                   key->body->begin() + kPictureHeaderSize + 5);
  EXPECT_EQ(start, (std::vector<uint8_t>{0, 0, 0, 1, 0x67})) << "a sequence parameter set";
  sender.send({frame, 2});
  const auto next = video->outbox.next();
  ASSERT_TRUE(next);
  EXPECT_EQ(flags_of(*next), 2u);
  EXPECT_LT(next->body->size(), key->body->size() / 2) << "nothing has changed";
  sender.set_codec(2, Codec::kJpeg);
  sender.send({frame, 3});
  EXPECT_EQ(flags_of(*video->outbox.next()), 4u);
}

TEST(PictureSender, AClientThatLostAPacketWaitsForAKey) {
  PictureSender sender(0, 20);
  const auto fast = viewer(1), slow = viewer(2);
  for (const auto& client : {fast, slow}) {
    sender.add(client);
    sender.set_codec(client->id, Codec::kH264);
  }
  const auto frame = std::make_shared<CameraFrame>(ramp(64, 48));
  auto send = [&, sequence = uint64_t{0}]() mutable {
    sender.send({frame, sequence++});
    return flags_of(*fast->outbox.next());
  };
  EXPECT_EQ(send(), 6u);
  EXPECT_EQ(send(), 2u) << "the slow client's key packet still waits";
  EXPECT_FALSE(slow->outbox.next().has_value()) << "a packet without the one before is not sent";
  EXPECT_EQ(send(), 6u) << "so the next one is a key packet for all";
  EXPECT_EQ(flags_of(*slow->outbox.next()), 6u);
  EXPECT_EQ(send(), 2u);
  EXPECT_EQ(flags_of(*slow->outbox.next()), 2u);
}

TEST(PictureSender, ASizeThatVideoDoesNotTakeComesAsJpeg) {
  PictureSender sender(0, 20);
  const auto client = viewer(1);
  sender.add(client);
  sender.set_codec(1, Codec::kH264);
  sender.send({std::make_shared<CameraFrame>(ramp(12, 9))});
  EXPECT_EQ(flags_of(*client->outbox.next()), 4u);
}

}  // namespace
}  // namespace gloam::studio
