#include "record/lidar_recorder.h"

#include <fmt/format.h>

#include <array>

#include "base/check.h"
#include "record/point_cloud_file.h"

namespace gloam {
namespace {

struct Format {
  const char* name;
  std::vector<uint8_t> (*encode)(const LidarScan&);
};
constexpr std::array<Format, 3> kFormats = {
    {{"pcd", encode_pcd}, {"ply", encode_ply}, {"npy", encode_npy}}};

const Format& format_of(const std::string& name) {
  for (const Format& format : kFormats) {
    if (format.name == name) return format;
  }
  GLOAM_CHECK(false, "a recorded LiDAR has an unknown file format");
  return kFormats[0];
}

}  // namespace

LidarRecorder::LidarRecorder(RecordedLidar lidar, std::filesystem::path folder,
                             std::shared_ptr<FileStore> store)
    : lidar_(std::move(lidar)), folder_(std::move(folder)), store_(std::move(store)) {}

Status LidarRecorder::start() {
  GLOAM_TRY_STATUS(store_->make_folder(folder_));
  for (const std::string& format : lidar_.formats) {
    GLOAM_TRY_STATUS(store_->make_folder(folder_ / format));
  }
  GLOAM_TRY(std::unique_ptr<ByteSink> sink, store_->create(folder_ / "scans.csv"));
  GLOAM_TRY(
      CsvWriter table,
      CsvWriter::start(std::move(sink),
                       {"scan", "step", "start_s", "end_s", "points", "start_x_m", "start_y_m",
                        "start_z_m", "start_qw", "start_qx", "start_qy", "start_qz", "end_x_m",
                        "end_y_m", "end_z_m", "end_qw", "end_qx", "end_qy", "end_qz"}));
  table_ = std::move(table);
  return {};
}

Status LidarRecorder::add(const LidarScan& scan) {
  for (const std::string& name : lidar_.formats) {
    const std::vector<uint8_t> bytes = format_of(name).encode(scan);
    GLOAM_TRY_STATUS(
        store_->write_file(folder_ / name / fmt::format("{:06}.{}", scan.index, name), bytes));
  }
  const Pose &a = scan.X_WL_start, &b = scan.X_WL_end;
  const double row[] = {static_cast<double>(scan.index),
                        static_cast<double>(scan.step),
                        scan.start,
                        scan.end,
                        static_cast<double>(scan.size()),
                        a.p.x,
                        a.p.y,
                        a.p.z,
                        a.q.w,
                        a.q.x,
                        a.q.y,
                        a.q.z,
                        b.p.x,
                        b.p.y,
                        b.p.z,
                        b.q.w,
                        b.q.x,
                        b.q.y,
                        b.q.z};
  GLOAM_TRY_STATUS(table_->add(row));
  ++scans_;
  return {};
}

Status LidarRecorder::finish() { return table_ ? table_->finish() : Status(); }

}  // namespace gloam
