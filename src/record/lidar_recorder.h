#pragma once
// Everything that is written for one LiDAR. Runs on that LiDAR's worker.

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gloam/sensor.h"
#include "record/csv.h"
#include "record/file_store.h"

namespace gloam {

struct RecordedLidar {
  std::string name;                            ///< as in LidarScan::lidar
  Rational rate = {10, 1};                     ///< scans per second of simulation time
  std::vector<std::string> formats = {"pcd"};  ///< pcd ply npy
};

class LidarRecorder {
 public:
  LidarRecorder(RecordedLidar lidar, std::filesystem::path folder,
                std::shared_ptr<FileStore> store);

  /// Makes the folders and scans.csv.
  Status start();
  Status add(const LidarScan& scan);
  Status finish();
  int64_t count() const { return scans_; }  ///< scans so far

 private:
  RecordedLidar lidar_;
  std::filesystem::path folder_;
  std::shared_ptr<FileStore> store_;
  std::optional<CsvWriter> table_;
  int64_t scans_ = 0;
};

}  // namespace gloam
