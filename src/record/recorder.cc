#include "record/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include "base/check.h"
#include "base/files.h"
#include "base/own_file.h"
#include "base/text.h"
#include "gloam/outputs.h"
#include "record/camera_recorder.h"
#include "record/csv.h"
#include "record/recorder_lanes.h"
#include "record/run_files.h"
#include "record/run_folder.h"
#include "record/run_sheet.h"
#include "render/film/h264.h"

namespace gloam {
namespace {

// Room that the first summary takes, so that the last one has it on a disk that is full by then.
constexpr size_t kReservedSummaryBytes = 16 << 10;  // [bytes]

// Puts a text into the room of the one before, where it fits.
void overwrite(const std::filesystem::path& path, std::string text) {
  std::error_code code;
  const uintmax_t room = std::filesystem::file_size(path, code);
  if (code || text.size() > room) return;
  text.resize(room, ' ');
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
}

constexpr const char* kSensorsName = "sensors";
constexpr size_t kQueuedRows = 4096;   // metric rows that may wait for the disk
constexpr size_t kPlottedRows = 2000;  // kept in memory for the contact sheet

class FolderRecorder : public Recorder {
 public:
  FolderRecorder(const RecorderOptions& options, const RunInfo& info)
      : options_(options),
        info_(info),
        outputs_(options.outputs.begin(), options.outputs.end()),
        rows_(kPlottedRows) {}
  ~FolderRecorder() override {
    if (metrics_worker_) metrics_worker_->close();
  }

  Status open() {
    GLOAM_TRY_STATUS(check());
    GLOAM_TRY_STATUS(make_folder(options_.folder));
    GLOAM_TRY_STATUS(lock_.take(options_.folder));
    GLOAM_TRY_STATUS(prepare_run_folder(options_.folder, options_.overwrite));
    // First the file that says whose folder this is, then everything else.
    entries_ = {"cameras.json", "labels.json"};
    if (outputs_.contains("metrics")) entries_.push_back("metrics.csv");
    if (outputs_.contains("state")) entries_.push_back("state.csv");
    if (outputs_.contains("contact_sheet")) entries_.push_back("contact_sheet.png");
    for (size_t i = 0; i < file_names_.size(); ++i) {
      entries_.push_back(file_names_[i]);
      if (outputs_of(info_.cameras[i]).contains("video"))
        entries_.push_back(file_names_[i] + ".mp4");
    }
    if (outputs_.contains("sensors") && !info_.sensors.empty()) entries_.push_back(kSensorsName);
    entries_.insert(entries_.end(), lidar_file_names_.begin(), lidar_file_names_.end());
    entries_.insert(entries_.end(), info_.beside.begin(), info_.beside.end());
    entries_.push_back(kSummaryName);
    std::string summary = summary_text(nullptr);
    summary.resize(std::max(summary.size(), kReservedSummaryBytes), ' ');
    GLOAM_TRY_STATUS(write_text(kSummaryName, summary));
    GLOAM_TRY_STATUS(write_text("cameras.json", cameras_json(info_.cameras, file_names_)));
    GLOAM_TRY_STATUS(write_text("labels.json", labels_json(info_.labels, info_.label_ids)));
    for (size_t i = 0; i < info_.cameras.size(); ++i) {
      CameraRecorder recorder(info_.cameras[i], options_.folder, file_names_[i],
                              outputs_of(info_.cameras[i]), options_.store);
      GLOAM_TRY_STATUS(cameras_.open(info_.cameras[i].name, std::move(recorder), options_));
    }
    for (size_t i = 0; i < info_.lidars.size(); ++i) {
      LidarRecorder recorder(info_.lidars[i], options_.folder / lidar_file_names_[i],
                             options_.store);
      GLOAM_TRY_STATUS(lidars_.open(info_.lidars[i].name, std::move(recorder), options_));
    }
    GLOAM_TRY_STATUS(open_table("metrics", info_.metric_columns, &metrics_));
    GLOAM_TRY_STATUS(open_table("state", info_.state_columns, &state_));
    GLOAM_TRY_STATUS(open_sensors());
    metrics_worker_ = std::make_unique<Worker>(kQueuedRows, overflow_of(options_));
    return {};
  }

  void add_frame(std::shared_ptr<const CameraFrame> frame) override {
    const std::string& camera = frame->camera;
    cameras_.add(camera, std::move(frame), &failure_);
  }

  void add_scan(std::shared_ptr<const LidarScan> scan) override {
    const std::string& lidar = scan->lidar;
    lidars_.add(lidar, std::move(scan), &failure_);
  }

