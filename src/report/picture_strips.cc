#include "report/picture_strips.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/image/image_file.h"
#include "gloam/view.h"
#include "report/video_frames.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr int kWidest = 480;  // [px]
constexpr int kJpegQuality = 82;

/// Pictures of one camera of one run, from its video or, without one, its PNG files.
class CameraPictures {
 public:
  static Result<CameraPictures> open(const RunResults& run, const RunResults::Camera& camera) {
    CameraPictures out;
    const fs::path folder = run.folder / camera.folder,
                   video = run.folder / (camera.folder + ".mp4");
    std::error_code code;
    out.read_poses(folder / "poses.csv");
    if (fs::exists(video, code)) {
      GLOAM_TRY(out.video_, VideoReader::open(video));
      out.take_samples(out.video_->index().samples);
    } else if (fs::is_directory(folder / "rgb", code)) {
      out.folder_ = folder / "rgb";
      out.times_.resize(std::min(out.times_.size(), out.frames_.size()));
    } else {
      out.times_.clear();
    }
    return out;
  }

  const std::vector<double>& times() const { return times_; }

  Result<Image8> picture(size_t index) const {
    if (video_) return video_->decode(index);
    GLOAM_TRY(Image8 image, read_image(folder_ / fmt::format("{:06}.png", frames_[index])));
    if (image.channels != 3)
      return Error{ErrorKind::kInput, "is not an RGB image", {folder_.string(), 0, 0}};
    return image;
  }

 private:
  // Rows up to the first that is no frame's.
  void read_poses(const fs::path& file) {
    const auto poses = read_metric_table(file);
    const auto* times = poses.ok() ? poses->find("time_s") : nullptr;
    const auto* frames = poses.ok() ? poses->find("frame") : nullptr;
    if (times == nullptr || frames == nullptr) return;
    constexpr double kMostFrames = 1e9;
    for (size_t i = 0; i < std::min(times->size(), frames->size()); ++i) {
      const double frame = (*frames)[i];
      if (!(frame >= 0 && frame < kMostFrames) || !std::isfinite((*times)[i])) return;
      frames_.push_back(static_cast<int64_t>(frame));
      times_.push_back((*times)[i]);
    }
  }
  // A video that was cut may have pictures whose poses are missing; those count on from the first
  // one's time.
  void take_samples(const std::vector<VideoIndex::Sample>& samples) {
    const double first = times_.empty() ? 0 : times_.front();
    for (size_t i = times_.size(); i < samples.size(); ++i)
      times_.push_back(first + samples[i].time);
    times_.resize(samples.size());
  }

  std::optional<VideoReader> video_;
  fs::path folder_;
  // Frame numbers and times of the pictures. Numbers have gaps where frames were dropped, and start
  // late in a run that resumes a log.
  std::vector<int64_t> frames_;
  std::vector<double> times_;  // [s]
};

// Halved until it is narrow enough, in linear steps of whole texels.
Image8 narrowed(Image8 image) {
  while (image.width > kWidest && image.width >= 2 && image.height >= 2) {
    Image8 half{image.width / 2, image.height / 2, 3, image.color_space, {}};
    half.texels.reserve(static_cast<size_t>(half.width) * static_cast<size_t>(half.height) * 3);
    const auto at = [&](int x, int y, int c) {
      return static_cast<int>(
          image.texels[(static_cast<size_t>(y) * static_cast<size_t>(image.width) +
                        static_cast<size_t>(x)) *
                           3 +
                       static_cast<size_t>(c)]);
    };
    for (int y = 0; y < half.height; ++y)
      for (int x = 0; x < half.width; ++x)
        for (int c = 0; c < 3; ++c)
          half.texels.push_back(
              static_cast<uint8_t>((at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) +
                                    at(2 * x, 2 * y + 1, c) + at(2 * x + 1, 2 * y + 1, c) + 2) /
                                   4));
    image = std::move(half);
  }
  return image;
}

