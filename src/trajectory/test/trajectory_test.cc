// Errors of trajectories against closed forms; equality with evo is tests/e2e/evaluate_test.py's.

#include "gloam/trajectory.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "base/rng.h"
#include "trajectory/rigid_pose.h"

namespace gloam {
namespace {

using testing::HasSubstr;

// A helix that turns as it climbs: neither on a line nor in a plane.
std::vector<StampedPose> helix(int poses) {
  std::vector<StampedPose> out;
  for (int i = 0; i < poses; ++i) {
    const double a = 0.1 * i;
    out.push_back(
        {i * 100'000'000LL,
         {{2 * std::cos(a), 2 * std::sin(a), 0.05 * i}, {std::cos(a / 2), 0, 0, std::sin(a / 2)}}});
  }
  return out;
}
std::vector<StampedPose> line(int poses, double step) {
  std::vector<StampedPose> out;
  for (int i = 0; i < poses; ++i) out.push_back({i * 100'000'000LL, {{step * i, 0, 0}, {}}});
  return out;
}
Trajectory of(const std::vector<StampedPose>& poses) { return make_trajectory(poses, "x").value(); }

// Turned by a quarter about z, scaled by 2 and moved: p' = 2 R p + t.
Trajectory similar(const Trajectory& from) {
  Trajectory out = from;
  for (size_t i = 0; i < from.size(); ++i) {
    const Vec3 p = from.positions[i];
    out.positions[i] = {-2 * p.y + 5, 2 * p.x - 7, 2 * p.z + 11};
    const RotationRows& R = from.rotations[i];
    out.rotations[i] = {-R[3], -R[4], -R[5], R[0], R[1], R[2], R[6], R[7], R[8]};
  }
  return out;
}

TEST(TrajectoryAlign, RecoversAKnownSimilarity) {
  const Trajectory moved = of(helix(80)), reference = similar(moved);
  TrajectoryPair pair = associate(reference, moved).value();
  const Similarity by = align(Alignment::kSim3, &pair).value();
  EXPECT_NEAR(by.scale, 2, 1e-12);
  EXPECT_NEAR(by.p_AB.x, 5, 1e-12);
  EXPECT_NEAR(by.p_AB.y, -7, 1e-12);
  EXPECT_NEAR(by.p_AB.z, 11, 1e-12);
  const RotationRows expected = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(by.R_AB[i], expected[i], 1e-12);
  for (const auto part : {ErrorPart::kTranslation, ErrorPart::kAngle, ErrorPart::kFull})
    EXPECT_LT(absolute_errors(pair, part)->statistics.max, 1e-7);
  EXPECT_LT(absolute_errors(pair, ErrorPart::kTranslation)->statistics.max, 1e-12);
}

TEST(TrajectoryAlign, NeverMirrors) {
  Trajectory moved = of(helix(80)), reference = moved;
  for (Vec3& p : reference.positions) p.z = -p.z;
  TrajectoryPair pair = associate(reference, moved).value();
  const RotationRows R = align(Alignment::kSe3, &pair)->R_AB;
  const double determinant = R[0] * (R[4] * R[8] - R[5] * R[7]) -
                             R[1] * (R[3] * R[8] - R[5] * R[6]) +
                             R[2] * (R[3] * R[7] - R[4] * R[6]);
  EXPECT_NEAR(determinant, 1, 1e-12);
}

TEST(TrajectoryAlign, ByScaleAloneAndByOrigin) {
  const Trajectory moved = of(helix(40));
  TrajectoryPair pair = associate(similar(moved), moved).value();
  EXPECT_NEAR(align(Alignment::kScale, &pair)->scale, 2, 1e-12);
  EXPECT_EQ(pair.estimate.rotations, moved.rotations);
  pair = associate(similar(moved), moved).value();
  ASSERT_TRUE(align(Alignment::kOrigin, &pair).ok());
  EXPECT_NEAR(absolute_errors(pair, ErrorPart::kFull)->values[0], 0, 1e-12);
  EXPECT_LT(absolute_errors(pair, ErrorPart::kAngle)->statistics.max, 1e-7);
}

/// A line of 20 poses along (1, 2, 2) / 3, up to 4 km from the origin, with `off` to the side.
Trajectory slanted(double step, double off) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 20; ++i) {
    const double way = step * i / 3, side = off * std::sin(1.7 * i), up = off * std::cos(1.1 * i);
    poses.push_back(
        {i * 100'000'000LL, {{4000 + way - 2 * side, 2 * way + side, 2 * way + up}, {}}});
  }
  return of(poses);
}

