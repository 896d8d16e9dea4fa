#include "record/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "base/files.h"
#include "base/log.h"
#include "geometry/image/image_exr.h"
#include "geometry/image/image_file.h"
#include "gloam/scene.h"
#include "record/frame_files.h"
#include "record/run_folder.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr int kWidth = 64, kHeight = 48, kFrames = 6;
const std::vector<std::string> kEverything = {
    "video", "png", "depth_png", "depth_exr", "segmentation", "metrics", "contact_sheet"};

/// A folder of its own for each test, removed afterwards.
class RecorderTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("gloam_recorder_" + std::to_string(getpid()) + "_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    set_log_level(LogLevel::kOff);
  }
  void TearDown() override {
    fs::remove_all(folder_);
    set_log_level(LogLevel::kInfo);
  }
  RecorderOptions options() const { return {.folder = folder_ / "run", .outputs = kEverything}; }
  fs::path run() const { return folder_ / "run"; }
  fs::path folder_;
};

Intrinsics intrinsics() { return {kWidth, kHeight, 50, 50, kWidth / 2.0, kHeight / 2.0}; }

RunInfo run_info() {
  RunInfo info;
  info.title = "A test, with \"quotes\"";
  info.versions = {{"gloam", "0.1.0"}, {"mujoco", "4.0.1"}};
  info.scene_file = "room.toml";
  info.scene_hash = "0123456789abcdef";
  info.seed = 42;
  info.timestep = 0.002;
  info.duration = 0.3;
  info.cameras = {{"go1/front", intrinsics()}, {"chase", intrinsics()}};
  info.labels = {{1, "floor", "world", "wood", 1, "floor", 1, "floor"},
                 {2, "go1/leg", "go1/FL", "", 7, "go1", 3, "go"},
                 {3, "go1/trunk", "go1/trunk", "", 7, "go1", 3, "go"}};
  info.metric_columns = {"time_s", "vx_mps", "goal_vx_mps"};
  info.plots = {{"forward speed", "m/s", "vx_mps", "goal_vx_mps"}};
  return info;
}

std::shared_ptr<CameraFrame> make_frame(const std::string& camera, int index) {
  auto frame = std::make_shared<CameraFrame>();
  frame->camera = camera;
  frame->index = index;
  frame->step = index * 25;
  frame->time = index * 0.05;
  frame->intrinsics = intrinsics();
  frame->X_WC = {{1, 2, 3}, {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (const int v : {x * 3 + index, y * 4, 100}) frame->rgb.push_back(static_cast<uint8_t>(v));
      frame->depth.push_back(x == 0 ? std::numeric_limits<float>::infinity()
                                    : 0.1f * static_cast<float>(x + index));
      frame->instance.push_back(x < 20 ? 1 : 7);
      frame->semantic.push_back(x < 20 ? 1 : 3);
    }
  }
  return frame;
}

/// Feeds a whole run.
void feed(Recorder* recorder, int frames = kFrames) {
  for (int i = 0; i < frames; ++i) {
    for (const char* camera : {"go1/front", "chase"}) recorder->add_frame(make_frame(camera, i));
    const double row[] = {0.05 * i, 0.1 * i, i == 2 ? NAN : 1.0 / 3};
    recorder->add_metrics(row);
  }
}