size_t nearest_time(const std::vector<double>& times, double t) {
  const auto nearer = [t](double a, double b) { return std::fabs(a - t) < std::fabs(b - t); };
  return static_cast<size_t>(std::min_element(times.begin(), times.end(), nearer) - times.begin());
}

/// All that is known of a camera before its instants are chosen.
struct CameraSource {
  size_t run;
  CameraPictures pictures;
};

std::vector<double> common_instants(const std::vector<CameraSource>& sources, int count) {
  double low = 0, high = 1e30;
  for (const CameraSource& source : sources) {
    const std::vector<double>& times = source.pictures.times();
    low = std::max(low, times.front());
    high = std::min(high, times.back());
  }
  // Runs without a common time are shown at those of the longest.
  if (high < low)
    for (const CameraSource& source : sources) high = std::max(low, source.pictures.times().back());
  // Instants are those at which the first run has pictures.
  const std::vector<double>& taken = sources.front().pictures.times();
  std::vector<double> instants;
  for (int i = 0; i < count; ++i) {
    const double wanted = count == 1 ? high : low + (high - low) * i / (count - 1);
    const double t = taken[nearest_time(taken, wanted)];
    if (instants.empty() || instants.back() != t) instants.push_back(t);
  }
  return instants;
}

}  // namespace

std::string base64(std::span<const uint8_t> bytes) {
  static constexpr char kLetters[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t left = std::min<size_t>(3, bytes.size() - i);
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < left ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) out += k <= left ? kLetters[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::vector<PictureStrip> make_strips(const std::vector<RunResults>& runs,
                                      const ReportRequest& request, std::vector<Error>* left_out) {
  std::vector<std::string> names;
  for (const RunResults& run : runs)
    for (const RunResults::Camera& camera : run.cameras)
      if (std::find(names.begin(), names.end(), camera.name) == names.end())
        names.push_back(camera.name);
  std::vector<PictureStrip> strips;
  uint64_t bytes = 0;
  int dropped = 0;
  for (const std::string& name : names) {
    std::vector<CameraSource> sources;
    for (size_t i = 0; i < runs.size(); ++i)
      for (const RunResults::Camera& camera : runs[i].cameras) {
        if (camera.name != name) continue;
        auto pictures = CameraPictures::open(runs[i], camera);
        if (!pictures.ok())
          left_out->push_back(pictures.error());
        else if (!pictures->times().empty())
          sources.push_back({i, std::move(*pictures)});
        break;
      }
    if (sources.empty()) continue;
    PictureStrip strip;
    strip.camera = name;
    strip.instants = common_instants(sources, std::clamp(request.instants, 1, 24));
    for (const CameraSource& source : sources) {
      PictureStrip::Row row;
      row.run = source.run;
      bool is_damaged = false;
      for (const double t : strip.instants) {
        StripPicture picture;
        const size_t index = nearest_time(source.pictures.times(), t);
        picture.time = source.pictures.times()[index];
        // A damaged one stands for the others.
        auto image = is_damaged ? Result<Image8>(Image8()) : source.pictures.picture(index);
        if (!image.ok()) {
          left_out->push_back(image.error());
          is_damaged = true;
        } else if (const Image8 small = narrowed(std::move(*image)); small.width > 0) {
          auto jpeg = encode_jpeg(small.width, small.height, small.texels, kJpegQuality);
          if (jpeg.ok() && bytes + jpeg->size() <= request.picture_bytes) {
            bytes += jpeg->size();
            picture.width = small.width;
            picture.height = small.height;
            picture.data_uri = "data:image/jpeg;base64," + base64(*jpeg);
          } else {
            ++dropped;
          }
        }
        row.pictures.push_back(std::move(picture));
      }
      strip.rows.push_back(std::move(row));
    }
    strips.push_back(std::move(strip));
  }
  if (dropped > 0)
    left_out->push_back({ErrorKind::kPartial,
                         fmt::format("{} images are omitted: together they may have at most {} MiB",
                                     dropped, request.picture_bytes >> 20)});
  return strips;
}

}  // namespace gloam