TEST(TrajectoryAlign, WarnsOfLinesWhoseTurnIsOpen) {
  for (const auto& [reference, estimate] : {std::pair{slanted(1, 0), of(line(20, 1.1))},
                                            {of(line(20, 1)), slanted(1, 0)},
                                            {slanted(1, 0), slanted(1, 0.05)},
                                            {slanted(100, 0.01), slanted(100, 0.01)}}) {
    TrajectoryPair pair = associate(reference, estimate).value();
    testing::internal::CaptureStderr();
    const auto aligned = align(Alignment::kSe3, &pair);
    const std::string said = testing::internal::GetCapturedStderr();
    ASSERT_TRUE(aligned.ok());
    EXPECT_TRUE(aligned->is_turn_open);
    EXPECT_THAT(said, HasSubstr("follow a straight line"));
    EXPECT_THAT(said, HasSubstr("undetermined"));
  }
}

TEST(TrajectoryAlign, TurnsALineNoMoreThanItMust) {
  // Equal steps along x and along (1, 2, 2) / 3: an error of 0, a turn of acos(1 / 3).
  TrajectoryPair pair = associate(slanted(1, 0), of(line(20, 1))).value();
  const Similarity by = align(Alignment::kSe3, &pair).value();
  EXPECT_LT(absolute_errors(pair, ErrorPart::kTranslation)->statistics.max, 1e-9);
  EXPECT_NEAR((by.R_AB[0] + by.R_AB[4] + by.R_AB[8] - 1) / 2, 1.0 / 3, 1e-12);
}

TEST(TrajectoryAlign, DoesNotWarnWhereTheTurnIsKnown) {
  testing::internal::CaptureStderr();
  TrajectoryPair curved = associate(of(helix(80)), of(helix(80))).value();
  EXPECT_FALSE(align(Alignment::kSe3, &curved)->is_turn_open);
  TrajectoryPair straight = associate(of(line(20, 1)), of(line(20, 1.1))).value();
  for (const auto by : {Alignment::kOrigin, Alignment::kNone, Alignment::kScale})
    EXPECT_TRUE(align(by, &straight).ok());
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  std::vector<StampedPose> still(5);
  for (size_t i = 0; i < 5; ++i) still[i].stamp = static_cast<int64_t>(i) * 100'000'000;
  TrajectoryPair point = associate(of(still), of(still)).value();
  EXPECT_THAT(align(Alignment::kSe3, &point).error().to_string(), HasSubstr("one point"));
}

TEST(TrajectoryErrors, OfAStraightLineAtADriftingPaceAreThoseOfThePace) {
  const TrajectoryPair pair = associate(of(line(11, 1)), of(line(11, 1.1))).value();
  const auto absolute = absolute_errors(pair, ErrorPart::kTranslation);
  for (size_t i = 0; i <= 10; ++i)
    EXPECT_NEAR(absolute->values[i], 0.1 * static_cast<double>(i), 1e-12);
  EXPECT_NEAR(absolute->statistics.mean, 0.5, 1e-12);
  EXPECT_NEAR(absolute->statistics.median, 0.5, 1e-12);
  EXPECT_NEAR(absolute->statistics.sse, 0.01 * 385, 1e-12);
  EXPECT_NEAR(absolute->statistics.rmse, std::sqrt(0.35), 1e-12);
  EXPECT_NEAR(absolute->statistics.std, std::sqrt(0.1), 1e-12);
  const auto relative = relative_errors(pair, ErrorPart::kTranslation);
  EXPECT_EQ(relative->values.size(), 10u);
  EXPECT_NEAR(relative->statistics.min, 0.1, 1e-12);
  EXPECT_NEAR(relative->statistics.max, 0.1, 1e-12);
}

