// [[randomize]]: what is drawn, of which distribution, and that one draw does not disturb another.

#include "scene/randomize/randomize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "base/files.h"
#include "scene/test/temp_folder.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace {

constexpr const char* kScene = R"(
[sky]
date = 2026-06-21
time = 12:00:00
latitude = 48
longitude = 11
[[light]]
name = "lamp_1"
type = "point"
flux = 100
color = [1, 0.5, 0.25]
[[light]]
name = "lamp_2"
type = "point"
flux = 200
[[camera]]
name = "front"
position = [1, 2, 3]
[[robot]]
name = "a"
file = "a.xml"
orientation = [0.7071067811865476, 0.7071067811865476, 0, 0]
[environment.house]
[[material]]
name = "wood*"
roughness = 0.5
)";

Scene read(const std::string& draws, uint64_t seed = 1) {
  Scene scene;
  const Status status = read_scene_toml(kScene + draws, "scene.toml", &scene);
  EXPECT_TRUE(status.ok()) << status.error().to_string();
  scene.sim.seed = seed;
  return scene;
}

Status draw(Scene* scene, std::vector<DrawnOption>* drawn) {
  GLOAM_TRY_STATUS(validate_randomize(*scene));
  GLOAM_TRY_STATUS(draw_options(DrawStage::kPlace, scene, drawn));
  return draw_options(DrawStage::kRest, scene, drawn);
}

Scene drawn_scene(const std::string& draws, uint64_t seed = 1) {
  Scene scene = read(draws, seed);
  std::vector<DrawnOption> drawn;
  const Status status = draw(&scene, &drawn);
  EXPECT_TRUE(status.ok()) << status.error().to_string();
  return scene;
}

std::string complaint(const std::string& draws) {
  Scene scene = read(draws);
  std::vector<DrawnOption> drawn;
  const Status status = draw(&scene, &drawn);
  return status.ok() ? "fine" : status.error().to_string();
}

std::string entry(const std::string& option, const std::string& distribution) {
  return "[[randomize]]\noption = '" + option + "'\n" + distribution + "\n";
}

TEST(Randomize, OneSeedGivesTheSameSceneAndAnotherSeedAnother) {
  const std::string draws = entry("light.lamp_1.flux", "uniform = [0, 1000]");
  const double first = drawn_scene(draws, 7).lights[0].flux.value();
  EXPECT_EQ(first, drawn_scene(draws, 7).lights[0].flux.value());
  EXPECT_NE(first, drawn_scene(draws, 8).lights[0].flux.value());
  EXPECT_EQ(drawn_scene("", 7).lights[0].flux.value(), 100);
}

TEST(Randomize, OneDrawDoesNotDisturbAnother) {
  const std::string lamp = entry("light.lamp_2.flux", "uniform = [0, 1000]");
  const std::string camera = entry("camera.front.position", "uniform = [[0, 0, 0], [9, 9, 9]]");
  const double alone = drawn_scene(lamp).lights[1].flux.value();
  EXPECT_EQ(alone, drawn_scene(camera + lamp).lights[1].flux.value());
  EXPECT_EQ(alone, drawn_scene(lamp + camera).lights[1].flux.value());
  // All that fit have their own draw, which is the one that they would have alone.
  const Scene both = drawn_scene(entry("light.lamp_*.flux", "uniform = [0, 1000]"));
  EXPECT_EQ(alone, both.lights[1].flux.value());
  EXPECT_NE(alone, both.lights[0].flux.value());
}

TEST(Randomize, TheNumbersHaveTheDistribution) {
  constexpr int kDraws = 4000;
  const std::string draws =
      entry("environment.house.rooms", "uniform = [3, 6]") +
      entry("light.lamp_1.flux", "uniform = [10, 20]") +
      entry("light.lamp_2.flux", "log_uniform = [1, 10000]") +
      entry("camera.front.position", "normal = [[0, 5, 0], [1, 2, 0]]") +
      entry("environment.house.doors", "choice = ['open', 'ajar', 'closed']\nweights = [1, 0, 3]");
  std::map<int, int> rooms;
  std::map<std::string, int> doors;
  double sum = 0, squares = 0, logs = 0, x = 0, xx = 0, y = 0, yy = 0;
  Scene written = read(draws);
  for (int seed = 0; seed < kDraws; ++seed) {
    Scene scene = written;
    scene.sim.seed = static_cast<uint64_t>(seed);
    std::vector<DrawnOption> drawn;
    ASSERT_TRUE(draw(&scene, &drawn).ok());
    ++rooms[scene.environment.house->rooms];
    ++doors[scene.environment.house->doors];
    const double flux = *scene.lights[0].flux;
    sum += flux / kDraws, squares += flux * flux / kDraws;
    logs += std::log10(*scene.lights[1].flux) / kDraws;
    const Vec3 p = scene.cameras[0].position;
    x += p.x / kDraws, xx += p.x * p.x / kDraws, y += p.y / kDraws, yy += p.y * p.y / kDraws;
    EXPECT_EQ(p.z, 0);
  }
  // Four standard errors.
  EXPECT_EQ(rooms.size(), 4u);
  for (const auto& [count, times] : rooms) EXPECT_NEAR(times, kDraws / 4.0, 110) << count;
  EXPECT_EQ(doors.count("ajar"), 0u);
  EXPECT_NEAR(doors["closed"], kDraws * 0.75, 110);
  EXPECT_NEAR(sum, 15, 0.19);
  EXPECT_NEAR(squares - sum * sum, 100.0 / 12, 0.5);
  EXPECT_NEAR(logs, 2, 0.075);
  EXPECT_NEAR(x, 0, 0.064);
  EXPECT_NEAR(xx - x * x, 1, 0.09);
  EXPECT_NEAR(y, 5, 0.127);
  EXPECT_NEAR(yy - y * y, 4, 0.36);
}

