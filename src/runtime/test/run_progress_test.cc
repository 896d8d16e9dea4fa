// Progress of recorded runs: that of the pictures, which take most of the time.

#include <gtest/gtest.h>

#include <filesystem>

#include "gloam/run.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgressBall = R"(<mujoco model="ball"><worldbody><light pos="0 0 3"/>
<geom type="plane" size="3 3 .1"/><body pos="0 0 .5"><freejoint/><geom size=".1"/></body>
</worldbody></mujoco>)";

class ProgressOfRuns : public testing::Test {
 protected:
  ProgressOfRuns() {
    folder_.write("ball.xml", kProgressBall);
    folder_.write("s.toml",
                  "[record]\noutputs = [\"png\"]\n[render]\ntier = \"path\"\nspp = 256\ndenoise = "
                  "false\n[environment]\nfile = \"ball.xml\"\n[[camera]]\nname = \"eye\"\nposition "
                  "= [0, -2, 1]\nlook_at = [0, 0, 0]\nwidth = 64\nheight = 48\nrate = 10\n");
    request_.out = folder_.path() / "out";
    request_.duration = 0.5;  // six pictures
  }
  int pictures() const {
    std::error_code code;
    int count = 0;
    for (const auto& entry : fs::directory_iterator(request_.out / "eye/rgb", code))
      count += entry.path().extension() == ".png";
    return count;
  }
  Result<RunReport> run(const ProgressCallback& progress) {
    return run_and_record(*World::compile(*load_scene(folder_.path() / "s.toml")), request_,
                          progress);
  }

  TempFolder folder_;
  RunRequest request_;
};

TEST_F(ProgressOfRuns, IsThatOfThePicturesAndNeverGoesBack) {
  double last = 0;
  int calls = 0;
  bool is_finishing = false;
  const auto report = run([&](const Progress& now) {
    if (now.what == "preparing") return true;
    ++calls;
    EXPECT_GE(now.done, last);
    last = now.done;
    is_finishing |= now.what == kFinishingFiles;
    // The simulation is three pictures ahead; one is being made, one being written.
    if (!is_finishing) {
      EXPECT_LE(now.done, (pictures() + 2) / 6.0 + 1e-9);
    }
    return true;
  });
  ASSERT_TRUE(report.ok() && report->status.ok());
  EXPECT_TRUE(is_finishing);
  EXPECT_GT(calls, 10);
  EXPECT_EQ(last, 1);
  EXPECT_EQ(pictures(), 6);
}

TEST_F(ProgressOfRuns, StoppedInAPictureFinishTheFilesOfThoseBefore) {
  const auto report = run([&](const Progress&) { return pictures() < 2; });
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->status.error().kind, ErrorKind::kInterrupted);
  EXPECT_GE(report->frames, 2);
  EXPECT_LT(report->frames, 6);
  EXPECT_TRUE(fs::exists(request_.out / "summary.json"));
}

}  // namespace
}  // namespace gloam