TEST(TrajectoryErrors, OfOneAndTheSameAreZero) {
  const Trajectory one = of(helix(100));
  const TrajectoryPair pair = associate(one, one).value();
  for (const DeltaUnit unit :
       {DeltaUnit::kFrames, DeltaUnit::kMeters, DeltaUnit::kSeconds, DeltaUnit::kRadians})
    for (const bool all : {false, true}) {
      const auto errors =
          relative_errors(pair, ErrorPart::kTranslation, {.unit = unit, .all_pairs = all});
      ASSERT_TRUE(errors.ok()) << errors.error().to_string();
      EXPECT_LT(errors->statistics.max, 1e-14);
    }
}

TEST(TrajectoryErrors, OfAnglesAreTheAngle) {
  Trajectory turned = of(line(5, 1));
  const double angle = 2.5;
  for (auto& R : turned.rotations)
    R = {1, 0, 0, 0, std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle)};
  const TrajectoryPair pair = associate(of(line(5, 1)), turned).value();
  EXPECT_NEAR(absolute_errors(pair, ErrorPart::kAngle)->statistics.mean, angle, 1e-14);
  // |R - 1|² = 4 (1 - cos)
  EXPECT_NEAR(absolute_errors(pair, ErrorPart::kFull)->values[0],
              2 * std::sqrt(1 - std::cos(angle)), 1e-12);
}

TEST(TrajectoryErrors, PairsAreAsFarApartAsAskedFor) {
  const TrajectoryPair pair = associate(of(line(100, 0.1)), of(line(100, 0.1))).value();
  const auto count = [&](RelativeOptions options) {
    const auto errors = relative_errors(pair, ErrorPart::kTranslation, options);
    return errors.ok() ? errors->values.size() : 0;
  };
  EXPECT_EQ(count({.delta = 3}), 33u);
  EXPECT_EQ(count({.delta = 3, .all_pairs = true}), 97u);
  EXPECT_EQ(count({.delta = 0.95, .unit = DeltaUnit::kMeters}), 9u);
  EXPECT_EQ(count({.delta = 0.95, .unit = DeltaUnit::kSeconds}), 9u);
  EXPECT_EQ(count({.delta = 1, .unit = DeltaUnit::kSeconds, .all_pairs = true, .tolerance = 0.05}),
            90u);
  EXPECT_EQ(count({.delta = 100}), 0u);
  EXPECT_EQ(count({.delta = 1.5}), 0u);
  EXPECT_EQ(count({.delta = -1, .unit = DeltaUnit::kMeters}), 0u);
  EXPECT_EQ(count({.delta = 4, .unit = DeltaUnit::kRadians}), 0u);
}

TEST(TrajectoryAssociation, TakesTheNearestWithinTheLargestDifference) {
  std::vector<StampedPose> few = {{0, {}}, {1'004'000'000, {}}, {2'020'000'000, {}}};
  std::vector<StampedPose> many;
  for (int i = 0; i < 300; ++i)
    many.push_back({i * 10'000'000LL, {{static_cast<double>(i), 0, 0}, {}}});
  const auto pair = associate(of(many), of(few)).value();
  ASSERT_EQ(pair.reference.size(), 3u);
  EXPECT_EQ(pair.reference.positions[1].x, 100);
  EXPECT_EQ(associate(of(many), of(few), {.max_difference = 0.001})->reference.size(), 2u);
  // 4 ms earlier the second is exact.
  const auto moved = associate(of(many), of(few), {.max_difference = 0.0001, .offset = -0.004});
  EXPECT_EQ(moved->reference.size(), 1u);
  EXPECT_EQ(moved->reference.positions[0].x, 100);
  const auto swapped = associate(of(few), of(many), {.max_difference = 0.0001, .offset = 0.004});
  EXPECT_EQ(swapped->reference.size(), 1u);
}

TEST(TrajectoryAssociation, WithoutCommonTimesSaysWhere) {
  std::vector<StampedPose> later = line(5, 1);
  for (StampedPose& pose : later) pose.stamp += 1'000'000'000'000;
  const auto pair = associate(of(line(5, 1)), of(later));
  ASSERT_FALSE(pair.ok());
  EXPECT_THAT(pair.error().to_string(), HasSubstr("spans 1000.000 to 1000.400 s"));
  EXPECT_TRUE(associate(of(line(5, 1)), of(later), {.offset = -1000}).ok());
  Trajectory untimed = of(line(6, 1));
  untimed.stamps.clear();
  EXPECT_THAT(associate(untimed, of(later)).error().to_string(), HasSubstr("6 poses"));
  EXPECT_TRUE(associate(untimed, of(line(6, 2))).ok());
}

