// Gait by itself: a body that is moved over level ground and steps, and the feet below it.

#include <gtest/gtest.h>

#include "sim/agents/walker.h"

namespace gloam {
namespace {

constexpr double kTick = 0.02;  // [s]

class Level final : public GroundHeight {
 public:
  double at(Vec3d) const override { return 0; }
};
class Stairs final : public GroundHeight {
 public:
  double at(Vec3d p) const override {
    return 0.17 * std::clamp(std::floor((p.x - 1) / 0.29) + 1, 0.0, 8.0);
  }
};

/// A person that is told how fast to go and to turn, watched at every tick.
struct Stroll {
  explicit Stroll(const PersonShape& s, const GroundHeight& g = level())
      : shape(s), walker(s, 1), ground(g) {
    walker.reset(in, ground);
    pose = walker.pose(in);
  }
  static const GroundHeight& level() {
    static const Level it;
    return it;
  }

  void go(double speed, double yaw_rate, double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kTick)); ++i) tick(speed, yaw_rate);
  }

  void tick(double speed, double yaw_rate) {
    const double now = norm(in.velocity);
    const double next = now + std::clamp(speed - now, -2.2 * kTick, 1.2 * kTick);
    in.yaw_rate = yaw_rate;
    in.heading += yaw_rate * kTick;
    const Vec3d before = in.velocity;
    in.velocity = heading_vector(in.heading) * next;
    in.acceleration = (in.velocity - before) * (1 / kTick);
    in.p += in.velocity * kTick;
    in.p.z = ground.at(in.p);
    in.time += kTick;
    walker.step(kTick, in, ground);
    const PersonPose last = pose;
    pose = walker.pose(in);
    watch(last);
  }

  // Points of the sole that touch the ground before and after a tick must not have moved.
  void watch(const PersonPose& last) {
    for (int foot = 0; foot < 2; ++foot) {
      const auto part = static_cast<size_t>(kFootL + 3 * foot);
      double least = 1e9;
      for (const double along : {-0.22, 0.0, 0.35, 0.7}) {
        const Vec3d point{along * shape.foot, 0, -shape.ankle};
        const Vec3d a = last[part].p + rotated(last[part].q, point),
                    b = pose[part].p + rotated(pose[part].q, point);
        const double below = ground.at(b) - b.z;
        deepest = std::max(deepest, below);
        if (a.z - ground.at(a) > 0.006 || b.z - ground.at(b) > 0.006) continue;
        least = std::min(least, flat_norm(b - a));
      }
      if (!walker.is_planted(foot) || least > 1e8) {
        slid[foot] = 0;
        continue;
      }
      slid[foot] += least;
      most_slid = std::max(most_slid, slid[foot]);
    }
    const auto distance = [&](PersonPart a, PersonPart b) {
      return norm(pose[static_cast<size_t>(a)].p - pose[static_cast<size_t>(b)].p);
    };
    for (const int side : {0, 3}) {
      worst_bone = std::max(
          {worst_bone,
           std::abs(distance(PersonPart(kThighL + side), PersonPart(kShankL + side)) - shape.thigh),
           std::abs(distance(PersonPart(kShankL + side), PersonPart(kFootL + side)) -
                    shape.shank)});
    }
    highest_hip = std::max(highest_hip, pose[kPelvis].p.z - in.p.z);
    lowest_hip = std::min(lowest_hip, pose[kPelvis].p.z - in.p.z);
    for (size_t i = 0; i < kPersonParts; ++i) {
      const Vec3d moved = pose[i].p - last[i].p;
      fastest_part = std::max(fastest_part, norm(moved) / kTick);
    }
  }

  PersonShape shape;
  Walker walker;
  const GroundHeight& ground;
  WalkInput in{};
  PersonPose pose;
  double slid[2] = {}, most_slid = 0, deepest = 0, worst_bone = 0, highest_hip = 0, lowest_hip = 9,
         fastest_part = 0;
};

void amble(Stroll* stroll, double speed) {
  stroll->go(0, 0, 1);        // stands
  stroll->go(speed, 0, 4);    // starts, walks
  stroll->go(speed, 0.8, 3);  // turns
  stroll->go(speed, -1.2, 2);
  stroll->go(0, 0, 2);    // stops
  stroll->go(0, 1.5, 2);  // turns on the spot
  stroll->go(0, 0, 1.5);
}

