// Lamps that switch, ripple, start and flicker.

#include "world/lights/light_schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gloam {
namespace {

double level(const LightSchedule::Part& part, double time, uint64_t seed = 1, uint32_t lamp = 0) {
  return light_level({{part}}, time, seed, lamp);
}

double mean(const LightSchedule::Part& part, double from, double seconds, int samples) {
  double sum = 0;
  for (int i = 0; i < samples; ++i) sum += level(part, from + seconds * (i + 0.5) / samples);
  return sum / samples;
}

TEST(LightSchedule, NothingIsOne) { EXPECT_EQ(light_level({}, 12.5, 3, 4), 1); }

TEST(LightSchedule, SwitchesAtWholeStepsWhateverTheRounding) {
  // 20 ms on, 30 ms off, in steps of 2 ms: exactly 10 and 15 steps, for an hour.
  const OnOff blink{0.05, 0.4, 0};
  for (int64_t step = 0; step < 1800000; step += step % 25 == 9 ? 1 : 3) {
    ASSERT_EQ(level(blink, static_cast<double>(step) * 0.002), step % 25 < 10 ? 1 : 0) << step;
  }
  EXPECT_EQ(level(OnOff{1, 0.5, 0.75}, 0), 0);
  EXPECT_EQ(level(OnOff{1, 0.5, 0.75}, 0.25), 1);
  EXPECT_EQ(level(OnOff{1, 0.5, 0}, -0.25), 0);
  EXPECT_NEAR(mean(OnOff{0.01, 0.3, 0.2}, 0, 1, 100000), 0.3, 1e-3);
  for (const double t : {0.0, 0.3, 0.999999999999, 1.0, 7.7}) {
    EXPECT_EQ(level(OnOff{1, 1, 0}, t), 1);
    EXPECT_EQ(level(OnOff{1, 0, 0}, t), 0);
  }
}

TEST(LightSchedule, KeysHoldOrJoin) {
  const Keyframes ramp{{{1, 0.5}, {3, 1.5}, {4, 0}}, true};
  Keyframes steps = ramp;
  steps.linear = false;
  EXPECT_EQ(level(ramp, 0), 0.5);
  EXPECT_DOUBLE_EQ(level(ramp, 2), 1.0);
  EXPECT_DOUBLE_EQ(level(ramp, 3.5), 0.75);
  EXPECT_EQ(level(ramp, 100), 0);
  EXPECT_EQ(level(steps, 0), 0.5);
  EXPECT_EQ(level(steps, 2.999), 0.5);
  EXPECT_EQ(level(steps, 3), 1.5);
  EXPECT_EQ(level(steps, 4), 0);
  // A tenth of a second times thirty is not quite three.
  EXPECT_EQ(level(steps, 0.1 * 30 - 4e-16), 1.5);
}

TEST(LightSchedule, MainsRippleTwiceAPeriodAboutOne) {
  for (const double frequency : {50.0, 60.0}) {
    const MainsRipple ripple{frequency, 0.3};
    EXPECT_NEAR(mean(ripple, 0, 1, 100000), 1, 1e-9);
    double least = 2, most = 0;
    int rises = 0;
    for (int i = 0; i < 100000; ++i) {
      const double now = level(ripple, 1e-5 * i), next = level(ripple, 1e-5 * (i + 1));
      least = std::min(least, now);
      most = std::max(most, now);
      rises += now < 1 && next >= 1;
    }
    EXPECT_NEAR((most - least) / (most + least), 0.3, 1e-4);
    EXPECT_EQ(rises, static_cast<int>(2 * frequency));
    // A day later it ripples as well as at the start.
    EXPECT_NEAR(level(ripple, 86400 + 0.003), level(ripple, 0.003), 1e-5);
  }
}

TEST(LightSchedule, TubesFlashThenStayOn) {
  int flashes_seen[7] = {};
  for (uint32_t lamp = 0; lamp < 200; ++lamp) {
    const FluorescentStart tube{2, 10};
    EXPECT_EQ(level(tube, 1.99, 5, lamp), 0);
    EXPECT_EQ(level(tube, 2.2, 5, lamp), 0);
    int rises = 0;
    for (int i = 0; i < 8000; ++i) {
      rises += level(tube, 0.001 * i, 5, lamp) == 0 && level(tube, 0.001 * (i + 1), 5, lamp) > 0;
    }
    ASSERT_GE(rises, 2) << "a flash, and the start";
    ASSERT_LE(rises, 6);
    ++flashes_seen[rises];
    double before = 0.69;
    for (double t = 8; t < 100; t += 1) {
      const double now = level(tube, t, 5, lamp);
      EXPECT_GT(now, before);
      before = now;
    }
    EXPECT_NEAR(before, 1, 1e-3);
  }
  for (int rises = 2; rises <= 6; ++rises) EXPECT_GT(flashes_seen[rises], 10);
}

TEST(LightSchedule, FlamesWanderAboutOneBelowTheirBand) {
  const Flame flame{8, 0.5};
  double sum = 0, squares = 0, least = 2, most = 0;
  constexpr int kSamples = 400000;
  for (int i = 0; i < kSamples; ++i) {
    const double now = level(flame, 0.01 * i);
    sum += now;
    squares += (now - 1) * (now - 1);
    least = std::min(least, now);
    most = std::max(most, now);
  }
  // Draws of the wander come 3.2 times a second: 12,800 in 4,000 s.
  EXPECT_NEAR(sum / kSamples, 1, 4 * 0.5 * 0.58 / std::sqrt(12800.0));
  EXPECT_GE(least, 0.5);
  EXPECT_LE(most, 1.5);
  // Variance of uniform draws, 1/3, times the mean square weight of a cubic B-spline, 151/315, in
  // both halves.
  EXPECT_NEAR(squares / kSamples, 0.25 * 2 * 0.25 / 3 * 151 / 315, 0.002);

  // Power by frequency: 64 stretches of 8 s.
  const auto power = [&](double hertz) {
    double total = 0;
    for (int part = 0; part < 64; ++part) {
      double re = 0, im = 0;
      for (int i = 0; i < 800; ++i) {
        const double window = std::sin(M_PI * (i + 0.5) / 800),
                     x = window * window * (level(flame, part * 8 + 0.01 * i) - 1);
        re += x * std::cos(2 * M_PI * hertz * 0.01 * i);
        im += x * std::sin(2 * M_PI * hertz * 0.01 * i);
      }
      total += re * re + im * im;
    }
    return total;
  };
  const double low = power(0.5), middle = power(4), high = power(20);
  EXPECT_GT(middle, 100 * high);
  EXPECT_GT(low, middle);
}

TEST(LightSchedule, MainsFailAtWholeStepsAndMayComeBackByStarters) {
  const double forever = std::numeric_limits<double>::infinity();
  for (int step = 0; step < 100; ++step) {  // out from step 35 to 70
    const double time = step * 0.002;
    const bool dark = step >= 35 && step < 70;
    EXPECT_EQ(level(PowerCut{0.07, 0.14}, time), dark ? 0 : 1) << step;
    EXPECT_EQ(level(PowerCut{0.07, 0.14, false, true}, time), dark ? 1 : 0) << step;
    EXPECT_EQ(level(PowerCut{0.07, forever}, time), step >= 35 ? 0 : 1) << step;
    EXPECT_EQ(level(PowerCut{0.07, 0.14, true}, time), step >= 35 ? 0 : 1) << step;
  }
  for (const double t : {1.0, 3.0, 100.0})
    EXPECT_EQ(level(PowerCut{0.07, 0.14, true}, t), level(FluorescentStart{.at = 0.14}, t));
}

TEST(LightSchedule, LevelsDependOnTimeSeedAndLampAlone) {
  const LightSchedule schedule{{Flame{}, MainsRipple{}, Keyframes{{{0, 0.5}}, true}}};
  const double forward = light_level(schedule, 1.25, 7, 2);
  (void)light_level(schedule, 99, 7, 2);
  EXPECT_EQ(light_level(schedule, 1.25, 7, 2), forward);
  EXPECT_NE(light_level(schedule, 1.25, 8, 2), forward);
  EXPECT_NE(light_level(schedule, 1.25, 7, 3), forward);
  EXPECT_DOUBLE_EQ(forward, level(Flame{}, 1.25, 7, 2) * level(MainsRipple{}, 1.25) * 0.5);
  // Continuous, also through time zero.
  for (double t = -1; t < 1; t += 0.001) {
    EXPECT_NEAR(level(Flame{}, t), level(Flame{}, t + 1e-6), 1e-4) << t;
  }
}

TEST(LightSchedule, WrongValuesAreNamed) {
  const auto message = [](const LightSchedule::Part& part) {
    const Status status = check_schedule({{OnOff{}, part}}, {"lab.toml", 12, 0});
    return status.ok() ? std::string() : status.error().to_string();
  };
  using testing::HasSubstr;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const LightSchedule::Part& good : std::vector<LightSchedule::Part>{
           OnOff{}, Keyframes{{{0, 1}}, false}, MainsRipple{}, FluorescentStart{}, Flame{}}) {
    EXPECT_EQ(message(good), "");
  }
  EXPECT_THAT(message(OnOff{0, 0.5, 0}), HasSubstr("lab.toml:12: period of part 2"));
  EXPECT_THAT(message(OnOff{nan, 0.5, 0}), HasSubstr("period"));
  EXPECT_THAT(message(OnOff{1, 1.5, 0}), HasSubstr("duty of part 2 of a light's schedule is 1.5"));
  EXPECT_THAT(message(OnOff{1, 0.5, -1}), HasSubstr("phase"));
  EXPECT_THAT(message(Keyframes{}), HasSubstr("number of keys"));
  EXPECT_THAT(message(Keyframes{{{0, 1}, {0, 2}}, true}), HasSubstr("later than"));
  EXPECT_THAT(message(Keyframes{{{0, -1}}, true}), HasSubstr("level of a key"));
  EXPECT_THAT(message(Keyframes{{{nan, 1}}, true}), HasSubstr("time of a key"));
  EXPECT_THAT(message(MainsRipple{-50, 0.3}), HasSubstr("frequency"));
  EXPECT_THAT(message(MainsRipple{50, 2}), HasSubstr("depth"));
  EXPECT_THAT(message(FluorescentStart{nan, 1}), HasSubstr("start"));
  EXPECT_THAT(message(FluorescentStart{0, 0}), HasSubstr("warm-up"));
  EXPECT_THAT(message(Flame{0, 0.3}), HasSubstr("bandwidth"));
  EXPECT_THAT(message(Flame{9, nan}), HasSubstr("depth"));
}

}  // namespace
}  // namespace gloam
