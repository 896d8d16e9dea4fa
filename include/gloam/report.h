#pragma once
// Reports and images of finished runs.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/trajectory.h"

namespace gloam {

struct ReportRequest {
  std::vector<std::filesystem::path> runs;  ///< results folders of runs and replays
  std::filesystem::path out;                ///< HTML file; its folder must exist
  bool overwrite = false;                   ///< replace an existing file
  std::string title = {};                   ///< empty = names of the scenes
  int instants = 6;                         ///< images in a strip
  uint64_t picture_bytes = 24 << 20;  ///< limit for all images together; further images are omitted
};
struct ReportOutcome {
  size_t runs = 0;              ///< runs in the report
  int pictures = 0;             ///< number of images in its strips
  uint64_t bytes = 0;           ///< size of the file
  std::vector<Error> left_out;  ///< folders, tables and videos that could not be read
};
/// Writes one self-contained HTML file: tables of results side by side, groups of runs with
/// bootstrap intervals, curves, images of the same instants, paths from above. Data that cannot be
/// read is listed in the page and in `left_out`. Errors: no run can be read, the file already
/// exists or cannot be written.
Result<ReportOutcome> write_report(const ReportRequest& request);

/// Plots the two trajectories from above and the errors over time, as SVG.
std::string trajectory_plot(const TrajectoryPair& pair, const PoseErrors& absolute);

/// Writes the messages of a log's topic as Apache Parquet (zstd): the columns of
/// write_topic_table() as texts, 64-bit integers and doubles; missing fields are null. Returns the
/// number of rows. Errors: as for write_topic_table().
Result<int64_t> write_topic_parquet(const std::filesystem::path& log, const std::string& topic,
                                    const std::filesystem::path& to);
/// Writes a table of a results folder (metrics.csv, state.csv …) as Parquet: doubles, null for
/// fields that are empty or not numbers.
Result<int64_t> write_table_parquet(const std::filesystem::path& csv,
                                    const std::filesystem::path& to);

/// Writes the images of an Image or CompressedImage topic (rgb8, bgr8, with alpha, mono8; depth
/// 32FC1 and 16UC1; JPEG, PNG) as FOLDER/000000.png … and stamps.csv; depth as 16-bit millimetres.
/// Returns the number of images. Errors: no such topic, another type or encoding, a folder that is
/// not empty.
Result<int64_t> write_topic_pictures(const std::filesystem::path& log, const std::string& topic,
                                     const std::filesystem::path& folder);
/// Writes the same images as an H.264 video at the rate of their stamps. Depth is coloured from red
/// (near) to blue (farthest point of the first image).
Result<int64_t> write_topic_video(const std::filesystem::path& log, const std::string& topic,
                                  const std::filesystem::path& to);

}  // namespace gloam
