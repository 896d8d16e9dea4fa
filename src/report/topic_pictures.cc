#include "report/topic_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>

#include "base/files.h"
#include "base/text.h"
#include "geometry/image/image_file.h"
#include "geometry/image/png_writer.h"
#include "gloam/report.h"
#include "render/film/color_map.h"
#include "render/film/png.h"
#include "render/film/video.h"
#include "runtime/log/topic_reader.h"

namespace gloam {
namespace {

/// A row's layout in a sensor_msgs/Image.
struct PixelLayout {
  const char* encoding;
  int bytes, channels;
  std::array<int, 3> order;  // of red, green, blue; depth: unused
};
constexpr PixelLayout kLayouts[] = {
    {"rgb8", 3, 3, {0, 1, 2}},  {"bgr8", 3, 3, {2, 1, 0}},  {"rgba8", 4, 3, {0, 1, 2}},
    {"bgra8", 4, 3, {2, 1, 0}}, {"mono8", 1, 1, {0, 0, 0}}, {"8UC1", 1, 1, {0, 0, 0}},
    {"32FC1", 4, 0, {}},        {"16UC1", 2, 0, {}},        {"mono16", 2, 0, {}},
};

float depth_at(const uint8_t* at, int bytes, bool big_endian) {
  uint8_t own[4];
  std::copy(at, at + bytes, own);
  if (big_endian) std::reverse(own, own + bytes);
  if (bytes == 2) {
    const int millimetres = own[0] | own[1] << 8;
    return millimetres == 0 ? std::numeric_limits<float>::infinity()
                            : 0.001f * static_cast<float>(millimetres);
  }
  float value;
  std::memcpy(&value, own, sizeof value);
  return std::isfinite(value) ? value : std::numeric_limits<float>::infinity();
}

Result<TopicPicture> raw_picture(const DynamicMessage& message) {
  GLOAM_TRY(const std::string encoding, message.text("encoding"));
  GLOAM_TRY(const int64_t width, message.integer("width"));
  GLOAM_TRY(const int64_t height, message.integer("height"));
  GLOAM_TRY(const int64_t step, message.integer("step"));
  GLOAM_TRY(const int64_t big_endian, message.integer("is_bigendian"));
  GLOAM_TRY(const auto data, message.bytes("data"));
  const auto* layout = std::find_if(std::begin(kLayouts), std::end(kLayouts),
                                    [&](const PixelLayout& l) { return encoding == l.encoding; });
  if (layout == std::end(kLayouts))
    return Error{ErrorKind::kUnsupported,
                 fmt::format("unsupported image encoding '{}'", as_utf8(encoding))};
  if (width < 1 || height < 1 || width > 65535 || height > 65535 || step < width * layout->bytes ||
      step > std::numeric_limits<uint32_t>::max() ||
      static_cast<uint64_t>(step * height) > data.size())
    return Error{ErrorKind::kInput,
                 fmt::format("an image of {} x {} pixels has {} bytes per row and {} in total",
                             width, height, step, data.size())};
  TopicPicture out;
  out.width = static_cast<int>(width);
  out.height = static_cast<int>(height);
  if (layout->channels > 0) out.image = {out.width, out.height, layout->channels, {}, {}};
  for (int64_t y = 0; y < height; ++y)
    for (int64_t x = 0; x < width; ++x) {
      const uint8_t* pixel = data.data() + y * step + x * layout->bytes;
      for (int c = 0; c < layout->channels; ++c)
        out.image.texels.push_back(pixel[layout->order[static_cast<size_t>(c)]]);
      if (layout->channels == 0)
        out.depth.push_back(depth_at(pixel, layout->bytes, big_endian != 0));
    }
  return out;
}

Result<TopicPicture> compressed_picture(const DynamicMessage& message) {
  GLOAM_TRY(const auto data, message.bytes("data"));
  const bool is_png = data.size() > 4 && data[1] == 'P' && data[2] == 'N' && data[3] == 'G';
  TopicPicture out;
  GLOAM_TRY(out.image, is_png ? decode_png(data, "an image") : decode_jpeg(data, "an image"));
  out.width = out.image.width;
  out.height = out.image.height;
  if (out.image.channels % 2 == 0)
    return Error{ErrorKind::kUnsupported, "images with transparency are not supported"};
  return out;
}

/// Reads the pictures of a topic one after the other.
struct PictureTopic {
  McapReader log;
  TopicReader topic;
  bool is_compressed;