TEST(TrajectoryFile, OfEachFormatIsOneAndTheSame) {
  const auto tum = parse_trajectory(
      "# time\r\n1.5 1 2 3 0 0 0.70710678118654752 0.70710678118654752\r\n", "tum");
  const auto euroc = parse_trajectory(
      "#timestamp\n1500000000,1,2,3,0.70710678118654752,0,0,0.70710678118654752,9,9\n", "euroc");
  const auto kitti = parse_trajectory("0 -1 0 1 1 0 0 2 0 0 1 3", "kitti");
  ASSERT_TRUE(tum.ok() && euroc.ok() && kitti.ok());
  EXPECT_EQ(tum->stamps, euroc->stamps);
  EXPECT_TRUE(kitti->stamps.empty());
  for (size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR(tum->rotations[0][i], kitti->rotations[0][i], 1e-15);
    EXPECT_NEAR(euroc->rotations[0][i], kitti->rotations[0][i], 1e-15);
  }
  EXPECT_EQ(tum->positions, kitti->positions);
}

// Rotations about (1, 2, 3), written with `decimals`.
std::string rounded_kitti(int decimals, double angle) {
  const double s = std::sin(angle / 2) / std::sqrt(14.0);
  const RotationRows R = rotation_of({std::cos(angle / 2), s, 2 * s, 3 * s});
  std::string text;
  for (size_t i = 0; i < 9; ++i) {
    text += fmt::format("{:.{}f} ", R[i], decimals);
    if (i % 3 == 2) text += fmt::format("{} ", i);
  }
  return text + "\n";
}

TEST(TrajectoryFile, RotationsOfFewDecimalsAreMadeRotationsWithANote) {
  for (const int decimals : {2, 3, 12}) {
    std::string rough, exact;
    for (int i = 0; i < 60; ++i) {
      rough += rounded_kitti(decimals, 0.1 * i);
      exact += rounded_kitti(17, 0.1 * i);
    }
    const auto read = parse_trajectory(rough, "x"), wanted = parse_trajectory(exact, "x");
    ASSERT_TRUE(read.ok()) << read.error().to_string();
    for (size_t i = 0; i < 60; ++i) {
      EXPECT_LT(distance_from_rotation(read->rotations[i]), 0.001 + 1e-9);
      const double angle = angle_of(relative(nearest_quaternion(read->rotations[i]),
                                             nearest_quaternion(wanted->rotations[i])));
      EXPECT_LT(angle, std::pow(10, -decimals) + 1e-7) << decimals;
    }
    EXPECT_EQ(read->notes.size(), decimals < 10 ? 1u : 0u) << decimals;
    for (const std::string& note : read->notes)
      EXPECT_THAT(note, HasSubstr("of 60 poses are rotations only to within"));
  }
  // What is no rotation at all stays an error: mirrored, flat, sheared, scaled, of zeros.
  for (const char* text :
       {"-1 0 0 0 0 1 0 0 0 0 1 0\n", "1 0 0 0 0 1 0 0 0 0 0 0\n", "1 0.2 0 0 0 1 0 0 0 0 1 0\n",
        "1.1 0 0 0 0 1.1 0 0 0 0 1.1 0\n", "0 0 0 0 0 0 0 0 0 0 0 0\n"}) {
    const auto read = parse_trajectory(text, "x");
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_THAT(read.error().to_string(), HasSubstr("x:1: the 3x3 part is not a rotation matrix"));
  }
}

TEST(TrajectoryFile, KeepsNanosecondsOfExponents) {
  const auto read = parse_trajectory("1.403715529112143517e+09 0 0 0 0 0 0 1\n", "x");
  EXPECT_EQ(read->stamps[0], 1'403'715'529'112'143'517);
}