TEST(Walker, FeetDoNotSlide) {
  for (const double height : {1.5, 1.7, 1.9}) {
    for (const double speed : {0.3, 0.7, 1.1, 1.4, 1.8, 2.2}) {
      Stroll stroll(draw_person(3, height));
      amble(&stroll, speed);
      EXPECT_LT(stroll.most_slid, 0.02)
          << "a foot slid that far while it stood, at " << speed << " m/s, height " << height;
      EXPECT_LT(stroll.deepest, 0.012) << "a sole is below the ground at " << speed << " m/s";
    }
  }
}

TEST(Walker, BonesKeepTheirLength) {
  for (const double speed : {0.3, 0.7, 1.1, 1.4, 1.8, 2.2}) {
    Stroll stroll(draw_person(5, 1.75));
    amble(&stroll, speed);
    EXPECT_LT(stroll.worst_bone, 0.012) << "at " << speed << " m/s a joint comes apart";
    EXPECT_LT(stroll.fastest_part, 3.4 * speed + 3) << "something jumps at " << speed << " m/s";
  }
}

TEST(Walker, HipsRiseAndFallAsPeoplesDo) {
  Stroll stroll(draw_person(5, 1.75));
  stroll.go(1.35, 0, 4);
  stroll.highest_hip = 0, stroll.lowest_hip = 9;
  stroll.go(1.35, 0, 4);
  const double bob = stroll.highest_hip - stroll.lowest_hip;
  EXPECT_GT(bob, 0.02) << "people's hips move by 3 to 6 cm at 1.35 m/s";
  EXPECT_LT(bob, 0.07);
  EXPECT_GT(stroll.lowest_hip, 0.9 * stroll.shape.hip_height) << "it crouches";
}

// Free walking of adults: 1.3 to 1.4 m/s at 100 to 120 steps a minute (Perry and Burnfield 2010).
TEST(Walker, CadenceAndStepsAreThoseOfPeople) {
  const Walker walker(draw_person(1, 1.7), 1);
  EXPECT_NEAR(walker.cadence(1.35) * 60, 113, 8);
  EXPECT_NEAR(1.35 / walker.cadence(1.35), 0.71, 0.06);
  EXPECT_LT(walker.cadence(0.8), walker.cadence(1.35));
  EXPECT_NEAR(Walker::stance_share(1.35), 0.62, 0.03);
}

TEST(Walker, StandsStillWithFeetSideBySideAfterAWalk) {
  Stroll stroll(draw_person(2, 1.7));
  stroll.go(1.3, 0, 4);
  stroll.go(0, 0, 3);
  EXPECT_FALSE(stroll.walker.is_stepping()) << "it steps on the spot";
  const Vec3d between = stroll.pose[kFootL].p - stroll.pose[kFootR].p;
  EXPECT_NEAR(flat_norm(between), 2 * stroll.shape.hip, 0.15);
}

TEST(Walker, ClimbsStairs) {
  const Stairs stairs;
  Stroll stroll(draw_person(2, 1.75), stairs);
  stroll.go(0.6, 0, 8);
  EXPECT_NEAR(stroll.in.p.z, 1.36, 1e-9) << "it is not up";
  EXPECT_NEAR(stroll.pose[kFootL].p.z - stroll.shape.ankle, 1.36, 0.1);
  EXPECT_LT(stroll.worst_bone, 0.06);
  EXPECT_GT(stroll.pose[kPelvis].p.z, 1.36 + 0.85 * stroll.shape.hip_height);
}

TEST(Walker, IsShapedAsPeopleAre) {
  double sum = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const PersonShape p = draw_person(seed, {});
    sum += p.height;
    EXPECT_GE(p.height, 1.45);
    EXPECT_LE(p.height, 1.98);
    EXPECT_NEAR(p.hip_height + p.waist + p.trunk, 0.795 * p.height, 1e-9)
        << "of the shoulder joints";
  }
  EXPECT_NEAR(sum / 200, 1.69, 0.03);
  EXPECT_EQ(draw_person(7, {}).height, draw_person(7, {}).height);
  EXPECT_EQ(draw_person(7, 1.6).height, 1.6);
}

}  // namespace
}  // namespace gloam