  static Result<PictureTopic> open(const std::filesystem::path& log, const std::string& name) {
    GLOAM_TRY(McapReader reader, McapReader::open(log));
    GLOAM_TRY(TopicReader topic, TopicReader::find(reader, name));
    const std::string type = topic.schema.name();
    const bool is_compressed = type == "sensor_msgs/msg/CompressedImage";
    if (!is_compressed && type != "sensor_msgs/msg/Image")
      return Error{
          ErrorKind::kUnsupported,
          fmt::format("topic '{}' has the type {} and contains no images", name, as_utf8(type))};
    return PictureTopic{std::move(reader), std::move(topic), is_compressed};
  }
  Status for_each(const std::function<Status(const TopicPicture&)>& f) const {
    return topic.for_each(log, [&](const DynamicMessage& message) -> Status {
      GLOAM_TRY(const TopicPicture picture, topic_picture(message, is_compressed));
      return f(picture);
    });
  }
};

std::vector<uint8_t> png_of(const TopicPicture& picture) {
  if (picture.is_depth())
    return encode_png16(picture.width, picture.height, depth_to_millimetres(picture.depth));
  return encode_png8(picture.width, picture.height, picture.image.channels, picture.image.texels);
}

float farthest_of(const TopicPicture& picture) {
  float farthest = 0.001f;
  for (const float d : picture.depth)
    if (std::isfinite(d)) farthest = std::max(farthest, d);
  return farthest;
}

// sRGB of a picture; depths in turbo from red (near) to blue, black = nothing.
std::vector<uint8_t> colors_of(const TopicPicture& picture, float farthest) {
  std::vector<uint8_t> rgb;
  rgb.reserve(static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height) * 3);
  for (const float d : picture.depth) {
    const Rgb8 color = std::isfinite(d) ? turbo_color(1 - d / farthest) : Rgb8{0, 0, 0};
    rgb.insert(rgb.end(), color.begin(), color.end());
  }
  if (picture.image.channels == 3) return picture.image.texels;
  for (const uint8_t grey : picture.image.texels) rgb.insert(rgb.end(), 3, grey);
  return rgb;
}

// Pictures per second that the stamps tell of, in thousandths.
Rational rate_of(const std::vector<int64_t>& stamps) {
  const double span = stamps.size() < 2 ? 0 : 1e-9 * static_cast<double>(stamps.back() - stamps[0]);
  const double rate = span > 0 ? static_cast<double>(stamps.size() - 1) / span : 20;
  return {std::llround(std::clamp(rate, 0.1, 1000.0) * 1000), 1000};
}

}  // namespace

Result<TopicPicture> topic_picture(const DynamicMessage& message, bool is_compressed) {
  GLOAM_TRY(const int64_t seconds, message.integer("header.stamp.sec"));
  GLOAM_TRY(const int64_t nanoseconds, message.integer("header.stamp.nanosec"));
  GLOAM_TRY(TopicPicture out, is_compressed ? compressed_picture(message) : raw_picture(message));
  out.stamp = seconds * 1'000'000'000 + nanoseconds;
  return out;
}

Result<int64_t> write_topic_pictures(const std::filesystem::path& log, const std::string& topic,
                                     const std::filesystem::path& folder) {
  GLOAM_TRY(const PictureTopic pictures, PictureTopic::open(log, topic));
  std::error_code code;
  if (std::filesystem::exists(folder, code) && !std::filesystem::is_empty(folder, code))
    return Error{
        ErrorKind::kUsage, "already exists", {folder.string(), 0, 0}, "choose another folder"};
  GLOAM_TRY_STATUS(make_folder(folder));
  int64_t count = 0;
  std::string stamps = "file,stamp_ns\n";
  GLOAM_TRY_STATUS(pictures.for_each([&](const TopicPicture& picture) -> Status {
    const std::string name = fmt::format("{:06}.png", count++);
    stamps += fmt::format("{},{}\n", name, picture.stamp);
    return write_file_atomic(folder / name, png_of(picture));
  }));
  GLOAM_TRY_STATUS(write_text_file_atomic(folder / "stamps.csv", stamps));
  return count;
}

Result<int64_t> write_topic_video(const std::filesystem::path& log, const std::string& topic,
                                  const std::filesystem::path& to) {
  GLOAM_TRY(const PictureTopic pictures, PictureTopic::open(log, topic));
  std::vector<int64_t> stamps;
  GLOAM_TRY_STATUS(pictures.topic.for_each(pictures.log, [&](const DynamicMessage& m) -> Status {
    GLOAM_TRY(const int64_t seconds, m.integer("header.stamp.sec"));
    GLOAM_TRY(const int64_t nanoseconds, m.integer("header.stamp.nanosec"));
    stamps.push_back(seconds * 1'000'000'000 + nanoseconds);
    return {};
  }));
  if (stamps.empty())
    return Error{ErrorKind::kInput, fmt::format("topic '{}' contains no images", topic)};
  const Rational rate = rate_of(stamps);
  std::optional<VideoWriter> video;
  VideoOptions options{.rate = rate};
  float farthest = 1;
  int64_t count = 0, last = -1;
  GLOAM_TRY_STATUS(pictures.for_each([&](const TopicPicture& picture) -> Status {
    if (!video) {
      options.width = picture.width;
      options.height = picture.height;
      farthest = farthest_of(picture);
      GLOAM_TRY(auto sink, create_file_sink(to));
      GLOAM_TRY(video, VideoWriter::start(std::move(sink), options));
    }
    if (picture.width != options.width || picture.height != options.height)
      return Error{ErrorKind::kUnsupported, "all images of a video must have the same size"};
    const double time = 1e-9 * static_cast<double>(picture.stamp - stamps[0]);
    const double at = std::clamp(time * rate.value(), -1e9, 1e9);
    last = std::max<int64_t>(last + 1, std::llround(at));
    ++count;
    return video->add(last, colors_of(picture, farthest));
  }));
  GLOAM_TRY_STATUS(video->finish());
  return count;
}

}  // namespace gloam