  void add_metrics(std::span<const double> row) override {
    GLOAM_CHECK(row.size() == info_.metric_columns.size(), "a row has one value per column");
    if (failure_.failed()) return;
    post_row([this, values = std::vector<double>(row.begin(), row.end())]() mutable {
      if (failure_.failed()) return;
      if (metrics_) failure_.report(metrics_->add(values));
      ++metric_rows_;
      if (rows_.wants_next()) {
        rows_.add(std::move(values));
      } else {
        rows_.skip();
      }
    });
  }

  void add_state(std::span<const double> row) override {
    GLOAM_CHECK(row.size() == info_.state_columns.size(), "a row has one value per column");
    if (failure_.failed() || !state_) return;
    post_row([this, values = std::vector<double>(row.begin(), row.end())] {
      if (!failure_.failed()) failure_.report(state_->add(values));
    });
  }

  void add_sensor(const SensorMessage& message) override {
    const auto file = sensors_.find(message.sensor);
    if (failure_.failed() || file == sensors_.end()) return;
    std::vector<double> row = {static_cast<double>(message.index),
                               static_cast<double>(message.step), message.time, message.delivery};
    row.insert(row.end(), message.values.begin(), message.values.end());
    post_row([this, csv = &file->second, row = std::move(row)] {
      if (!failure_.failed()) failure_.report(csv->add(row));
    });
  }

  Status status() const override { return failure_.status(); }

  Status finish(const RunOutcome& outcome) override {
    cameras_.close();
    lidars_.close();
    metrics_worker_->close();
    // After a failure too: what can be ended properly should be.
    cameras_.finish(&failure_);
    lidars_.finish(&failure_);
    if (metrics_) failure_.report(metrics_->finish());
    if (state_) failure_.report(state_->finish());
    for (auto& [name, csv] : sensors_) failure_.report(csv.finish());
    if (outputs_.contains("contact_sheet") && !failure_.failed()) {
      std::vector<const CameraRecorder*> cameras;
      for (const RecordedCamera& camera : info_.cameras)
        cameras.push_back(&cameras_.recorder(camera.name));
      failure_.report(
          options_.store->write_file(options_.folder / "contact_sheet.png",
                                     run_sheet_png(info_, outcome, cameras, rows_.items())));
    }
    failure_.report(lock_.check());
    finish_summary(outcome);
    lock_.release();
    return failure_.status();
  }

  int64_t frames() const override {
    int64_t sum = 0;
    for (const RecordedCamera& camera : info_.cameras) {
      const CameraRecorder& recorder = cameras_.recorder(camera.name);
      if (recorder.writes_pictures()) sum += recorder.count();
    }
    return sum;
  }

  const std::filesystem::path& folder() const override { return options_.folder; }

 private:
  std::set<std::string> outputs_of(const RecordedCamera& camera) const {
    if (!camera.outputs) return outputs_;
    std::set<std::string> outputs(camera.outputs->begin(), camera.outputs->end());
    if (outputs_.contains("contact_sheet"))
      outputs.insert("contact_sheet");  // it shows all cameras
    return outputs;
  }

  Status open_table(const std::string& output, const std::vector<std::string>& columns,
                    std::optional<CsvWriter>* table) {
    if (!outputs_.contains(output)) return {};
    GLOAM_TRY(std::unique_ptr<ByteSink> sink,
              options_.store->create(options_.folder / (output + ".csv")));
    GLOAM_TRY(CsvWriter csv, CsvWriter::start(std::move(sink), columns));
    *table = std::move(csv);
    return {};
  }

  Status open_sensors() {
    if (!outputs_.contains("sensors") || info_.sensors.empty()) return {};
    GLOAM_TRY_STATUS(options_.store->make_folder(options_.folder / kSensorsName));
    for (size_t k = 0; k < info_.sensors.size(); ++k) {
      const RecordedSensor& sensor = info_.sensors[k];
      std::vector<std::string> columns = {"sample", "step", "time_s", "delivery_s"};
      columns.insert(columns.end(), sensor.columns.begin(), sensor.columns.end());
      GLOAM_TRY(std::unique_ptr<ByteSink> sink,
                options_.store->create(options_.folder / kSensorsName / sensor_file_names_[k]));
      GLOAM_TRY(CsvWriter csv, CsvWriter::start(std::move(sink), columns));
      sensors_.emplace(sensor.name, std::move(csv));
    }
    return {};
  }

