// Joint angles of a walk in the sagittal plane against published ones.

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <vector>

#include "sim/agents/walker.h"

namespace gloam {
namespace {

struct AngleBand {
  double mean, deviation;  // [deg]
};
struct GaitRow {
  int percent;  // of the cycle, from the foot's coming down
  AngleBand hip, knee, ankle;
};

// Pinzone, Schwartz, Thomason and Baker 2014, "The comparison of normative reference data from
// different gait analysis services", Gait and Posture 40, electronic appendix: mean of the two
// services, deviation of people in each. Free speed; bent, and the ankle's toes up, are positive.
constexpr std::array<GaitRow, 10> kFreeGait = {{
    {0, {36.6, 6.4}, {6.1, 4.9}, {-2.3, 4.8}},
    {10, {33.0, 7.3}, {19.4, 6.4}, {-1.8, 3.6}},
    {20, {21.9, 7.0}, {16.0, 6.2}, {5.5, 3.5}},
    {30, {10.5, 6.4}, {9.5, 5.7}, {8.9, 3.5}},
    {40, {0.6, 6.5}, {6.0, 5.8}, {11.6, 4.3}},
    {50, {-6.0, 6.4}, {12.4, 5.6}, {10.0, 6.3}},
    {60, {0.5, 6.9}, {37.3, 6.8}, {-14.4, 8.7}},
    {70, {20.3, 7.2}, {61.0, 6.2}, {-9.4, 6.8}},
    {80, {33.8, 7.0}, {48.9, 9.1}, {0.8, 4.8}},
    {90, {37.3, 6.6}, {16.1, 8.1}, {0.9, 4.0}},
}};
// Schwartz, Rozumalski and Trost 2008, "The effect of walking speed on the gait of typically
// developing children", Journal of Biomechanics 41, appendix: very slow and very fast, which is
// below 0.23 and above 0.64 of the root of g times the length of a leg, 0.7 and 1.9 m/s of ours.
constexpr std::array<GaitRow, 10> kVerySlowGait = {{
    {0, {30.2, 6.2}, {4.9, 5.9}, {-2.6, 7.1}},
    {10, {25.3, 7.0}, {7.8, 7.5}, {-4.0, 5.0}},
    {20, {18.5, 7.3}, {7.3, 8.1}, {1.6, 4.7}},
    {30, {12.6, 7.4}, {6.7, 7.8}, {5.9, 4.6}},
    {40, {7.7, 7.6}, {7.0, 7.6}, {10.0, 4.4}},
    {50, {3.1, 7.7}, {9.2, 7.7}, {13.1, 4.1}},
    {60, {2.2, 7.6}, {18.2, 9.8}, {7.0, 8.1}},
    {70, {11.9, 9.4}, {38.9, 13.2}, {-4.3, 9.9}},
    {80, {24.6, 8.4}, {42.3, 11.0}, {2.9, 8.3}},
    {90, {31.7, 6.4}, {19.3, 10.9}, {2.7, 6.2}},
}};
constexpr std::array<GaitRow, 10> kVeryFastGait = {{
    {0, {43.6, 9.1}, {8.8, 6.9}, {-3.1, 7.5}},
    {10, {39.7, 10.0}, {21.8, 9.5}, {-1.8, 4.4}},
    {20, {27.6, 10.2}, {17.3, 10.3}, {6.3, 5.2}},
    {30, {12.9, 9.1}, {5.8, 9.8}, {7.9, 6.2}},
    {40, {-0.1, 7.6}, {0.6, 7.4}, {6.7, 6.1}},
    {50, {-7.3, 6.5}, {8.4, 6.8}, {-1.5, 8.6}},
    {60, {0.6, 6.8}, {36.8, 8.3}, {-21.9, 8.5}},
    {70, {22.7, 7.3}, {61.0, 7.4}, {-9.1, 7.7}},
    {80, {40.2, 8.0}, {52.5, 10.0}, {2.5, 5.5}},
    {90, {45.0, 8.8}, {21.8, 10.2}, {1.7, 5.3}},
}};
// The plane of the spines of the pelvis tilts by so much while one stands upright; there the pelvis
// of a person here is level. Mean tilt in the same appendix [deg].
constexpr double kPelvicTilt = 12.0;

struct LegAngles {
  double hip, knee, ankle;  // [deg]
};

class EvenGround final : public GroundHeight {
 public:
  double at(Vec3d) const override { return 0; }
};

// Angle of a part's axis from the upright, forward positive, of someone who walks along x [deg].
double lean_of(const PartPose& part) {
  const Vec3d down = rotated(part.q, {0, 0, -1});
  return std::atan2(down.x, -down.z) * 180 / std::numbers::pi;
}

LegAngles left_leg(const PersonPose& pose) {
  const double thigh = lean_of(pose[kThighL]), shank = lean_of(pose[kShankL]);
  return {thigh + kPelvicTilt, thigh - shank, lean_of(pose[kFootL]) - shank};
}

/// A walk at an even speed, and angles of the left leg over its last cycle.
struct Walked {
  std::vector<LegAngles> angles;
  double cycle = 0, step = 0;      // [s], [m]
  double lowest = 9, highest = 0;  // height of the pelvis [m]
  double fastest = 0;              // of a knee [deg/s]