TEST(Randomize, OneNumberForAVectorIsOneDrawForAllOfIt) {
  const Scene scene =
      drawn_scene(entry("light.lamp_2.color", "uniform = [0.2, 0.9]") +
                  entry("light.lamp_1.color", "operation = 'scale'\nuniform = [0.5, 0.6]"));
  const Vec3 grey = *scene.lights[1].color, scaled = *scene.lights[0].color;
  EXPECT_EQ(grey.x, grey.y);
  EXPECT_EQ(grey.x, grey.z);
  EXPECT_GT(scaled.x, 0.5);
  EXPECT_LT(scaled.x, 0.6);
  EXPECT_NEAR(scaled.y / scaled.x, 0.5, 1e-12);
  EXPECT_NEAR(scaled.z / scaled.x, 0.25, 1e-12);
}

TEST(Randomize, WhatIsWrittenCanBeAddedToAndScaled) {
  const Scene scene = drawn_scene(
      entry("camera.front.position", "operation = 'add'\nuniform = [[-0.1, 0, 0], [0.1, 0, 0]]") +
      entry("light.lamp_1.flux", "operation = 'scale'\nchoice = [2]") +
      entry("material.wood*.roughness", "operation = 'add'\nnormal = [0, 100]"));
  EXPECT_NE(scene.cameras[0].position.x, 1);
  EXPECT_NEAR(scene.cameras[0].position.x, 1, 0.1);
  EXPECT_EQ(scene.cameras[0].position.y, 2);
  EXPECT_EQ(scene.lights[0].flux, 200);
  EXPECT_GE(*scene.materials[0].roughness, 0) << "kept within the option's range";
  EXPECT_LE(*scene.materials[0].roughness, 1);
}

TEST(Randomize, OrientationsTurnAboutTheVertical) {
  const Scene scene = drawn_scene(entry("robot.a.orientation", "choice = [[1, 0, 0, 0]]"));
  EXPECT_EQ(scene.robots[0].X_WR.q.w, 1);
  std::set<double> angles;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Quat q =
        drawn_scene(entry("robot.a.orientation", "uniform = [-90, 90]"), seed).robots[0].X_WR.q;
    // As written it lies on its back: its z looks along -y. Its x is what turns.
    const double c = 1 - 2 * (q.y * q.y + q.z * q.z), s = 2 * (q.x * q.y + q.w * q.z);
    EXPECT_NEAR(2 * (q.x * q.z - q.w * q.y), 0, 1e-12) << "x stays level";
    EXPECT_NEAR(c * c + s * s, 1, 1e-12);
    EXPECT_GE(c, -1e-12) << "at most a quarter turn";
    EXPECT_NEAR(1 - 2 * (q.x * q.x + q.y * q.y), 0, 1e-12) << "z stays level";
    angles.insert(std::atan2(s, c));
  }
  EXPECT_EQ(angles.size(), 20u);
}

TEST(Randomize, TimesAndDatesAreDrawn) {
  bool before = false, after = false;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const Scene scene = drawn_scene(entry("sky.time", "uniform = [22:00:00, 02:00:00]") +
                                        entry("sky.date", "uniform = [2026-02-27, 2026-03-02]"),
                                    seed);
    const ClockTime t = *scene.sky->time;
    const CalendarDate d = *scene.sky->date;
    EXPECT_TRUE(t.hour >= 22 || t.hour < 2) << t.hour;
    before |= t.hour >= 22, after |= t.hour < 2;
    EXPECT_TRUE((d.month == 2 && d.day >= 27 && d.day <= 28) || (d.month == 3 && d.day <= 2));
  }
  EXPECT_TRUE(before && after) << "midnight is within";
}

