#pragma once
// Everything that is written for one camera. Runs on that camera's worker.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "gloam/camera.h"
#include "record/csv.h"
#include "record/file_store.h"
#include "record/recorder.h"
#include "record/timeline.h"
#include "render/film/video.h"

namespace gloam {

/// Small pictures of one frame for the contact sheet.
struct Thumbnail {
  double time = 0;  ///< [s]
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;  ///< empty = the frame had none; likewise below
  std::vector<float> depth;  ///< [m]
  std::vector<uint32_t> instance;
};

class CameraRecorder {
 public:
  CameraRecorder(RecordedCamera camera, std::filesystem::path folder, std::string file_name,
                 std::set<std::string> outputs, std::shared_ptr<FileStore> store);

  /// Makes the folders and poses.csv.
  Status start();
  Status add(const CameraFrame& frame);
  /// Ends the video and the table; what can be ended is, even after an error.
  Status finish();

  const RecordedCamera& camera() const { return camera_; }
  const std::string& file_name() const { return file_name_; }
  bool writes(const std::string& output) const { return outputs_.contains(output); }
  /// True if files of pictures or a video are written, not the poses or another thing alone.
  bool writes_pictures() const;
  int64_t count() const { return frames_; }  ///< frames so far
  const std::vector<Thumbnail>& thumbnails() const { return thumbnails_.items(); }

 private:
  Status write_pictures(const CameraFrame& frame);
  Status write_pose(const CameraFrame& frame);
  Status write_events(const CameraFrame& frame);
  Status write_video(const CameraFrame& frame);

  RecordedCamera camera_;
  std::filesystem::path folder_;
  std::string file_name_;
  std::set<std::string> outputs_;
  std::shared_ptr<FileStore> store_;
  std::set<std::string> made_folders_;
  std::optional<CsvWriter> poses_, events_;
  std::optional<VideoWriter> video_;
  int64_t frames_ = 0;
  Timeline<Thumbnail> thumbnails_;
};

/// The channels shrunk to `width` pixels: colours averaged, depth and ids picked.
Thumbnail make_thumbnail(const CameraFrame& frame, int width);

}  // namespace gloam
