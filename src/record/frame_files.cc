#include "record/frame_files.h"

#include <fmt/format.h>

#include <ranges>
#include <string>

#include "base/check.h"
#include "record/run_files.h"
#include "render/film/exr.h"
#include "render/film/png.h"

namespace gloam {
namespace {

using Bytes = std::vector<uint8_t>;

Result<Bytes> png8(const CameraFrame& frame, const std::vector<uint8_t>& values) {
  return encode_png8(frame.intrinsics.width, frame.intrinsics.height, 3, values);
}

/// Several values of a pixel (a raw picture's colours) stand side by side in its row.
Result<Bytes> png16(const CameraFrame& frame, const std::vector<uint16_t>& values) {
  const size_t height = static_cast<size_t>(frame.intrinsics.height);
  return encode_png16(static_cast<int>(values.size() / height), frame.intrinsics.height, values);
}

Result<Bytes> exr(const CameraFrame& frame, const std::vector<float>& values,
                  std::string_view names) {
  std::vector<std::string> words;
  for (const auto word : std::views::split(names, ' '))
    words.emplace_back(word.begin(), word.end());
  std::vector<ExrChannel> channels;
  for (const std::string& word : words)
    channels.push_back({word, values.data() + channels.size(), static_cast<int>(words.size())});
  return encode_exr(frame.intrinsics.width, frame.intrinsics.height, channels);
}

/// 16 bits where they can number all parts of the world, which the frame need not show. Else three
/// bytes as in COCO's panoptic pictures: id = R + 256 G + 65536 B (Kirillov et al. 2019).
Result<Bytes> ids(const CameraFrame& frame, const std::vector<uint32_t>& values) {
  constexpr uint32_t kMax16Bit = 0xFFFF, kMax24Bit = 0xFFFFFF;
  if (frame.part_count <= kMax16Bit) return png16(frame, {values.begin(), values.end()});
  if (frame.part_count > kMax24Bit)
    return Error{ErrorKind::kUsage,
                 fmt::format("the scene of camera '{}' has {} parts; images can number at most {}",
                             frame.camera, frame.part_count, kMax24Bit),
                 {},
                 "read CameraFrame::part instead"};
  std::vector<uint8_t> rgb;
  rgb.reserve(3 * values.size());
  for (const uint32_t id : values)
    for (const int shift : {0, 8, 16}) rgb.push_back(static_cast<uint8_t>(id >> shift));
  return png8(frame, rgb);
}

Bytes json(const std::vector<ObjectView>& objects) {
  const std::string text = objects_json(objects);
  return {text.begin(), text.end()};
}

}  // namespace

Result<Bytes> encode_frame_file(const CameraFile& file, const CameraFrame& frame) {
  const bool is_empty = std::visit([&](auto plane) { return (frame.*plane).empty(); }, file.plane);
  if (is_empty) return Bytes{};
  const auto values = [&]<class T>(T) -> const std::vector<T>& {
    return frame.*std::get<std::vector<T> CameraFrame::*>(file.plane);
  };
  switch (file.format) {
    case FileFormat::kPng8:
      return png8(frame, values(uint8_t{}));
    case FileFormat::kPng16:
      return png16(frame, values(uint16_t{}));
    case FileFormat::kMillimetres:
      return png16(frame, depth_to_millimetres(values(float{})));
    case FileFormat::kCentikelvins:
      return png16(frame, to_centikelvins(values(float{})));
    case FileFormat::kIds:
      return ids(frame, values(uint32_t{}));
    case FileFormat::kExr:
      if (std::holds_alternative<std::vector<uint32_t> CameraFrame::*>(file.plane)) {
        const std::vector<uint32_t>& counts = values(uint32_t{});
        return exr(frame, {counts.begin(), counts.end()}, file.exr_names);
      }
      return exr(frame, values(float{}), file.exr_names);
    case FileFormat::kJson:
      return json(frame.objects);
    case FileFormat::kVideo:
    case FileFormat::kCsv:
      break;
  }
  GLOAM_CHECK(false, "a file of all frames cannot be made from one frame");
  return Bytes{};
}

}  // namespace gloam
