#include "world/compile/progress/load_progress.h"

#include <gtest/gtest.h>

namespace gloam {
namespace {

TEST(LoadProgress, TellsOfAllFilesEveryTwoSeconds) {
  LoadProgress progress({30'000'000, 10'000'000});
  EXPECT_EQ(progress.report(0, 0.1, 1.9), "");
  EXPECT_EQ(progress.report(1, 1, 2.5), "reading model files: 1 of 2, 13 of 40 MB, about 5 s left");
  EXPECT_EQ(progress.report(0, 0.5, 4.4), "");
  EXPECT_EQ(progress.report(0, 0.4, 5), "reading model files: 1 of 2, 25 of 40 MB, about 3 s left");
  EXPECT_EQ(progress.report(0, 1, 8), "reading model files: 2 of 2, 40 of 40 MB");
}

TEST(LoadProgress, FilesOfNoSizeAreNoDivisionByZero) {
  LoadProgress progress({0});
  EXPECT_EQ(progress.report(0, 0, 3), "reading model files: 0 of 1, 0 of 0 MB");
}

}  // namespace
}  // namespace gloam