  Walked(const PersonShape& shape, double speed) {
    constexpr double kTick = 0.005;
    const EvenGround ground;
    Walker walker(shape, 1);
    WalkInput in{};
    walker.reset(in, ground);
    int strikes = 0;
    bool stood = true;
    Vec3d landed{};
    while (strikes < 10) {
      in.velocity.x = std::min(in.velocity.x + 1.2 * kTick, speed);
      in.p.x += in.velocity.x * kTick;
      in.time += kTick;
      walker.step(kTick, in, ground);
      const bool stands = walker.is_planted(0);
      const PersonPose pose = walker.pose(in);
      if (stands && !stood) {
        ++strikes;
        step = norm(pose[kFootL].p - landed) / 2;
        landed = pose[kFootL].p;
      }
      stood = stands;
      if (strikes != 9) continue;
      if (!angles.empty())
        fastest = std::max(fastest, std::abs(left_leg(pose).knee - angles.back().knee) / kTick);
      angles.push_back(left_leg(pose));
      lowest = std::min(lowest, pose[kPelvis].p.z);
      highest = std::max(highest, pose[kPelvis].p.z);
    }
    cycle = static_cast<double>(angles.size()) * kTick;
  }

  const LegAngles& at(int percent) const {
    return angles[angles.size() * static_cast<size_t>(percent) / 100];
  }
};

void expect_within(const Walked& walk, const std::array<GaitRow, 10>& table, double deviations,
                   const std::string& who) {
  for (const GaitRow& row : table) {
    const LegAngles is = walk.at(row.percent);
    const auto expect = [&](double angle, const AngleBand& band, const char* joint) {
      EXPECT_LE(std::abs(angle - band.mean), deviations * band.deviation)
          << who << ", " << joint << " at " << row.percent << " % of the cycle: " << angle
          << " degrees instead of " << band.mean << " +- " << band.deviation;
    };
    expect(is.hip, row.hip, "hip");
    expect(is.knee, row.knee, "knee");
    expect(is.ankle, row.ankle, "ankle");
  }
}

TEST(Gait, JointAnglesAreWithinOneDeviationOfPublishedOnes) {
  for (const double height : {1.55, 1.7, 1.85}) {
    // Free speed goes with the root of the length of a leg (Froude's number).
    const double speed = 1.3 * std::sqrt(height / 1.7);
    const Walked walk(draw_person(3, height), speed);
    expect_within(walk, kFreeGait, 1, std::to_string(height) + " m tall");
  }
}

TEST(Gait, AtOtherSpeedsItIsWithinTwoDeviations) {
  const PersonShape shape = draw_person(3, 1.7);
  expect_within(Walked(shape, 0.6), kVerySlowGait, 2, "0.6 m/s");
  expect_within(Walked(shape, 2.0), kVeryFastGait, 2, "2 m/s");
}

// Free walking: 1.3 m/s at 111 to 117 steps a minute, steps of 0.65 to 0.75 m (Perry and Burnfield
// 2010), hips that rise and fall by 3 to 5 cm (Gard and Childress 2001) over nearly straight legs.
TEST(Gait, StepsAndHipsAreThoseOfPeople) {
  const PersonShape shape = draw_person(3, 1.7);
  const Walked walk(shape, 1.3);
  EXPECT_NEAR(120 / walk.cycle, 113, 6) << "steps a minute";
  EXPECT_NEAR(walk.step, 0.70, 0.05) << "m";
  EXPECT_GT(walk.highest - walk.lowest, 0.02);
  EXPECT_LT(walk.highest - walk.lowest, 0.05);
  EXPECT_GT(walk.highest, 0.985 * shape.hip_height) << "it crouches";
  // A knee of a walking person turns by at most 400 to 500 degrees a second.
  EXPECT_LT(walk.fastest, 600) << "degrees a second: a knee snaps";
}

TEST(Gait, StandsUprightOnStraightLegs) {
  const EvenGround ground;
  Walker walker(draw_person(3, 1.7), 1);
  WalkInput in{};
  walker.reset(in, ground);
  for (; in.time < 3; in.time += 0.02) {
    walker.step(0.02, in, ground);
    EXPECT_LT(left_leg(walker.pose(in)).knee, 12);
  }
}

}  // namespace
}  // namespace gloam
