// Which pictures a strip shows, and when they were taken.

#include "report/picture_strips.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "base/files.h"
#include "geometry/image/png_writer.h"
#include "report/page.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

class Strips : public testing::Test {
 protected:
  /// A run whose pictures are of these numbers and times.
  RunResults run(const std::string& name, const std::vector<std::pair<int, double>>& frames) {
    RunResults run;
    run.folder = folder_.path() / name;
    run.label = name;
    run.cameras.push_back({"eye", "eye", static_cast<int64_t>(frames.size())});
    fs::create_directories(run.folder / "eye/rgb");
    std::ofstream poses(run.folder / "eye/poses.csv");
    poses << "frame,step,time_s,x_m,y_m,z_m,qw,qx,qy,qz\n";
    for (const auto& [number, time] : frames) {
      poses << number << ",0," << time << ",0,0,0,1,0,0,0\n";
      const auto png = encode_png8(2, 2, 3, std::vector<uint8_t>(12, 90));
      char file[32];
      std::snprintf(file, sizeof file, "eye/rgb/%06d.png", number);
      EXPECT_TRUE(write_file_atomic(run.folder / file, png).ok());
    }
    return run;
  }
  std::vector<PictureStrip> strips(const std::vector<RunResults>& runs, int instants) {
    std::vector<Error> left_out;
    auto made = make_strips(runs, {.instants = instants}, &left_out);
    EXPECT_TRUE(left_out.empty()) << left_out.front().to_string();
    return made;
  }

  TempFolder folder_;
};

TEST_F(Strips, AreLabelledWithTheTimesOfTheirPictures) {
  // At 3 Hz none is at the times that divide the run evenly.
  const auto made = strips({run("a", {{0, 0}, {1, 0.333}, {2, 0.667}, {3, 1}})}, 6);
  ASSERT_EQ(made.size(), 1u);
  EXPECT_THAT(made[0].instants, ElementsAre(0, 0.333, 0.667, 1)) << "each picture once";
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(made[0].rows[0].pictures[i].time, made[0].instants[i]);
}

TEST_F(Strips, TellWherePicturesOfOtherRunsWereTakenAtOtherTimes) {
  ReportContent content;
  content.runs = {run("a", {{0, 0}, {1, 0.5}, {2, 1}}), run("b", {{0, 0}, {1, 0.42}, {2, 1}})};
  content.strips = strips(content.runs, 3);
  EXPECT_EQ(content.strips[0].rows[1].pictures[1].time, 0.42);
  const std::string page = pictures_section(content);
  EXPECT_THAT(page, HasSubstr("<div class=\"time\">0.500 s</div>"));
  EXPECT_THAT(page, HasSubstr("<div class=\"time\">0.420 s</div></div>"));
  EXPECT_THAT(page, HasSubstr("b, eye at 0.420 s"));
}

// A run that goes on from a log begins with a later number; dropped frames leave gaps.
TEST_F(Strips, TakePicturesByTheirNumbers) {
  const auto made = strips({run("a", {{30, 1.5}, {31, 1.55}, {35, 1.75}})}, 3);
  EXPECT_THAT(made[0].instants, ElementsAre(1.5, 1.55, 1.75));
  for (const StripPicture& picture : made[0].rows[0].pictures)
    EXPECT_FALSE(picture.data_uri.empty());
}

}  // namespace
}  // namespace gloam