TEST(TrajectoryFile, WhatIsWrongIsSaidByLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "no poses"},
      {"# only\n\n", "no poses"},
      {"0 1 2 3 0 0 0 1\n1 nan 2 3 0 0 0 1\n", "x:2: 'nan 2 3 0 0 0 1' is not a finite number"},
      {"0 1 2 3 0 0 0 1\n1 1e999 2 3 0 0 0 1\n", "x:2"},
      {"inf 1 2 3 0 0 0 1\n", "x:1: the time"},
      {"0 1 2 3 0 0 0 2\n", "x:1: the quaternion's length is 2"},
      {"0 1 2 3 0 0 0 0\n", "the quaternion's length is 0"},
      {"5 1 2 3 0 0 0 1\n\n4 1 2 3 0 0 0 1\n", "x:3: time goes back by 1 s"},
      {"1 0 0 0 0 2 0 0 0 0 1 0\n", "not a rotation matrix"},
      {"1 0 0 0 0 1 0 0 0 0 -1 0\n", "not a rotation matrix"},
      {"0 1 2 3 0 0 0\n", "7 fields"},
      {"0 1 2 3 0 0 0 1\n1 0 0 0 0 1 0 0 0 0 1 0\n", "not the format of the previous lines"},
      {"0,1,2,3,1,0,0\n", "7 fields"},
      {"0 1 2x 3 0 0 0 1\n", "not a finite number"},
      {"0 1e13 2 3 0 0 0 1\n", "1e12 m"},
      {"1e300 1 2 3 0 0 0 1\n", "4e9 s"},
      {"0,,2,3,1,0,0,0\n", "not a finite number"},
  };
  for (const auto& [text, said] : cases) {
    const auto read = parse_trajectory(text, "x");
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_THAT(read.error().to_string(), HasSubstr(said)) << text;
    EXPECT_EQ(read.error().to_string().find('\n'), std::string::npos);
  }
  EXPECT_FALSE(read_trajectory_file("/does/not/exist").ok());
}

TEST(TrajectoryFile, PosesOfLogsAreCheckedToo) {
  std::vector<StampedPose> poses = line(3, 1);
  poses[1].X_AB.q = {0, 0, 0, 0};
  EXPECT_THAT(make_trajectory(poses, "/odom").error().to_string(), HasSubstr("pose 2"));
  poses = line(3, 1);
  poses[2].stamp = 5;
  EXPECT_THAT(make_trajectory(poses, "/odom").error().to_string(), HasSubstr("pose 3 is earlier"));
  poses = line(3, 1);
  poses[0].X_AB.p.x = std::nan("");
  EXPECT_THAT(make_trajectory(poses, "/odom").error().to_string(), HasSubstr("pose 1"));
  EXPECT_FALSE(make_trajectory({}, "/odom").ok());
}

TEST(TrajectoryMutations, AnyBytesAreReadOrRefusedInOneLine) {
  const std::string seeds[] = {
      "0.5 1 2 3 0 0 0 1\n1.5 1 2 3 0 0 0.70710678 0.70710678\n",
      "1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 1 1 0 0 2 0 0 1 3\n",
      "#t\n1403715524907143168,0.5,1.9,0.9,1,0,0,0,1\n1403715524907143169,0.5,1.9,0.9,1,0,0,0,1\n"};
  const RandomStream random{7, stream_id("trajectory.mutations")};
  const char letters[] = "0123456789.,-+e \n#naif\t\r\xff";
  const char* asked = std::getenv("GLOAM_MUTATIONS");
  const int count = asked != nullptr ? std::atoi(asked) : 200;
  for (int i = 0; i < count; ++i) {
    std::string text = seeds[i % 3];
    for (uint32_t k = 0; k < 4; ++k) {
      const Philox4 draw = random.draw(static_cast<uint64_t>(i), k);
      text[draw.v[0] % text.size()] = letters[draw.v[1] % (sizeof letters - 1)];
    }
    const auto read = parse_trajectory(text, "x");
    if (!read.ok()) {
      EXPECT_EQ(read.error().to_string().find('\n'), std::string::npos) << text;
      continue;
    }
    const auto pair = associate(*read, *read);
    ASSERT_TRUE(pair.ok()) << text;
    EXPECT_TRUE(std::isfinite(absolute_errors(*pair, ErrorPart::kFull)->statistics.rmse)) << text;
  }
}

}  // namespace
}  // namespace gloam