TEST(Randomize, AnOverridesValueIsDrawn) {
  Scene scene = read(entry("override.a.geom.\".*foot\".friction",
                           "uniform = [[0.4, 0.005, 0.0001], [1, 0.005, 0.0001]]") +
                     entry("override.a.joint.hip.damping", "choice = [1, 2]"));
  std::vector<DrawnOption> drawn;
  const Status status = draw(&scene, &drawn);
  ASSERT_TRUE(status.ok()) << status.error().to_string();
  ASSERT_EQ(scene.overrides.size(), 2u);
  EXPECT_EQ(scene.overrides[0].pattern, ".*foot");
  EXPECT_EQ(scene.overrides[0].value.substr(0, 2), "0.");
  EXPECT_NE(scene.overrides[0].value.find(" 0.005 "), std::string::npos)
      << scene.overrides[0].value;
  EXPECT_EQ(drawn.size(), 2u);
  EXPECT_EQ(drawn[1].option, "override.a.joint.hip.damping");
}

TEST(Randomize, SaysWhatIsWrong) {
  const auto expect = [](const std::string& draws, const std::string& part) {
    EXPECT_NE(complaint(draws).find(part), std::string::npos) << complaint(draws);
  };
  EXPECT_EQ(complaint(entry("light.lamp_1.flux", "uniform = [1, 2]")), "fine");
  expect(entry("light.lamp_1.fluxx", "uniform = [1, 2]"), "did you mean 'flux'");
  expect(entry("light.lamp_9.flux", "uniform = [1, 2]"), "there is no light 'lamp_9'");
  expect(entry("light.lamp_1.flux", ""), "needs exactly one distribution");
  expect(entry("light.lamp_1.flux", "uniform = [1, 2]\nnormal = [1, 2]"), "needs exactly one");
  expect(entry("light.lamp_1.flux", "uniform = [1]"), "needs two values");
  expect(entry("light.lamp_1.flux", "uniform = [2, 1]"), "above the second");
  expect(entry("light.lamp_1.flux", "uniform = [-2, -1]"), "must be");
  expect(entry("light.lamp_1.flux", "log_uniform = [0, 1]"), "above 0");
  expect(entry("light.lamp_1.flux", "uniform = ['a', 'b']"), "neither a number");
  expect(entry("light.lamp_1.flux", "uniform = [[1, 1], [2, 2]]"), "has 1 numbers, not 2");
  expect(entry("light.lamp_1.name", "uniform = [1, 2]"), "is not a number");
  expect(entry("light.lamp_1.name", "choice = [1]"), "must be a string");
  expect(entry("light.lamp_1.color", "choice = [[1, 1, 1]]\nweights = [1, 2]"), "one weight");
  expect(entry("sky.time", "uniform = [1, 2]"), "not a time of day");
  expect(entry("sky.latitude", "operation = 'add'\nuniform = ['a', 2]"), "neither a number");
  expect(entry("sky.turbidity", "operation = 'scale'\nuniform = [1, 2]"), "has no value to change");
  expect(entry("override.a.joint.hip.damping", "operation = 'scale'\nuniform = [1, 2]"),
         "cannot be added to or scaled");
  expect(entry("override.a.joint", "uniform = [1, 2]"), "override");
  expect(entry("light.lamp_1.position", "uniform = [1, inf]"), "neither a number");
  EXPECT_EQ(complaint(entry("light.bulb_*.flux", "uniform = [1, 2]")), "fine") << "no bulbs";
  EXPECT_EQ(complaint(entry("nothing.here", "uniform = [1, 2]")).substr(0, 10), "scene.toml");
}