std::vector<std::vector<std::string>> read_csv(const fs::path& path) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream text(read_text_file(path).value());
  for (std::string line; std::getline(text, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

nlohmann::json read_json(const fs::path& path) {
  return nlohmann::json::parse(read_text_file(path).value());
}

/// Fills the channel that `file` holds with numbers that differ from pixel to pixel.
void fill(CameraFrame* frame, const CameraFile& file) {
  const auto ramp = [&](auto plane) {
    auto& values = frame->*plane;
    using Value = std::decay_t<decltype(values[0])>;
    if constexpr (std::is_arithmetic_v<Value>) {
      values.resize(size_t{kWidth} * kHeight * 3);
      for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<Value>(i % 251);
    }
  };
  std::visit(ramp, file.plane);
  if (file.channel == "boxes") frame->objects.emplace_back().name = "box";
}

TEST_F(RecorderTest, EveryOutputOfACameraHasItsFiles) {
  for (const CameraFile& file : kCameraFiles) {
    if (!file.is_of_each_frame()) continue;
    SCOPED_TRACE(file.folder);
    CameraFrame frame;
    frame.intrinsics = intrinsics();
    EXPECT_TRUE(encode_frame_file(file, frame)->empty()) << "nothing to write, and yet a file";
    fill(&frame, file);
    const std::vector<uint8_t> bytes = *encode_frame_file(file, frame);
    const std::string_view extension = file.extension();
    if (extension == "json") {
      EXPECT_EQ(nlohmann::json::parse(bytes)["objects"][0]["name"], "box");
    } else if (extension == "exr") {
      const auto image = decode_exr(bytes, "exr");
      ASSERT_TRUE(image.ok()) << image.error().to_string();
      ASSERT_FALSE(image->names.empty());
      EXPECT_EQ(image->find(image->names.front())->size(), size_t{kWidth} * kHeight);
    } else {
      EXPECT_EQ(extension, "png");
      EXPECT_GT(bytes.size(), 100u);
    }
  }
}

TEST_F(RecorderTest, MorePartsThanAPictureCanNumberAreRefused) {
  CameraFrame frame;
  frame.intrinsics = intrinsics();
  frame.part.assign(size_t{kWidth} * kHeight, 1);
  const auto* parts = std::ranges::find(kCameraFiles, "part", &CameraFile::folder);
  ASSERT_NE(parts, kCameraFiles.end());
  frame.part_count = (1 << 24) - 1;
  EXPECT_TRUE(encode_frame_file(*parts, frame).ok());
  ++frame.part_count;
  EXPECT_FALSE(encode_frame_file(*parts, frame).ok());
}

TEST_F(RecorderTest, WritesEverythingAndItReadsBack) {
  auto recorder = Recorder::start(options(), run_info());
  ASSERT_TRUE(recorder.ok()) << recorder.error().to_string();
  EXPECT_EQ(read_json(run() / "summary.json")["state"], "recording");
  feed(recorder->get());
  RunOutcome outcome{.steps = 150, .simulated = 0.3, .final_state_hash = "feedc0de"};
  outcome.timings = {{"total", 1.5}};
  outcome.results = {{"falls", 0}};
  const Status status = (*recorder)->finish(outcome);
  ASSERT_TRUE(status.ok()) << status.error().to_string();

  for (const char* camera : {"go1_front", "chase"}) {
    for (int i = 0; i < kFrames; ++i) {
      const auto frame = make_frame("x", i);
      const std::string name = "00000" + std::to_string(i);
      const fs::path folder = run() / camera;
      EXPECT_EQ(read_image(folder / "rgb" / (name + ".png"))->texels, frame->rgb);
      const auto png16 = [&](const char* kind) {
        const fs::path path = folder / kind / (name + ".png");
        return decode_png16(read_file(path).value(), path.string()).value().texels;
      };
      EXPECT_THAT(png16("instance"), testing::ElementsAreArray(frame->instance));
      EXPECT_THAT(png16("semantic"), testing::ElementsAreArray(frame->semantic));
      const std::vector<uint16_t> mm = png16("depth");
      EXPECT_EQ(mm[0], 0);
      for (size_t x = 1; x < kWidth; ++x) EXPECT_EQ(mm[x], 100 * (static_cast<int>(x) + i));
      const fs::path exr = folder / "depth_exr" / (name + ".exr");
      EXPECT_EQ(*decode_exr(read_file(exr).value(), "exr")->find("Z"), frame->depth);
    }
    EXPECT_GT(fs::file_size(run() / (std::string(camera) + ".mp4")), 1000u);
    const auto poses = read_csv(run() / camera / "poses.csv");
    ASSERT_EQ(poses.size(), kFrames + 1u);
    EXPECT_EQ(poses[0][2], "time_s");
    EXPECT_EQ(poses[3][1], "50");
    // Half a turn about x after a quarter turn about z: (w, x, y, z) = (0, s, s, 0).
    EXPECT_NEAR(std::stod(poses[1][6]), 0, 1e-12);
    EXPECT_NEAR(std::stod(poses[1][7]), std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(std::stod(poses[1][8]), std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(std::stod(poses[1][9]), 0, 1e-12);
  }
  const auto metrics = read_csv(run() / "metrics.csv");
  ASSERT_EQ(metrics.size(), kFrames + 1u);
  EXPECT_EQ(metrics[0], (std::vector<std::string>{"time_s", "vx_mps", "goal_vx_mps"}));
  EXPECT_EQ(std::stod(metrics[2][2]), 1.0 / 3);  // every digit
  EXPECT_EQ(metrics[3].size(), 2u);              // not a number: an empty last field

  const nlohmann::json summary = read_json(run() / "summary.json");
  EXPECT_EQ(summary["state"], "finished");
  EXPECT_EQ(summary["exit_reason"], "completed");
  EXPECT_EQ(summary["versions"]["mujoco"], "4.0.1");
  EXPECT_EQ(summary["scene"]["hash"], "0123456789abcdef");
  EXPECT_EQ(summary["seed"], 42);
  EXPECT_EQ(summary["final_state_hash"], "feedc0de");
  EXPECT_EQ(summary["cameras"][0]["frames"], kFrames);
  EXPECT_EQ(summary["cameras"][0]["dropped_frames"], 0);
  EXPECT_EQ(summary["metrics"]["rows"], kFrames);
  EXPECT_TRUE(summary["recording_error"].is_null());

  const nlohmann::json labels = read_json(run() / "labels.json");
  EXPECT_EQ(labels["categories"].size(), 2u);
  EXPECT_EQ(labels["instances"][1]["id"], 7);
  EXPECT_EQ(labels["instances"][1]["name"], "go1");
  EXPECT_EQ(labels["instances"][1]["category_id"], 3);
  EXPECT_EQ(labels["parts"].size(), 3u);
  const nlohmann::json cameras = read_json(run() / "cameras.json");
  EXPECT_EQ(cameras["cameras"][0]["frame_id"], "go1/front_optical_frame");
  EXPECT_EQ(cameras["cameras"][0]["camera_info"]["k"][2], kWidth / 2.0 - 0.5);
  EXPECT_GT(read_image(run() / "contact_sheet.png")->width, 800);
}

TEST_F(RecorderTest, WritesOnlyWhatWasAskedFor) {
  RecorderOptions only = options();
  only.outputs = {"metrics"};
  auto recorder = Recorder::start(only, run_info());
  ASSERT_TRUE(recorder.ok());
  feed(recorder->get());
  ASSERT_TRUE((*recorder)->finish({}).ok());
  EXPECT_TRUE(fs::exists(run() / "metrics.csv"));
  EXPECT_TRUE(fs::exists(run() / "chase" / "poses.csv"));
  EXPECT_FALSE(fs::exists(run() / "chase" / "rgb"));
  EXPECT_FALSE(fs::exists(run() / "chase.mp4"));
  EXPECT_FALSE(fs::exists(run() / "contact_sheet.png"));
}

TEST_F(RecorderTest, ACameraMayHaveOutputsOfItsOwn) {
  RecorderOptions o = options();
  o.outputs = {"png", "metrics", "contact_sheet"};
  RunInfo info = run_info();
  info.cameras[0].outputs = {"video", "depth_png"};
  info.cameras[1].outputs.reset();
  auto recorder = Recorder::start(o, info);
  ASSERT_TRUE(recorder.ok());
  feed(recorder->get());
  ASSERT_TRUE((*recorder)->finish({}).ok());
  const fs::path run = o.folder;
  EXPECT_TRUE(fs::exists(run / "go1_front.mp4"));
  EXPECT_TRUE(fs::exists(run / "go1_front/depth/000001.png"));
  EXPECT_FALSE(fs::exists(run / "go1_front/rgb"));
  EXPECT_FALSE(fs::exists(run / "chase.mp4"));
  EXPECT_TRUE(fs::exists(run / "chase/rgb/000001.png"));
  EXPECT_FALSE(fs::exists(run / "chase/depth"));
  EXPECT_TRUE(fs::exists(run / "contact_sheet.png"));
  info.cameras[0].outputs = {"vidoe"};
  o.overwrite = true;
  const auto refused = Recorder::start(o, info);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().hint.find("video"), std::string::npos);
}

TEST_F(RecorderTest, EqualRunsGiveEqualFiles) {
  std::vector<std::vector<uint8_t>> files[2];
  for (int round = 0; round < 2; ++round) {
    RecorderOptions o = options();
    o.overwrite = true;
    auto recorder = Recorder::start(o, run_info());
    ASSERT_TRUE(recorder.ok()) << recorder.error().to_string();
    feed(recorder->get());
    ASSERT_TRUE((*recorder)->finish({}).ok());
    for (const char* name : {"chase.mp4", "contact_sheet.png", "metrics.csv", "summary.json",
                             "chase/depth_exr/000003.exr", "chase/rgb/000002.png"})
      files[round].push_back(read_file(run() / name).value());
  }
  EXPECT_EQ(files[0], files[1]);
}

// --- folders ---

TEST_F(RecorderTest, NeverTouchesWhatItDidNotWrite) {
  fs::create_directories(run());
  std::ofstream(run() / "thesis.txt") << "years of work";
  for (const bool overwrite : {false, true}) {
    RecorderOptions o = options();
    o.overwrite = overwrite;
    const auto refused = Recorder::start(o, run_info());
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
    EXPECT_NE(refused.error().to_string().find("--out"), std::string::npos);
  }
  EXPECT_EQ(read_text_file(run() / "thesis.txt").value(), "years of work");
}

TEST_F(RecorderTest, AnEarlierRecordingIsReplacedOnlyWhenAsked) {
  {
    auto recorder = Recorder::start(options(), run_info());
    ASSERT_TRUE(recorder.ok());
    feed(recorder->get());
    ASSERT_TRUE((*recorder)->finish({}).ok());
  }
  std::ofstream(run() / "notes.txt") << "mine";
  const auto refused = Recorder::start(options(), run_info());
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().hint.find("--overwrite"), std::string::npos);
  EXPECT_TRUE(fs::exists(run() / "chase" / "rgb" / "000005.png"));
  RecorderOptions again = options();
  again.overwrite = true;
  {
    auto recorder = Recorder::start(again, run_info());
    ASSERT_TRUE(recorder.ok()) << recorder.error().to_string();
    feed(recorder->get(), 2);
    ASSERT_TRUE((*recorder)->finish({}).ok());
  }
  EXPECT_FALSE(fs::exists(run() / "chase" / "rgb" / "000005.png"));
  EXPECT_EQ(read_text_file(run() / "notes.txt").value(), "mine");
}

TEST_F(RecorderTest, ASummaryFromAStrangerRemovesNothingOutside) {
  fs::create_directories(run() / "sub");
  std::ofstream(folder_ / "outside.txt") << "keep";
  fs::create_symlink(folder_, run() / "link");
  for (
      const char* text :
      {R"({"format": "gloam-run 1", "entries": ["../outside.txt", "..", ".", "/", "link", "sub/../../outside.txt", 7, ""]})",
       R"({"format": "gloam-run 1"})", R"({"format": 3, "entries": ["sub"]})", "[1, 2]",
       "garbage"}) {
    std::ofstream(run() / "summary.json") << text;
    (void)prepare_run_folder(run(), true).ok();
    EXPECT_TRUE(fs::exists(folder_ / "outside.txt")) << text;
    EXPECT_TRUE(fs::exists(run() / "sub")) << text;
  }
}

TEST_F(RecorderTest, NextFolderCountsUp) {
  EXPECT_EQ(next_run_folder(folder_, "demo").filename(), "demo-001");
  fs::create_directories(folder_ / "demo-001");
  EXPECT_EQ(next_run_folder(folder_, "demo").filename(), "demo-002");
  EXPECT_EQ(safe_file_name("go1/front cam"), "go1_front_cam");
  EXPECT_EQ(safe_file_name(".."), "_.");
  EXPECT_EQ(safe_file_name(""), "unnamed");
}

// Names that differ in what file names cannot say, or in case alone, are files of their own, and
// the summary tells whose they are.
TEST_F(RecorderTest, NoTwoThingsWriteOneFile) {
  RecorderOptions o = options();
  o.outputs = {"png", "sensors"};
  RunInfo info = run_info();
  info.cameras = {{"a/b", intrinsics()}, {"a_b", intrinsics()}, {"A_B", intrinsics()}};
  info.sensors = {{"s/1", {"value_0"}}, {"s_1", {"value_0"}}, {"S_1", {"value_0"}}};
  auto recorder = Recorder::start(o, info);
  ASSERT_TRUE(recorder.ok());
  for (const char* sensor : {"s/1", "s_1", "S_1"}) {
    SensorMessage message;
    message.sensor = sensor;
    message.values = {static_cast<double>(sensor[0])};
    (*recorder)->add_sensor(message);
  }
  ASSERT_TRUE((*recorder)->finish({}).ok());
  const auto summary = read_json(run() / "summary.json");
  std::set<std::string> names;
  for (const auto& camera : summary["cameras"]) names.insert(camera["folder"].get<std::string>());
  EXPECT_EQ(names, (std::set<std::string>{"a_b", "a_b_2", "A_B_3"}));
  ASSERT_EQ(summary["sensors"].size(), 3u);
  EXPECT_EQ(summary["sensors"][1]["name"], "s_1");
  for (const auto& sensor : summary["sensors"])
    EXPECT_EQ(read_csv(run() / sensor["file"].get<std::string>()).size(), 2u);
  FileNames stills;
  EXPECT_EQ(stills.take("a", {".png", "_depth.png"}), "a");
  EXPECT_EQ(stills.take("a_depth", {".png", "_depth.png"}), "a_depth_2");
}

TEST_F(RecorderTest, LabelsHaveMuJoCosIds) {
  RunInfo info = run_info();
  info.label_ids = {{4, 0}, {7, 2}, {-1, -1}};
  auto recorder = Recorder::start(options(), info);
  ASSERT_TRUE(recorder.ok());
  ASSERT_TRUE((*recorder)->finish({}).ok());
  const auto parts = read_json(run() / "labels.json")["parts"];
  EXPECT_EQ(parts[1]["geom_id"], 7);
  EXPECT_EQ(parts[1]["body_id"], 2);
  EXPECT_TRUE(parts[2]["geom_id"].is_null());
}

TEST_F(RecorderTest, BadOptionsAreErrorsBeforeAnythingIsWritten) {
  RecorderOptions o = options();
  o.outputs = {"vidoe"};
  const auto unknown = Recorder::start(o, run_info());
  ASSERT_FALSE(unknown.ok());
  EXPECT_NE(unknown.error().to_string().find("video"), std::string::npos);
  RunInfo twice = run_info();
  twice.cameras.push_back(twice.cameras[0]);
  EXPECT_FALSE(Recorder::start(options(), twice).ok());
  RunInfo large = run_info();
  large.cameras[0].intrinsics.width = large.cameras[0].intrinsics.height = 16384;
  const auto refused = Recorder::start(options(), large);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().to_string().find("go1/front"), std::string::npos);
  EXPECT_FALSE(fs::exists(run()));
}

TEST_F(RecorderTest, CamerasWhoseNamesCollideAsFilesStaySeparate) {
  RunInfo info = run_info();
  info.cameras = {{"a/b", intrinsics()}, {"a b", intrinsics()}, {"metrics.csv", intrinsics()}};
  auto recorder = Recorder::start(options(), info);
  ASSERT_TRUE(recorder.ok()) << recorder.error().to_string();
  for (const RecordedCamera& camera : info.cameras)
    (*recorder)->add_frame(make_frame(camera.name, 0));
  ASSERT_TRUE((*recorder)->finish({}).ok());
  EXPECT_TRUE(fs::exists(run() / "a_b" / "rgb" / "000000.png"));
  EXPECT_TRUE(fs::exists(run() / "a_b_2" / "rgb" / "000000.png"));
  EXPECT_TRUE(fs::is_directory(run() / "metrics.csv_2"));
  EXPECT_TRUE(fs::is_regular_file(run() / "metrics.csv"));
}

// --- slow and failing disks ---

/// Does `before` before every operation that changes the disk; it may fail it.
class GuardedStore : public FileStore {
 public:
  explicit GuardedStore(std::function<Status()> before) : before_(std::move(before)) {}
  Status make_folder(const fs::path& path) override {
    GLOAM_TRY_STATUS(before_());
    return disk_->make_folder(path);
  }
  Status write_file(const fs::path& path, std::span<const uint8_t> bytes) override {
    GLOAM_TRY_STATUS(before_());
    return disk_->write_file(path, bytes);
  }
  Result<std::unique_ptr<ByteSink>> create(const fs::path& path) override {
    GLOAM_TRY_STATUS(before_());
    GLOAM_TRY(std::unique_ptr<ByteSink> sink, disk_->create(path));
    return std::unique_ptr<ByteSink>(new Sink(std::move(sink), before_));
  }

 private:
  class Sink : public ByteSink {
   public:
    Sink(std::unique_ptr<ByteSink> sink, std::function<Status()> before)
        : sink_(std::move(sink)), before_(std::move(before)) {}
    Status append(std::span<const uint8_t> bytes) override {
      if (Status status = before_(); !status.ok()) {
        (void)sink_->append(bytes.first(bytes.size() / 2));  // as a disk that fills up does
        return status;
      }
      return sink_->append(bytes);
    }
    Status overwrite(uint64_t offset, std::span<const uint8_t> bytes) override {
      GLOAM_TRY_STATUS(before_());
      return sink_->overwrite(offset, bytes);
    }
    Status truncate(uint64_t size) override { return sink_->truncate(size); }
    Status close() override {
      GLOAM_TRY_STATUS(before_());
      return sink_->close();
    }

   private:
    std::unique_ptr<ByteSink> sink_;
    std::function<Status()> before_;
  };

  std::function<Status()> before_;
  std::shared_ptr<FileStore> disk_ = make_disk_store();
};

Error disk_full() {
  return {ErrorKind::kIo,
          "cannot write: No space left on device",
          {"some/file", 0, 0},
          "free some space"};
}

/// Whatever is in a run's folder must be whole: pictures decode, tables have whole rows but for the
/// last, JSON parses.
void expect_readable(const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const fs::path& path = entry.path();
    const std::vector<uint8_t> bytes = read_file(path).value();
    if (path.extension() == ".png") {
      EXPECT_TRUE(decode_png(bytes, path.string()).ok()) << path;
    } else if (path.extension() == ".exr") {
      EXPECT_TRUE(decode_exr(bytes, path.string()).ok()) << path;
    } else if (path.extension() == ".json") {
      EXPECT_TRUE(nlohmann::json::accept(bytes.begin(), bytes.end())) << path;
    } else if (path.extension() == ".csv") {
      auto rows = read_csv(path);
      for (size_t i = 1; i + 1 < rows.size(); ++i)
        EXPECT_GE(rows[i].size() + 1, rows[0].size()) << path;  // a last empty field is not counted
    } else {
      EXPECT_EQ(path.extension(), ".mp4") << "left behind: " << path;
    }
  }
}

