// The resolution of moving pictures against renderers whose time goes with the pixels.

#include "studio/picture_scale.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gloam::studio {
namespace {

/// Time between pictures of a renderer that takes `full` [s] for all pixels, at most 20 a second.
void run(PictureScale& scale, double full, double seconds, int* changes = nullptr) {
  for (double t = 0; t < seconds;) {
    const double before = scale.scale();
    const double takes = full * before * before;
    scale.add(std::max(takes, 0.05), takes <= 0.05);
    t += std::max(takes, 0.05);
    if (changes != nullptr && scale.scale() != before) ++*changes;
  }
}

TEST(PictureScale, IsFullWhereTheRendererKeepsUp) {
  PictureScale scale;
  run(scale, 0.04, 30);
  EXPECT_EQ(scale.scale(), 1);
}

TEST(PictureScale, FallsAtOnceToWhatTheRendererCanDo) {
  PictureScale scale;
  scale.add(0.35, false);
  EXPECT_LE(0.35 * scale.scale() * scale.scale(), PictureScale::kTargetInterval);
  EXPECT_GT(2 * 0.35 * scale.scale() * scale.scale(), PictureScale::kTargetInterval)
      << "coarser than need";
  scale.add(100, false);
  EXPECT_EQ(scale.scale(), 0.25) << "there is a coarsest picture";
}

TEST(PictureScale, RisesAgainWhenTheRendererIsFaster) {
  PictureScale scale;
  run(scale, 0.4, 5);
  EXPECT_LT(scale.scale(), 1);
  run(scale, 0.04, 30);
  EXPECT_EQ(scale.scale(), 1);
}

TEST(PictureScale, TriesFinerPicturesEverLessOften) {
  PictureScale scale;
  run(scale, 0.15, 10);
  int early = 0, late = 0;
  run(scale, 0.15, 30, &early);
  run(scale, 0.15, 200);
  run(scale, 0.15, 30, &late);
  EXPECT_LT(late, early);
  EXPECT_LE(late, 2);
}

TEST(PictureScale, IsNotLoweredForPicturesThatNobodyWasToMake) {
  PictureScale scale;
  scale.add(1, true);  // physics is slow, the renderer left nothing out
  EXPECT_EQ(scale.scale(), 1);
}

}  // namespace
}  // namespace gloam::studio
