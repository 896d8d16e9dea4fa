#include "record/camera_recorder.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "record/frame_files.h"

namespace gloam {
namespace {

constexpr size_t kThumbnails = 24;    // at most in memory; the contact sheet picks from these
constexpr int kThumbnailWidth = 320;  // [px]

}  // namespace

Thumbnail make_thumbnail(const CameraFrame& frame, int width) {
  const int w = frame.intrinsics.width, h = frame.intrinsics.height;
  Thumbnail out;
  out.time = frame.time;
  out.width = std::min(width, w);
  out.height = std::max(1, static_cast<int>(int64_t{h} * out.width / w));
  const auto source = [&](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(w) + static_cast<size_t>(x);
  };
  for (int y = 0; y < out.height; ++y) {
    const int y0 = static_cast<int>(int64_t{y} * h / out.height);
    const int y1 = std::max(y0 + 1, static_cast<int>(int64_t{y + 1} * h / out.height));
    for (int x = 0; x < out.width; ++x) {
      const int x0 = static_cast<int>(int64_t{x} * w / out.width);
      const int x1 = std::max(x0 + 1, static_cast<int>(int64_t{x + 1} * w / out.width));
      const size_t middle = source((x0 + x1 - 1) / 2, (y0 + y1 - 1) / 2);
      if (!frame.depth.empty()) out.depth.push_back(frame.depth[middle]);
      if (!frame.instance.empty()) out.instance.push_back(frame.instance[middle]);
      if (frame.rgb.empty()) continue;
      for (size_t c = 0; c < 3; ++c) {
        int sum = 0;
        for (int v = y0; v < y1; ++v)
          for (int u = x0; u < x1; ++u) sum += frame.rgb[3 * source(u, v) + c];
        const int count = (x1 - x0) * (y1 - y0);
        out.rgb.push_back(static_cast<uint8_t>((sum + count / 2) / count));
      }
    }
  }
  return out;
}

CameraRecorder::CameraRecorder(RecordedCamera camera, std::filesystem::path folder,
                               std::string file_name, std::set<std::string> outputs,
                               std::shared_ptr<FileStore> store)
    : camera_(std::move(camera)),
      folder_(std::move(folder)),
      file_name_(std::move(file_name)),
      outputs_(std::move(outputs)),
      store_(std::move(store)),
      thumbnails_(kThumbnails) {}

bool CameraRecorder::writes_pictures() const {
  return std::ranges::any_of(kCameraFiles, [this](const CameraFile& file) {
    return file.format != FileFormat::kCsv && writes(std::string(file.output));
  });
}

Status CameraRecorder::start() {
  GLOAM_TRY_STATUS(store_->make_folder(folder_ / file_name_));
  GLOAM_TRY(std::unique_ptr<ByteSink> sink, store_->create(folder_ / file_name_ / "poses.csv"));
  GLOAM_TRY(CsvWriter poses,
            CsvWriter::start(std::move(sink), {"frame", "step", "time_s", "x_m", "y_m", "z_m", "qw",
                                               "qx", "qy", "qz"}));
  poses_ = std::move(poses);
  if (writes("events")) {
    GLOAM_TRY(sink, store_->create(folder_ / file_name_ / "events.csv"));
    GLOAM_TRY(CsvWriter events,
              CsvWriter::start(std::move(sink), {"time_s", "x_px", "y_px", "brighter"}));
    events_ = std::move(events);
  }
  return {};
}

Status CameraRecorder::add(const CameraFrame& frame) {
  GLOAM_TRY_STATUS(write_pictures(frame));
  GLOAM_TRY_STATUS(write_video(frame));
  GLOAM_TRY_STATUS(write_pose(frame));
  GLOAM_TRY_STATUS(write_events(frame));
  ++frames_;
  if (writes("contact_sheet")) {
    if (thumbnails_.wants_next()) {
      thumbnails_.add(make_thumbnail(frame, kThumbnailWidth));
    } else {
      thumbnails_.skip();
    }
  }
  return {};
}

Status CameraRecorder::write_pictures(const CameraFrame& frame) {
  for (const CameraFile& file : kCameraFiles) {
    if (!file.is_of_each_frame() || !writes(std::string(file.output))) continue;
    GLOAM_TRY(const std::vector<uint8_t> bytes, encode_frame_file(file, frame));
    if (bytes.empty()) continue;
    const std::filesystem::path folder = folder_ / file_name_ / file.folder;
    if (made_folders_.emplace(file.folder).second) GLOAM_TRY_STATUS(store_->make_folder(folder));
    GLOAM_TRY_STATUS(
        store_->write_file(folder / fmt::format("{:06}.{}", frame.index, file.extension()), bytes));
  }
  return {};
}

Status CameraRecorder::write_events(const CameraFrame& frame) {
  if (!events_) return {};
  for (const Event& event : frame.events) {
    const double row[] = {event.time, static_cast<double>(event.x), static_cast<double>(event.y),
                          event.brighter ? 1.0 : 0.0};
    GLOAM_TRY_STATUS(events_->add(row));
  }
  return {};
}

Status CameraRecorder::write_video(const CameraFrame& frame) {
  if (!writes("video") || frame.rgb.empty()) return {};
  if (!video_) {
    GLOAM_TRY(std::unique_ptr<ByteSink> sink, store_->create(folder_ / (file_name_ + ".mp4")));
    GLOAM_TRY(VideoWriter video,
              VideoWriter::start(std::move(sink), {.width = frame.intrinsics.width,
                                                   .height = frame.intrinsics.height,
                                                   .rate = camera_.rate}));
    video_ = std::move(video);
  }
  return video_->add(frame.index, frame.rgb);
}

Status CameraRecorder::write_pose(const CameraFrame& frame) {
  GLOAM_CHECK(poses_.has_value(), "the recorder has not been opened");
  const Pose X = optical_pose(frame.X_WC);
  const double row[] = {static_cast<double>(frame.index),
                        static_cast<double>(frame.step),
                        frame.time,
                        X.p.x,
                        X.p.y,
                        X.p.z,
                        X.q.w,
                        X.q.x,
                        X.q.y,
                        X.q.z};
  return poses_->add(row);
}

Status CameraRecorder::finish() {
  Status video = video_ ? video_->finish() : Status();
  Status poses = poses_ ? poses_->finish() : Status();
  Status events = events_ ? events_->finish() : Status();
  if (!video.ok()) return video;
  return poses.ok() ? events : poses;
}

}  // namespace gloam