// The same complaint for every seed, at the line of the [[randomize]], already when it is read.
TEST(Randomize, NoSeedFailsWhereAnotherDoesNot) {
  const auto expect = [](const std::string& draws, const std::string& part) {
    for (uint64_t seed = 1; seed <= 12; ++seed) {
      Scene scene = read(draws, seed);
      const Status status = validate_randomize(scene);
      ASSERT_FALSE(status.ok()) << draws;
      const std::string text = status.error().to_string();
      EXPECT_NE(text.find(part), std::string::npos) << text;
      EXPECT_NE(text.find("[[randomize]] of"), std::string::npos) << text;
      EXPECT_GE(status.error().loc.line, 27) << text;
    }
  };
  const std::string prop = "[[prop]]\nname = 'thing'\nkind = 'desk'\n";
  expect(entry("environment.house.rooms", "uniform = [2, 6]"), "'rooms' is 2; it must be");
  expect(entry("environment.house.rooms", "uniform = [6, 13]"), "'rooms' is 13; it must be");
  expect(entry("environment.house.rooms", "choice = [4, 5, 40]"), "'rooms' is 40");
  expect(entry("environment.house.rooms", "choice = [4, 'five']"), "must be an integer");
  expect(entry("environment.house.rooms", "uniform = [3.2, 3.8]"), "no integer between");
  expect(entry("environment.house.clutter", "log_uniform = [0.5, 2]"), "'clutter' is 2");
  expect(entry("environment.house.doors", "choice = ['open', 'ajarr']"), "did you mean 'ajar'");
  expect(entry("environment.house.clutter", "normal = [0.5, -1]"), "deviation is negative");
  expect(prop + entry("prop.thing.kind", "choice = ['sofaa', 'desk']"), "did you mean 'sofa'");
  expect(entry("light.lamp_1.color", "uniform = [[0, 0, 0], [1, 1, 1.5]]"), "'color[2]' is 1.5");
  expect(entry("light.lamp_1.flux", "operation = 'add'\nchoice = [1, 'x']"), "neither a number");
  // Of a name that nothing has the rest is checked all the same.
  expect(entry("material.plaster*.roughness", "uniform = [0, 2]"), "'roughness' is 2");
  expect(entry("material.plaster*.colour", "choice = [[1, 1, 1]]"), "unknown option 'colour'");
  expect(entry("environment.warehouse.length", "uniform = [20, 30]"),
         "must have either a file or one generator");
  expect(entry("override.a.joint", "choice = [1, 2]"), "override");
  // What is kept within the range, and dice that end on it.
  EXPECT_EQ(complaint(entry("environment.house.rooms", "normal = [3, 9]")), "fine");
  EXPECT_EQ(complaint(entry("environment.house.rooms", "uniform = [2.5, 12.9]")), "fine");
  EXPECT_EQ(complaint(entry("environment.house.clutter", "operation = 'add'\nuniform = [-9, 9]")),
            "fine");
}

TEST(Randomize, WhatMakesTheSceneInvalidIsNamed) {
  Scene scene = read(entry("camera.front.position", "choice = [[0, 0, 0]]") +
                     entry("camera.front.look_at", "choice = [[0, 0, 0]]"));
  std::vector<DrawnOption> drawn;
  const Status status = draw(&scene, &drawn);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("[[randomize]] of 'camera.front.look_at': camera 'front' "
                                        "looks at its own position"),
            std::string::npos)
      << status.error().to_string();
  EXPECT_EQ(status.error().loc.line, scene.randomize[1].loc.line);
}

TEST(Randomize, TellsOfAPatternThatNothingFits) {
  const auto said = [](const std::string& option) {
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(complaint(entry(option, "uniform = [0.2, 0.4]")), "fine");
    return ::testing::internal::GetCapturedStderr();
  };
  const std::string text = said("material.plastr*.roughness");
  EXPECT_NE(text.find("scene.toml:"), std::string::npos) << text;
  EXPECT_NE(text.find("'material.plastr*.roughness' matches nothing"), std::string::npos) << text;
  EXPECT_EQ(said("material.w*.roughness"), "");
}

TEST(Randomize, AFileThatIsDrawnMayNotLieOutsideTheScene) {
  const TempFolder folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    EXPECT_TRUE(write_text_file_atomic(folder.path() / name, text).ok());
  };
  std::filesystem::create_directory(folder.path() / "in");
  write("secret.hdr", "x");
  write("in/day.hdr", "x");
  const auto drawn_from = [&](const std::string& name) {
    write("in/scene.toml", "[environment.house]\n[sky]\nfile = 'day.hdr'\n" +
                               entry("sky.file", "choice = ['" + name + "']"));
    Scene scene = load_scene(folder.path() / "in/scene.toml", {.strict = true}).value();
    std::vector<DrawnOption> drawn;
    const Status status = draw(&scene, &drawn);
    return status.ok() ? scene.sky->file.string() : status.error().to_string();
  };
  EXPECT_EQ(drawn_from("day.hdr"), folder.path() / "in/day.hdr");
  EXPECT_NE(drawn_from("../secret.hdr").find("may read"), std::string::npos)
      << drawn_from("../secret.hdr");
  EXPECT_NE(drawn_from("night.hdr").find("there is no file"), std::string::npos);
}

TEST(OptionPath, AStarMeansAllThatFitAndQuotesHoldDots) {
  Scene scene = read("");
  ASSERT_TRUE(set_option(scene, "light.lamp_*.flux", "5").ok());
  EXPECT_EQ(scene.lights[0].flux, 5);
  EXPECT_EQ(scene.lights[1].flux, 5);
  EXPECT_FALSE(set_option(scene, "light.bulb_*.flux", "5").ok());
  scene.lights[1].name = "b.1";
  ASSERT_TRUE(set_option(scene, "light.\"b.1\".flux", "6").ok());
  EXPECT_EQ(scene.lights[1].flux, 6);
  EXPECT_EQ(scene.lights[0].flux, 5);
}

}  // namespace
}  // namespace gloam
