// LiDARs of a running simulation and in recordings.

#include <cmath>
#include <cstring>
#include <mutex>
#include <vector>

#include "base/files.h"
#include "gloam/program.h"
#include "gloam/run.h"
#include "runtime/streams/live_lidar.h"
#include "scenes.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

// On the ball, which flies at 1 m/s along the wall at y = 3, beside one that stands still.
const char* const kLidars = R"(
[[lidar]]
name = "rider"
body = "a/ball"
position = [0, 0, 0.5]
preset = "VLP-16"
columns = 90
azimuth = [60, 120]
range_at_10_percent = 0
truth = true
[[lidar]]
name = "fixed"
preset = "Mid-40"
orientation = [0.7071067811865476, 0, 0, 0.7071067811865476]
points = 300
outputs = ["pcd", "ply", "npy"]
[sim]
duration = 0.5
)";

class Scans {
 public:
  ScanCallback callback() {
    return [this](std::shared_ptr<const LidarScan> scan) {
      const std::lock_guard lock(mutex_);
      scans_.push_back(std::move(scan));
    };
  }
  std::vector<std::shared_ptr<const LidarScan>> all() {
    const std::lock_guard lock(mutex_);
    return scans_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<const LidarScan>> scans_;
};

TEST(LiveLidar, ScansFollowEachOtherWithoutAGapAndAreOfTheirOwnTimes) {
  const TempFolder folder;
  const auto simulation = simulate(flight(folder, kLidars));
  Scans scans;
  auto stream = simulation->open_lidar({"rider", true}, scans.callback());
  ASSERT_TRUE(stream.ok()) << stream.error().to_string();
  ASSERT_TRUE(simulation->run_until(250).ok());  // 0.5 s
  stream->reset();
  const auto all = scans.all();
  ASSERT_GE(all.size(), 4u);
  for (size_t i = 0; i < all.size(); ++i) {
    const LidarScan& scan = *all[i];
    EXPECT_EQ(scan.index, static_cast<int64_t>(i));
    EXPECT_NEAR(scan.start, 0.1 * static_cast<double>(i), 1e-9);
    if (i > 0) {
      EXPECT_EQ(scan.start, all[i - 1]->end);
    }
    EXPECT_NEAR(scan.end, scan.start + 0.1, 1e-12);
    EXPECT_NEAR(scan.X_WL_start.p.x, scan.start, 1e-6);
    EXPECT_NEAR(scan.X_WL_end.p.x, scan.end, 1e-6);
    ASSERT_GT(scan.size(), 100u);
    for (size_t k = 0; k < scan.size(); ++k) EXPECT_NEAR(scan.y[k], 3, 1e-4);
  }
}

TEST(LiveLidar, TheSameScansComeWhetherTheyAreRequiredOrNot) {
  const TempFolder folder;
  const World world = flight(folder, kLidars);
  std::vector<float> ranges[2];
  for (int run = 0; run < 2; ++run) {
    set_thread_count(run + 1);
    const auto simulation = simulate(world);
    Scans scans;
    auto stream = simulation->open_lidar({"rider", run == 0}, scans.callback());
    ASSERT_TRUE(stream.ok());
    if (run == 0) {
      ASSERT_TRUE(simulation->run_until(100).ok());
    } else {
      for (int step = 0; step < 100 && scans.all().empty(); ++step) {
        ASSERT_TRUE(simulation->step(1).ok());
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    }
    stream->reset();
    ASSERT_FALSE(scans.all().empty());
    ranges[run] = scans.all()[0]->range;
  }
  set_thread_count(0);
  EXPECT_EQ(ranges[0], ranges[1]);
}

TEST(LiveLidar, AnUnknownNameOrBodyIsRefused) {
  const TempFolder folder;
  const auto simulation = simulate(flight(folder, kLidars));
  Scans scans;
  const auto stream = simulation->open_lidar({"ridder", false}, scans.callback());
  ASSERT_FALSE(stream.ok());
  EXPECT_NE(stream.error().to_string().find("rider"), std::string::npos);

  folder.write("lone.toml",
               "[environment]\nfile = \"nothing.xml\"\n[[lidar]]\nname = \"l\"\nbody = \"bal\"\n");
  const auto scene = load_scene(folder.path() / "lone.toml");
  ASSERT_TRUE(scene.ok());
  const auto world = World::compile(*scene);
  ASSERT_FALSE(world.ok());
  EXPECT_NE(world.error().to_string().find("no body or site 'bal'"), std::string::npos);
}

TEST(LiveLidar, KeysFallOnStepsWhereTheyCan) {
  const Rational step{1, 500};
  EXPECT_EQ(motion_stretches({10, 1}, step, 4), 5);  // 50 steps
  EXPECT_EQ(motion_stretches({10, 1}, step, 5), 5);
  EXPECT_EQ(motion_stretches({10, 1}, step, 11), 25);
  EXPECT_EQ(motion_stretches({10, 1}, step, 64), 50);
  EXPECT_EQ(motion_stretches({15, 1}, step, 4), 4);  // 33 1/3 steps: as told
  EXPECT_EQ(motion_stretches({500, 1}, step, 4), 1);
}

TEST(LidarRecording, PointsAreInFilesThatSayWhatTheyHold) {
  set_log_level(LogLevel::kOff);
  const TempFolder folder;
  const World world = flight(folder, std::string(kLidars) + "[record]\noutputs = [\"lidar\"]\n");
  RunRequest request;
  request.out = folder.path() / "out";
  request.width = 16;
  request.height = 16;
  const Result<RunReport> report = run_and_record(world, request, {});
  set_log_level(LogLevel::kInfo);
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  ASSERT_TRUE(report->status.ok()) << report->status.error().to_string();
  for (const char* file : {"rider/pcd/000004.pcd", "fixed/pcd/000000.pcd", "fixed/ply/000000.ply",
                           "fixed/npy/000000.npy", "fixed/scans.csv"}) {
    EXPECT_TRUE(fs::exists(request.out / file)) << file;
  }
  EXPECT_FALSE(fs::exists(request.out / "rider/ply"));
  const std::string summary = *read_text_file(request.out / "summary.json");
  EXPECT_NE(summary.find("\"scans\": 5"), std::string::npos);

  const std::vector<uint8_t> bytes = *read_file(request.out / "rider/pcd/000001.pcd");
  const std::string pcd(bytes.begin(), bytes.end());
  EXPECT_NE(pcd.find("FIELDS x y z intensity ring time range column return_number part instance "
                     "semantic\nSIZE 4 4 4 4 2 4 4 2 1 4 4 4\nTYPE F F F F U F F U U U U U\n"),
            std::string::npos);
  const size_t data = pcd.find("DATA binary\n") + 12;
  const size_t at = pcd.find("POINTS ") + 7;
  const auto points = std::stoul(pcd.substr(at));
  ASSERT_GT(points, 100u);
  ASSERT_EQ(pcd.size() - data, points * 41);
  float p[3];
  std::memcpy(p, pcd.data() + data, sizeof p);
  EXPECT_NEAR(p[1], 3, 1e-4);  // on the wall
}

}  // namespace
}  // namespace gloam