  static Status check_outputs(const std::set<std::string>& outputs) {
    for (const std::string& output : outputs) {
      const std::vector<std::string> known(kRecordOutputs.begin(), kRecordOutputs.end());
      if (std::find(known.begin(), known.end(), output) != known.end()) continue;
      return Error{ErrorKind::kUsage,
                   fmt::format("there is no output '{}'", output),
                   {},
                   suggest_name(output, known)};
    }
    return {};
  }

  Status check() {
    GLOAM_TRY_STATUS(check_outputs(outputs_));
    GLOAM_CHECK(options_.queue_frames > 0, "a queue holds at least one frame");
    std::set<std::string> names;
    FileNames files{kSensorsName, "cameras.json",      "labels.json", "metrics.csv",
                    "state.csv",  "contact_sheet.png", kSummaryName};
    for (const RecordedCamera& camera : info_.cameras) {
      GLOAM_TRY_STATUS(check_outputs(outputs_of(camera)));
      if (!names.insert(camera.name).second)
        return Error{ErrorKind::kInput,
                     fmt::format("two cameras are named '{}'", camera.name),
                     {},
                     "rename one of them"};
      const int64_t pixels = int64_t{camera.intrinsics.width} * camera.intrinsics.height;
      if (outputs_of(camera).contains("video") &&
          (pixels > kMaxVideoPixels || camera.intrinsics.width < 16 ||
           camera.intrinsics.height < 16))
        return Error{
            ErrorKind::kUnsupported,
            fmt::format("camera '{}' with {} x {} pixels cannot be recorded as H.264 video",
                        camera.name, camera.intrinsics.width, camera.intrinsics.height),
            {},
            "change its resolution, or record 'png' instead of 'video'"};
      file_names_.push_back(files.take(camera.name, {"", ".mp4"}));
    }
    names.clear();
    for (const RecordedLidar& lidar : info_.lidars) {
      if (!names.insert(lidar.name).second)
        return Error{ErrorKind::kInput,
                     fmt::format("two lidars are named '{}'", lidar.name),
                     {},
                     "rename one of them"};
      lidar_file_names_.push_back(files.take(lidar.name));
    }
    FileNames sensor_files;
    for (const RecordedSensor& sensor : info_.sensors)
      sensor_file_names_.push_back(sensor_files.take(sensor.name) + ".csv");
    return {};
  }

  void post_row(Worker::Job job) {
    const bool is_open = metrics_worker_->post(std::move(job));
    GLOAM_CHECK(is_open, "a row after the end of the recording");
  }

  Status write_text(const char* name, const std::string& text) {
    return options_.store->write_file(options_.folder / name,
                                      {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  }

  void finish_summary(const RunOutcome& outcome) {
    const Status status = write_text(kSummaryName, summary_text(&outcome));
    if (status.ok()) return;
    failure_.report(status);
    overwrite(options_.folder / kSummaryName, summary_text(&outcome));
  }

  std::string summary_text(const RunOutcome* outcome) {
    std::vector<CameraCounts> counts, scans;
    for (size_t i = 0; i < info_.cameras.size(); ++i)
      counts.push_back(cameras_.counts(info_.cameras[i].name, file_names_[i]));
    for (size_t i = 0; i < info_.lidars.size(); ++i)
      scans.push_back(lidars_.counts(info_.lidars[i].name, lidar_file_names_[i]));
    const Status status = failure_.status();
    return summary_json(info_, outcome, counts, scans, sensor_file_names_, metric_rows_,
                        metrics_worker_ ? metrics_worker_->dropped() : 0, entries_,
                        status.ok() ? "" : status.error().to_string());
  }

  const RecorderOptions options_;
  const RunInfo info_;
  const std::set<std::string> outputs_;
  std::vector<std::string> file_names_;  // file names of the cameras
  std::vector<std::string> lidar_file_names_, sensor_file_names_;
  std::vector<std::string> entries_;  // entries of the folder, as listed in the summary
  FolderLock lock_;
  FirstFailure failure_;
  std::optional<CsvWriter> metrics_, state_;
  std::map<std::string, CsvWriter> sensors_;  // writers by name
  int64_t metric_rows_ = 0;
  Timeline<std::vector<double>> rows_;
  // The threads come last, so they end before anything that they use.
  Lanes<CameraRecorder> cameras_;
  Lanes<LidarRecorder> lidars_;
  std::unique_ptr<Worker> metrics_worker_;
};

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::start(const RecorderOptions& options,
                                                  const RunInfo& info) {
  auto recorder = std::make_unique<FolderRecorder>(options, info);
  GLOAM_TRY_STATUS(recorder->open());
  return std::unique_ptr<Recorder>(std::move(recorder));
}

}  // namespace gloam
