// [[light]], [sky] and [[volume]] of scene files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gloam/scene.h"
#include "scene/test/temp_folder.h"
#include "scene/validate/validate.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;

class SceneLight : public ::testing::Test {
 protected:
  SceneLight() {
    folder_.write("robot.xml", "<mujoco><worldbody><body name='b'/></worldbody></mujoco>");
    folder_.write("lamp.ies", "IESNA");
    folder_.write("sky.hdr", "#?RADIANCE");
    folder_.write("smoke.npy", "NUMPY");
  }
  Result<Scene> load(const std::string& text) {
    return load_scene(folder_.write("scene.toml", "environment.file = \"robot.xml\"\n" + text));
  }
  std::string error_of(const std::string& text) {
    const Result<Scene> scene = load(text);
    return scene.ok() ? "" : scene.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(SceneLight, ReadsLampsAndTheirSchedules) {
  const Result<Scene> scene = load(R"(
[[light]]
name = "desk"
type = "spot"
body = "b"
position = [0, 0, 1]
look_at = [0, 1, 0]
flux = 800
temperature = 2700
radius = 0.03
angle = 35
softness = 0.2
ies = "lamp.ies"
casts_shadow = false
[light.schedule]
on_off = { period = 2, duty = 0.25, phase = 0.5 }
keys = [{ time = 0, level = 0 }, { time = 1, level = 1 }]
hold = true
mains = { frequency = 60, depth = 0.1 }
starter = { at = 1 }
flame = { bandwidth = 3 }
[[light]]
name = "panel"
type = "rect"
luminance = 4000
size = [0.6, 1.2]
orientation = [2, 0, 0, 0]
color = [1, 0.5, 0.25]
)");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  ASSERT_EQ(scene->lights.size(), 2u);
  const LightOptions& desk = scene->lights[0];
  EXPECT_EQ(desk.type, LightType::kSpot);
  EXPECT_EQ(desk.look_at, (Vec3{0, 1, 0}));
  EXPECT_EQ(desk.flux, 800);
  EXPECT_EQ(desk.ies, folder_.path() / "lamp.ies");
  EXPECT_FALSE(desk.casts_shadow);
  ASSERT_TRUE(desk.schedule.has_value());
  EXPECT_EQ(desk.schedule->on_off->duty, 0.25);
  EXPECT_EQ(desk.schedule->keys.at(1).time, 1);
  EXPECT_TRUE(desk.schedule->hold);
  EXPECT_EQ(desk.schedule->mains->frequency, 60);
  EXPECT_EQ(desk.schedule->starter->at, 1);
  EXPECT_EQ(desk.schedule->flame->bandwidth, 3);
  EXPECT_EQ(desk.loc.line, 3);
  EXPECT_EQ(scene->lights[1].size, (std::array<double, 2>{0.6, 1.2}));
  EXPECT_EQ(scene->lights[1].orientation, (Quat{1, 0, 0, 0}));
}

TEST_F(SceneLight, ReadsDatesOfTomlAndDatesAsText) {
  const char* place = "latitude = 48.1\nlongitude = 11.6\nutc_offset = 2\n";
  for (const char* when : {"date = 2026-06-21\ntime = 14:30:15.5\n",
                           "date = \"2026-06-21\"\ntime = \"14:30:15.5\"\n"}) {
    const Result<Scene> scene = load(std::string("[sky]\n") + place + when);
    ASSERT_TRUE(scene.ok()) << scene.error().to_string();
    EXPECT_EQ(scene->sky->date, (CalendarDate{2026, 6, 21}));
    EXPECT_EQ(scene->sky->time, (ClockTime{14, 30, 15.5}));
    EXPECT_EQ(scene->sky->latitude, 48.1);
  }
  const Result<Scene> scene =
      load(std::string("[sky]\n") + place + "date = \"2024-02-29\"\ntime = \"06:05\"\n");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  EXPECT_EQ(scene->sky->time, (ClockTime{6, 5, 0}));
}

TEST_F(SceneLight, ReadsMotionsClocksAndBlackouts) {
  const Result<Scene> scene = load(R"(
[[light]]
name = "siren"
type = "spot"
flux = 800
motion = { spin = -120, axis = [0, 1, 0], phase = 0.5 }
[[light]]
name = "bulb"
type = "point"
flux = 800
motion = { sway = 12, cord = 0.6 }
[sky]
date = 2026-06-21
time = 21:00:00
latitude = 48.1
longitude = 11.6
speed = 60
[blackout]
at = 5
until = 12.5
starter = true
except = ["siren", "go/*"]
emergency = ["exit*"]
)");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  const LightMotionOptions& spin = *scene->lights.at(0).motion;
  EXPECT_EQ(spin.spin, -120);
  EXPECT_EQ(spin.axis, (Vec3{0, 1, 0}));
  EXPECT_EQ(spin.phase, 0.5);
  EXPECT_EQ(scene->lights.at(1).motion->sway, 12);
  EXPECT_EQ(scene->lights.at(1).motion->cord, 0.6);
  EXPECT_EQ(scene->sky->speed, 60);
  ASSERT_TRUE(scene->blackout.has_value());
  EXPECT_EQ(scene->blackout->at, 5);
  EXPECT_EQ(scene->blackout->until, 12.5);
  EXPECT_TRUE(scene->blackout->starter);
  EXPECT_EQ(scene->blackout->except, (std::vector<std::string>{"siren", "go/*"}));
  EXPECT_EQ(scene->blackout->emergency, (std::vector<std::string>{"exit*"}));
}

TEST_F(SceneLight, ReadsVolumes) {
  const Result<Scene> scene = load(R"(
[[volume]]
name = "haze"
size = [10, 10, 3]
medium = "fog"
visibility = 30
fade = 0.5
[[volume]]
name = "puff"
position = [1, 0, 0.5]
size = [1, 1, 1]
mass_extinction = [3000]
albedo = [0.9, 0.9, 0.9, 0.8, 0.7, 0.1]
g = [0.3]
density = 1e-3
pattern = { kind = "plume", seed = 3, resolution = 32 }
[[volume]]
name = "grid"
size = [1, 1, 1]
medium = "smoke"
density = 1
grid = "smoke.npy"
)");
  ASSERT_TRUE(scene.ok()) << scene.error().to_string();
  ASSERT_EQ(scene->volumes.size(), 3u);
  EXPECT_EQ(scene->volumes[0].visibility, 30);
  EXPECT_EQ(scene->volumes[1].albedo.size(), 6u);
  EXPECT_EQ(scene->volumes[1].pattern->seed, 3u);
  EXPECT_EQ(scene->volumes[2].grid, folder_.path() / "smoke.npy");
}

struct BadLight {
  const char* what;
  const char* text;
  std::vector<const char*> expected;  // all of these stand in the message
};

class BadLights : public SceneLight, public ::testing::WithParamInterface<BadLight> {};

TEST_P(BadLights, AreOneClearLineWithItsPlace) {
  const std::string message = error_of(GetParam().text);
  EXPECT_THAT(message, HasSubstr("scene.toml:"));
  for (const char* part : GetParam().expected) EXPECT_THAT(message, HasSubstr(part));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

#define LAMP(type) "[[light]]\nname = \"a\"\ntype = \"" type "\"\n"
#define VOLUME "[[volume]]\nname = \"a\"\nsize = [1, 1, 1]\n"
#define PLACE "[sky]\nlatitude = 0\nlongitude = 0\n"

INSTANTIATE_TEST_SUITE_P(
    All, BadLights,
    ::testing::Values(
        BadLight{"no_type", "[[light]]\nname = \"a\"\n", {"scene.toml:2", "'type' is missing"}},
        BadLight{"bad_type", LAMP("point_light"), {"'type' cannot be 'point_light'"}},
        BadLight{"near_type", LAMP("spott"), {"did you mean 'spot'?"}},
        BadLight{"no_strength", LAMP("point"), {"light 'a' of type point has no strength", "[lm]"}},
        BadLight{"two_strengths",
                 LAMP("point") "flux = 1\nintensity = 1\n",
                 {"has both 'intensity' and 'flux'"}},
        BadLight{"lux_of_a_point",
                 LAMP("point") "illuminance = 1\n",
                 {"scene.toml:2", "does not support 'illuminance'", "intensity, flux"}},
        BadLight{"candela_of_the_sun",
                 LAMP("directional") "intensity = 1\n",
                 {"does not support 'intensity'", "it supports illuminance"}},
        BadLight{"no_lux", LAMP("directional"), {"needs 'illuminance'"}},
        BadLight{
            "luminance_of_a_point", LAMP("point") "luminance = 1\n", {"a luminance but no radius"}},
        BadLight{"luminance_of_a_file",
                 LAMP("point") "luminance = 1\nradius = 1\nies = \"lamp.ies\"\n",
                 {"both 'luminance' and 'ies'"}},
        BadLight{"no_size", LAMP("rect") "flux = 1\n", {"needs 'size'"}},
        BadLight{"one_size", LAMP("rect") "flux = 1\nsize = [1]\n", {"must have 2 numbers, not 1"}},
        BadLight{"flat_size", LAMP("rect") "flux = 1\nsize = [1, 0]\n", {"'size[1]' is 0"}},
        BadLight{"radius_of_a_rect",
                 LAMP("rect") "flux = 1\nsize = [1, 1]\nradius = 1\n",
                 {"does not support 'radius'", "it supports size"}},
        BadLight{"no_radius", LAMP("disk") "flux = 1\n", {"needs 'radius'"}},
        BadLight{"zero_radius", LAMP("sphere") "flux = 1\nradius = 0\n", {"a radius of 0 m"}},
        BadLight{"candela_of_a_mesh",
                 LAMP("mesh") "intensity = 1\nfile = \"robot.xml\"\n",
                 {"does not support 'intensity'"}},
        BadLight{"no_mesh", LAMP("mesh") "flux = 1\n", {"needs 'file'"}},
        BadLight{"missing_mesh",
                 LAMP("mesh") "flux = 1\nfile = \"lampp.ies\"\n",
                 {"there is no file 'lampp.ies'", "did you mean 'lamp.ies'?"}},
        BadLight{"mesh_outside",
                 LAMP("mesh") "flux = 1\nfile = \"/etc/passwd\"\n",
                 {"lies outside", "--root"}},
        BadLight{"ies_outside",
                 LAMP("point") "ies = \"../../../../../../../etc/passwd\"\n",
                 {"lies outside"}},
        BadLight{"ies_of_a_disk",
                 LAMP("disk") "flux = 1\nradius = 1\nies = \"lamp.ies\"\n",
                 {"does not support 'ies'"}},
        BadLight{"two_colors",
                 LAMP("point") "flux = 1\ncolor = [1, 1, 1]\ntemperature = 3000\n",
                 {"both 'color' and 'temperature'"}},
        BadLight{"black", LAMP("point") "flux = 1\ncolor = [0, 0, 0]\n", {"no hue"}},
        BadLight{"cold", LAMP("point") "flux = 1\ntemperature = 20\n", {"from 1000 to 20000 K"}},
        BadLight{"not_a_number", LAMP("point") "flux = nan\n", {"scene.toml:5", "'flux' is nan"}},
        BadLight{"negative", LAMP("point") "flux = -1\n", {"'flux' is -1"}},
        BadLight{"no_cone", LAMP("spot") "flux = 1\nangle = 0\n", {"a cone of 0 degrees"}},
        BadLight{"wide_sun",
                 LAMP("directional") "illuminance = 1\nangle = 120\n",
                 {"the maximum is 90"}},
        BadLight{"two_poses",
                 LAMP("spot") "flux = 1\nlook_at = [1, 0, 0]\norientation = [1, 0, 0, 0]\n",
                 {"both 'look_at' and 'orientation'"}},
        BadLight{"at_itself",
                 LAMP("spot") "flux = 1\nlook_at = [0, 0, 0]\n",
                 {"points at its own position"}},
        BadLight{"shadowless_panel",
                 LAMP("sphere") "flux = 1\nradius = 1\ncasts_shadow = false\n",
                 {"always casts shadows"}},
        BadLight{"two_of_a_name",
                 LAMP("point") "flux = 1\n" LAMP("point") "flux = 1\n",
                 {"two lights named 'a'", "line 2"}},
        BadLight{"unknown_part",
                 LAMP("point") "flux = 1\nschedule = { mainz = {} }\n",
                 {"unknown key 'mainz'", "did you mean 'mains'?"}},
        BadLight{"bad_duty",
                 LAMP("point") "flux = 1\nschedule = { on_off = { duty = 2 } }\n",
                 {"'duty' is 2"}},
        BadLight{"key_without_level",
                 LAMP("point") "flux = 1\nschedule = { keys = [{ time = 1 }] }\n",
                 {"'level' is missing"}},

        BadLight{"still_motion",
                 LAMP("spot") "flux = 1\nmotion = { phase = 0.5 }\n",
                 {"scene.toml:6", "has neither 'spin' nor 'sway'"}},
        BadLight{"two_motions",
                 LAMP("spot") "flux = 1\nmotion = { spin = 1, sway = 1 }\n",
                 {"the motion of light 'a' of type spot has both 'spin' and 'sway'"}},
        BadLight{"cord_of_a_spin",
                 LAMP("spot") "flux = 1\nmotion = { spin = 1, cord = 1 }\n",
                 {"'cord' requires 'sway'"}},
        BadLight{"no_axis",
                 LAMP("spot") "flux = 1\nmotion = { spin = 1, axis = [0, 0, 0] }\n",
                 {"an axis of length 0"}},
        BadLight{"wide_sway",
                 LAMP("spot") "flux = 1\nmotion = { sway = 90 }\n",
                 {"'sway' is 90", "from 0 to 60 deg"}},
        BadLight{"short_cord",
                 LAMP("spot") "flux = 1\nmotion = { sway = 9, cord = 0 }\n",
                 {"'cord' is 0"}},
        BadLight{"bad_phase",
                 LAMP("spot") "flux = 1\nmotion = { spin = 9, phase = 2 }\n",
                 {"'phase' is 2"}},
        BadLight{"fast_spin", LAMP("spot") "flux = 1\nmotion = { spin = 1e9 }\n", {"'spin' is"}},

        BadLight{"no_begin", "[blackout]\n", {"scene.toml:2", "'at' is missing"}},
        BadLight{"early", "[blackout]\nat = -1\n", {"'at' is -1"}},
        BadLight{"backwards",
                 "[blackout]\nat = 5\nuntil = 5\n",
                 {"scene.toml:2", "ends at 5 s", "not a duration"}},
        BadLight{"starter_of_nothing",
                 "[blackout]\nat = 5\nstarter = true\n",
                 {"no lamp turns on again", "specify 'until'"}},
        BadLight{
            "one_name", "[blackout]\nat = 5\nexcept = \"lamp\"\n", {"'except' must be an array"}},
        BadLight{"one_emergency",
                 "[blackout]\nat = 5\nemergency = 3\n",
                 {"'emergency' must be an array"}},

        BadLight{"speed_of_a_sun",
                 "[sky]\nsun_elevation = 30\nspeed = 60\n",
                 {"a [sky] with a sun position does not support 'speed'"}},
        BadLight{"backward_clock",
                 PLACE "date = 2026-06-21\ntime = \"12:00\"\nspeed = -1\n",
                 {"'speed' is -1"}},
        BadLight{"empty_sky", "[sky]\n", {"scene.toml:2", "[sky] is empty", "sun_elevation"}},
        BadLight{"no_time", PLACE "date = 2026-06-21\n", {"needs 'time'"}},
        BadLight{"no_place", "[sky]\ndate = 2026-06-21\ntime = 12:00:00\n", {"needs 'latitude'"}},
        BadLight{"no_day",
                 PLACE "date = \"2026-02-30\"\ntime = \"12:00\"\n",
                 {"2026-02-30 is not a date"}},
        BadLight{"no_month",
                 PLACE "date = \"2026-13-01\"\ntime = \"12:00\"\n",
                 {"2026-13-01 is not a date"}},
        BadLight{"bad_date",
                 PLACE "date = \"21.6.2026\"\ntime = \"12:00\"\n",
                 {"scene.toml:5", "'date' is not a date", "2026-06-21"}},
        BadLight{
            "number_as_date", PLACE "date = 2026\ntime = \"12:00\"\n", {"'date' is not a date"}},
        BadLight{"bad_time", PLACE "date = 2026-06-21\ntime = \"noon\"\n", {"not a time of day"}},
        BadLight{"late_time", PLACE "date = 2026-06-21\ntime = \"24:00\"\n", {"is 24:00:00"}},
        BadLight{"far_north", "[sky]\nsun_elevation = 91\n", {"from -90 to 90 deg"}},
        BadLight{"sun_and_date",
                 "[sky]\nsun_elevation = 30\ndate = 2026-06-21\n",
                 {"a [sky] with a sun position does not support 'date'"}},
        BadLight{"only_azimuth", "[sky]\nsun_azimuth = 30\n", {"needs 'sun_elevation'"}},
        BadLight{"murk", "[sky]\nsun_elevation = 30\nturbidity = 20\n", {"from 1 to 10"}},
        BadLight{"turned_clear",
                 "[sky]\nsun_elevation = 30\nturn = 20\n",
                 {"does not support 'turn'", "sun_elevation, sun_azimuth"}},
        BadLight{"file_and_turbidity",
                 "[sky]\nfile = \"sky.hdr\"\nturbidity = 2\n",
                 {"a [sky] from a file does not support 'turbidity'"}},
        BadLight{"file_scaled_twice",
                 "[sky]\nfile = \"sky.hdr\"\nscale = 2\nilluminance = 2\n",
                 {"both 'scale' and 'illuminance'"}},
        BadLight{"missing_map", "[sky]\nfile = \"skyy.hdr\"\n", {"did you mean 'sky.hdr'?"}},
        BadLight{"even_and_albedo",
                 "[sky]\nluminance = 1\nground_albedo = 0.1\n",
                 {"a uniform [sky] does not support 'ground_albedo'"}},
        BadLight{"two_skies", "[[sky]]\nluminance = 1\n", {"'sky' must be a table, not an array"}},

        BadLight{"no_box", "[[volume]]\nname = \"a\"\nmedium = \"fog\"\n", {"'size' is missing"}},
        BadLight{"flat_box",
                 "[[volume]]\nname = \"a\"\nsize = [1, 1, 0]\nmedium = \"fog\"\ndensity = 1\n",
                 {"'size[2]' is 0"}},
        BadLight{"no_medium", VOLUME "density = 1\n", {"neither 'medium' nor 'mass_extinction'"}},
        BadLight{"two_media",
                 VOLUME "density = 1\nmedium = \"fog\"\nmass_extinction = [1]\n",
                 {"both 'medium' and 'mass_extinction'"}},
        BadLight{"half_own",
                 VOLUME "density = 1\nmedium = \"fog\"\ng = [0.1]\n",
                 {"together with 'albedo' or 'g'"}},
        BadLight{"three_bands",
                 VOLUME "density = 1\nmass_extinction = [1, 1, 1]\n",
                 {"3 numbers in 'mass_extinction'", "905 nm"}},
        BadLight{"no_amount", VOLUME "medium = \"fog\"\n", {"neither 'density' nor 'visibility'"}},
        BadLight{"two_amounts",
                 VOLUME "medium = \"fog\"\ndensity = 1\nvisibility = 1\n",
                 {"both 'density' and 'visibility'"}},
        BadLight{
            "forward_g", VOLUME "density = 1\nmass_extinction = [1]\ng = [1]\n", {"'g[0]' is 1"}},
        BadLight{"grid_and_pattern",
                 VOLUME "medium = \"fog\"\ndensity = 1\ngrid = \"smoke.npy\"\n"
                        "pattern = { kind = \"cloud\" }\n",
                 {"both 'grid' and 'pattern'"}},
        BadLight{"bad_pattern",
                 VOLUME "medium = \"fog\"\ndensity = 1\npattern = { kind = \"plum\" }\n",
                 {"did you mean 'plume'?"}},
        BadLight{"huge_pattern",
                 VOLUME "medium = \"fog\"\ndensity = 1\n"
                        "pattern = { kind = \"plume\", resolution = 5000 }\n",
                 {"'resolution' is 5000"}},
        BadLight{"two_volumes",
                 VOLUME "medium = \"fog\"\ndensity = 1\n" VOLUME "medium = \"fog\"\ndensity = 1\n",
                 {"two volumes named 'a'"}}),
    [](const auto& info) { return info.param.what; });

// Scenes made in code have met no reader.
TEST(SceneInCode, IsHeldToTheSameRules) {
  const auto error = [](const Scene& scene) {
    const Status status = validate_scene(scene);
    return status.ok() ? "" : status.error().to_string();
  };
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].name = "wall";
  scene.materials[0].pattern = PatternOptions{.kind = "brick"};
  EXPECT_EQ(error(scene), "");
  scene.materials[0].pattern->kind = "bricks";
  EXPECT_THAT(error(scene), HasSubstr("did you mean 'brick'?"));
  scene.materials[0].pattern = PatternOptions{.kind = "brick", .bond = "flemish"};
  EXPECT_THAT(error(scene), HasSubstr("'flemish'"));
  scene.materials[0].pattern.reset();
  scene.materials[0].wear = PatternOptions{};
  EXPECT_THAT(error(scene), HasSubstr("'kind'"));
  scene.materials.clear();

  scene.lights = {LightOptions{.name = "a", .type = LightType::kPoint, .flux = 1}};
  EXPECT_EQ(error(scene), "");
  scene.lights[0].flux = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error(scene), HasSubstr("'flux'"));
  scene.lights[0] =
      LightOptions{.name = "a", .type = LightType::kRect, .flux = 1, .size = {{1, -1}}};
  EXPECT_THAT(error(scene), HasSubstr("'size'"));
  scene.lights[0] = LightOptions{.name = "a", .flux = 1};
  EXPECT_THAT(error(scene), HasSubstr("'type'"));
  scene.lights.clear();

  scene.sky = SkyOptions{.date = CalendarDate{2026, 4, 31},
                         .time = ClockTime{12, 0, 0},
                         .latitude = 0,
                         .longitude = 0};
  EXPECT_THAT(error(scene), HasSubstr("2026-04-31 is not a date"));
  scene.sky->date->day = -1;
  EXPECT_NE(error(scene), "");
  scene.sky->date->day = 30;
  EXPECT_EQ(error(scene), "");
  scene.sky->time->minute = 60;
  EXPECT_NE(error(scene), "");
}

TEST_F(SceneLight, OptionsMayBeSetWhetherTheirTableStandsThereOrNot) {
  Scene scene = load("[[light]]\nname = \"a\"\ntype = \"point\"\nflux = 1\n").value();
  const auto set = [&](std::string_view path, std::string_view value) {
    const Status status = set_option(scene, path, value);
    return status.ok() ? "" : status.error().to_string();
  };
  EXPECT_EQ(set("light.a.flux", "100"), "");
  EXPECT_EQ(scene.lights[0].flux, 100);
  EXPECT_EQ(set("light.a.schedule.mains.depth", "0.1"), "");
  EXPECT_EQ(scene.lights[0].schedule->mains->depth, 0.1);
  EXPECT_EQ(set("sky.sun_elevation", "30"), "");
  EXPECT_EQ(set("sky.turbidity", "5"), "");
  EXPECT_EQ(scene.sky->turbidity, 5);
  EXPECT_THAT(set("sky.turbidty", "5"), HasSubstr("did you mean 'turbidity'?"));
  EXPECT_THAT(set("sky.date", "2026-06-21"), HasSubstr("does not support 'date'"));
  EXPECT_EQ(scene.sky->date, std::nullopt);  // unchanged
}

}  // namespace
}  // namespace gloam