TEST_F(RecorderTest, AFailureAtAnyWriteIsReportedAndLosesNothingBefore) {
  int operations = 0;
  for (int fail_at = 0;; ++fail_at) {
    ASSERT_LT(fail_at, 1000);
    fs::remove_all(run());
    std::atomic<int> count{0};
    RecorderOptions o = options();
    o.store = std::make_shared<GuardedStore>(
        [&count, fail_at] { return count++ < fail_at ? Status() : Status(disk_full()); });
    auto recorder = Recorder::start(o, run_info());
    Status status;
    if (recorder.ok()) {
      feed(recorder->get(), 2);
      status = (*recorder)->finish({});
      if (!status.ok()) {
        EXPECT_EQ(status.error().kind, ErrorKind::kPartial);
        EXPECT_EQ(status.error().exit_code(), 3);
      }
    } else {
      status = recorder.error();
    }
    expect_readable(run());
    operations = count;
    if (status.ok()) break;
    EXPECT_NE(status.error().to_string().find("No space left"), std::string::npos);
    EXPECT_FALSE(status.error().hint.empty());
  }
  EXPECT_GT(operations, 40);  // the loop really went through all of them
}

TEST_F(RecorderTest, AfterAFailureNothingMoreIsWrittenAndNobodyWaits) {
  std::atomic<bool> full{false};
  RecorderOptions o = options();
  o.queue_frames = 1;
  o.store =
      std::make_shared<GuardedStore>([&full] { return full ? Status(disk_full()) : Status(); });
  auto recorder = Recorder::start(o, run_info());
  ASSERT_TRUE(recorder.ok());
  (*recorder)->add_frame(make_frame("chase", 0));
  while (!fs::exists(run() / "chase.mp4") || fs::file_size(run() / "chase.mp4") == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  full = true;
  for (int i = 1; i < 50; ++i) (*recorder)->add_frame(make_frame("chase", i));
  full = false;  // too late: a gap in the middle of a recording would be worse than its end
  for (int i = 50; i < 60; ++i) (*recorder)->add_frame(make_frame("chase", i));
  EXPECT_FALSE((*recorder)->finish({}).ok());
  EXPECT_LE((*recorder)->frames(), 1) << "those that were not written do not count";
  EXPECT_TRUE(fs::exists(run() / "chase" / "rgb" / "000000.png"));
  EXPECT_FALSE(fs::exists(run() / "chase" / "rgb" / "000059.png"));
  const nlohmann::json summary = read_json(run() / "summary.json");
  EXPECT_NE(summary["recording_error"].get<std::string>().find("No space left"), std::string::npos);
  const auto state = summary["state"].get<std::string>();
  EXPECT_EQ(state.substr(0, 9), "stopped: ");
  EXPECT_NE(state.find("No space left"), std::string::npos) << state;
  EXPECT_NE(summary["exit_reason"], "completed");
}

TEST_F(RecorderTest, ABestEffortRecorderDropsTheOldestAndNeverWaits) {
  std::atomic<bool> stuck{false};
  RecorderOptions o = options();
  o.outputs = {"png"};
  o.wait = false;
  o.queue_frames = 3;
  o.store = std::make_shared<GuardedStore>([&stuck] {
    while (stuck) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return Status();
  });
  auto recorder = Recorder::start(o, run_info());
  ASSERT_TRUE(recorder.ok());
  stuck = true;
  for (int i = 0; i < 20; ++i)
    (*recorder)->add_frame(make_frame("chase", i));  // returns though stuck
  stuck = false;
  ASSERT_TRUE((*recorder)->finish({}).ok());
  const nlohmann::json camera = read_json(run() / "summary.json")["cameras"][1];
  const int frames = camera["frames"], dropped = camera["dropped_frames"];
  EXPECT_EQ(frames + dropped, 20);
  EXPECT_GE(frames, 3);
  EXPECT_LE(frames, 4);  // the queue and the one in work
  EXPECT_TRUE(fs::exists(run() / "chase" / "rgb" / "000019.png"));
}

TEST_F(RecorderTest, WithoutFinishTheRecordingIsLeftReadable) {
  {
    auto recorder = Recorder::start(options(), run_info());
    ASSERT_TRUE(recorder.ok());
    feed(recorder->get());
  }
  expect_readable(run());
  EXPECT_EQ(read_json(run() / "summary.json")["state"], "recording");
}

TEST_F(RecorderTest, ARealLimitOfTheSystemIsReportedWithFileAndCause) {
  // In a process of its own: RLIMIT_FSIZE makes write() fail with EFBIG, as a full disk does with
  // ENOSPC.
  fs::create_directories(folder_);
  const fs::path message = folder_ / "message.txt";
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{20000, 20000};  // a summary keeps room
    setrlimit(RLIMIT_FSIZE, &limit);
    RecorderOptions o = options();
    o.outputs = {"video"};
    auto recorder = Recorder::start(o, run_info());
    if (!recorder.ok()) _exit(10);
    feed(recorder->get(), 300);
    const Status status = (*recorder)->finish({});
    if (status.ok()) _exit(11);
    std::ofstream(message) << status.error().to_string();
    _exit(status.error().exit_code());
  }
  int state = 0;
  ASSERT_EQ(waitpid(child, &state, 0), child);
  ASSERT_TRUE(WIFEXITED(state));
  EXPECT_EQ(WEXITSTATUS(state), 3);
  const std::string text = read_text_file(message).value();
  EXPECT_NE(text.find(".mp4"), std::string::npos) << text;
  EXPECT_NE(text.find("File too large"), std::string::npos) << text;
}

TEST_F(RecorderTest, AFolderThatCannotBeMadeIsAnError) {
  fs::create_directories(folder_);
  std::ofstream(run()) << "a file is in the way";
  const auto refused = Recorder::start(options(), run_info());
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kIo);
  EXPECT_NE(refused.error().to_string().find("run"), std::string::npos);
}

}  // namespace
}  // namespace gloam
