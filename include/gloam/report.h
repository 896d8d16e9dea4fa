#pragma once
// Pages and pictures of finished runs, for people.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/trajectory.h"

namespace gloam {

struct ReportRequest {
  std::vector<std::filesystem::path> runs;  ///< results folders, of runs and of replays
  std::filesystem::path out;                ///< HTML file; its folder must exist
  bool overwrite = false;                   ///< a file of that name is replaced
  std::string title = {};                   ///< empty = of the scenes
  int instants = 6;                         ///< pictures in a strip
  uint64_t picture_bytes = 24 << 20;        ///< of all pictures together; more are left out
};
struct ReportOutcome {
  size_t runs = 0;              ///< that are in it
  int pictures = 0;             ///< in its strips
  uint64_t bytes = 0;           ///< of the file
  std::vector<Error> left_out;  ///< folders, tables and videos that could not be read
};
/// Writes one HTML file that needs nothing else: tables of results side by side, groups of runs
/// with bootstrap intervals, curves, pictures of the same instants, ways from above. What cannot be
/// read of some runs is told in the page and in `left_out`. Errors: no run that can be read, the
/// file is there already or cannot be written.
Result<ReportOutcome> write_report(const ReportRequest& request);

/// The two trajectories from above and the errors over time, as an SVG file.
std::string trajectory_plot(const TrajectoryPair& pair, const PoseErrors& absolute);

/// Messages of a log's topic as Apache Parquet (zstd): the columns of write_topic_table(), texts,
/// 64-bit integers and doubles, null where a message has less. Returns the number of rows. Errors:
/// as of write_topic_table().
Result<int64_t> write_topic_parquet(const std::filesystem::path& log, const std::string& topic,
                                    const std::filesystem::path& to);
/// A table of a results folder (metrics.csv, state.csv …) as Parquet: doubles, null where a field
/// is empty or no number.
Result<int64_t> write_table_parquet(const std::filesystem::path& csv,
                                    const std::filesystem::path& to);

/// Pictures of an Image or CompressedImage topic (rgb8, bgr8, with alpha, mono8; depth 32FC1 and
/// 16UC1; JPEG, PNG) as FOLDER/000000.png … and stamps.csv; depth as 16-bit millimetres. Returns
/// how many. Errors: no such topic, another type or encoding, a folder that is not empty.
Result<int64_t> write_topic_pictures(const std::filesystem::path& log, const std::string& topic,
                                     const std::filesystem::path& folder);
/// The same as an H.264 video at the rate of their stamps; depth in colours, red near, blue as far
/// as the farthest of the first picture.
Result<int64_t> write_topic_video(const std::filesystem::path& log, const std::string& topic,
                                  const std::filesystem::path& to);

}  // namespace gloam
