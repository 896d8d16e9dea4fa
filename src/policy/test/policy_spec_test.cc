#include "policy/policy_spec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/test/source_dir.h"
#include "policy/test/leg_robot.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kTerm = "[[observation]]\nterm = \"joint_pos\"\n";

Result<PolicySpec> build(const std::string& text) {
  GLOAM_TRY(const toml::table table, parse_toml(text, "p.toml"));
  return build_policy_spec(table, "p.toml");
}

std::string spec_error(const std::string& text) {
  const auto spec = build(text);
  return spec.ok() ? "" : spec.error().to_string();
}

std::string replaced(std::string text, const std::string& old, const std::string& now) {
  const size_t at = text.find(old);
  return at == std::string::npos ? text : text.replace(at, old.size(), now);
}

TEST(PolicySpec, NumbersOfJoints) {
  const auto spec = build(replaced(std::string(kLegPolicy) + kTerm, "[0.3, -0.2]",
                                   "{ \".*\" = 1, \"k.*\" = 2, \"hip\" = 3, \"h.p\" = 4 }"));
  ASSERT_TRUE(spec.ok()) << spec.error().to_string();
  EXPECT_THAT(spec->kp, ElementsAre(10, 20));
  EXPECT_THAT(spec->kd, ElementsAre(0.5, 0.5));
  // An exact name takes precedence over a later pattern, a later pattern over an earlier one.
  EXPECT_THAT(spec->default_positions, ElementsAre(2, 3));
  EXPECT_EQ(spec->torque_limit[0], kUnlimited);
}

TEST(PolicySpec, ErrorsHaveThePlaceAndARemedy) {
  const std::string good = std::string(kLegPolicy) + kTerm;
  ASSERT_EQ(spec_error(good), "");
  const std::pair<std::string, std::string> kCases[] = {
      {replaced(good, "kp = [10.0, 20.0]", "kp = [1, 2, 3]"), "p.toml:5:6: kp has 3 numbers for 2"},
      {replaced(good, "kp = [10.0, 20.0]", "kp = -1"), "kp of knee is negative"},
      {replaced(good, "kp = [10.0, 20.0]", "kp = { \"hop\" = 1 }"), "'hop' matches no joint"},
      {replaced(good, "kp = [10.0, 20.0]", "kp = { \"hip\" = 1 }"), "kp has no number for knee"},
      {replaced(good, "kp = [10.0, 20.0]", "kp = { \"(\" = 1 }"), "not a valid regular expression"},
      {replaced(good, "kd = 0.5", ""), "does not contain [policy] kd"},
      {replaced(good, "rate = 50", "rate = 0"), "rate is 0"},
      {replaced(good, "rate = 50", "rate = nan"), "must be a finite number"},
      {replaced(good, "rate = 50", "rat = 50"), "did you mean 'rate'?"},
      {replaced(good, "rate = 50", "history = 0"), "whole number from 1 to 1000"},
      {replaced(good, "\"hip\"]", "\"knee\"]"), "lists knee twice"},
      {replaced(good, "joint_pos", "joint_poss"), "did you mean 'joint_pos'?"},
      {good + "scale = [1, 2, 3]\n", "scale has 3 numbers, but the term has 2"},
      {good + "clip = [1, -1]\n", "low 1 is above high -1"},
      {good + "from = \"other\"\n", "does not read the output"},
      {good + "[[observation]]\nterm = \"contact_state\"\n", "needs the names of the feet"},
      {good + "[[observation]]\nterm = \"height_scan\"\nsize = [900, 900]\n", "more than 10000"},
      {good + "[[network]]\nname = \"a\"\n", "either [[network]]"},
      {std::string(kLegPolicy), "[[observation]] terms"},
  };
  for (const auto& [text, message] : kCases) EXPECT_THAT(spec_error(text), HasSubstr(message));
}

TEST(PolicySpec, MetadataOfMjlab) {
  const auto settings =
      settings_of_metadata({{"joint_names", "hip,knee"},
                            {"joint_stiffness", "20.000,10.000"},
                            {"joint_damping", "0.500,0.250"},
                            {"default_joint_pos", "-0.200,0.300"},
                            {"observation_names", "base_ang_vel,joint_pos,command"},
                            {"observation_terms_scale", "0.250;0.500;1.000,1.000,2.000"},
                            {"observation_terms_history_length", "0.000,3.000,0.000"},
                            {"observation_terms_flatten_history_dim", "1.000,1.000,1.000"},
                            {"observation_terms_clip", "-inf;inf,-1.000;1.000,-inf;inf"},
                            {"action_scale", "0.500"}},
                           "x.onnx");
  ASSERT_TRUE(settings.ok()) << settings.error().to_string();
  const auto spec = build_policy_spec(*settings, "x.onnx");
  ASSERT_TRUE(spec.ok()) << spec.error().to_string();
  EXPECT_THAT(spec->joints, ElementsAre("hip", "knee"));
  EXPECT_THAT(spec->kd, ElementsAre(0.5, 0.25));
  EXPECT_THAT(spec->action_scale, ElementsAre(0.5, 0.5));
  const auto& parts = spec->networks[0].parts;
  EXPECT_THAT(parts[0].scale, ElementsAre(0.25, 0.5, 1));
  EXPECT_EQ(parts[1].history, 3);
  EXPECT_THAT(parts[1].clip, ElementsAre(-1, 1));
  EXPECT_EQ(parts[2].kind->name, "velocity_commands");
}

TEST(PolicySpec, HistoriesOfMjlabMustBeFlat) {
  for (const auto& [flags, is_flat] : {std::pair{"1.000,1.000", true},
                                       {"1.000,0.000", false},
                                       {"0.000,1.000", true},  // without a history it has no effect
                                       {"1.000", false}}) {
    const auto settings = settings_of_metadata({{"joint_names", "a"},
                                                {"observation_names", "joint_pos,joint_vel"},
                                                {"observation_terms_history_length", "0.0,3.0"},
                                                {"observation_terms_flatten_history_dim", flags}},
                                               "x.onnx");
    EXPECT_EQ(settings.ok(), is_flat) << flags;
  }
}

TEST(PolicySpec, MetadataOfHolosomaAndItsToml) {
  const auto metadata = settings_of_metadata({{"dof_names", R"(["a", "b"])"},
                                              {"kp", "[1, 2.5]"},
                                              {"kd", "[1, 2]"},
                                              {"command_ranges", R"({"lin_vel_x": [-1, 2]})"}},
                                             "x.onnx");
  ASSERT_TRUE(metadata.ok());
  EXPECT_THAT(build_policy_spec(*metadata, "x.onnx").error().message,
              HasSubstr("action_scale, default_positions and [[observation]] terms"));
  auto over = parse_toml(
      "[policy]\naction_scale = 1\ndefault_positions = {}\n" + std::string(kTerm), "p.toml");
  const auto merged = merge_settings(*metadata, std::move(*over), "p.toml");
  ASSERT_TRUE(merged.ok());
  const auto spec = build_policy_spec(*merged, "p.toml");
  ASSERT_TRUE(spec.ok()) << spec.error().to_string();
  EXPECT_THAT(spec->kp, ElementsAre(1, 2.5));
  EXPECT_TRUE(spec->starts_with_zeros);
  EXPECT_THAT(spec->command_ranges[0], ElementsAre(-1, 2));
}

TEST(PolicySpec, DamagedMetadataIsRejectedInWords) {
  for (const auto& [key, value] : {std::pair{"joint_stiffness", "1,x"},
                                   {"observation_terms_scale", "1,2,3"},
                                   {"observation_terms_history_length", "1e30,1"},
                                   {"action_scale", "nan"}}) {
    const auto damaged = settings_of_metadata({{"joint_names", "a,b"},
                                               {key, value},
                                               {"joint_damping", "1"},
                                               {"default_joint_pos", "0"},
                                               {"observation_names", "joint_pos,joint_vel"}},
                                              "x.onnx");
    const bool is_rejected = !damaged.ok() || !build_policy_spec(*damaged, "x.onnx").ok();
    EXPECT_TRUE(is_rejected) << key;
  }
  EXPECT_FALSE(settings_of_metadata({{"dof_names", "[[[["}}, "x.onnx").ok());
}

// Copies of settings with random bytes exchanged: a spec or an error with a message.
TEST(PolicySpec, DamagedSettingsAreReadSafely) {
  std::ifstream file(source_dir() / "examples/python/g1_dance.toml");
  std::stringstream text;
  text << file.rdbuf();
  const std::string whole = text.str();
  ASSERT_GT(whole.size(), 500u);
  for (uint64_t seed = 1; seed < 3000; ++seed) {
    std::string damaged = whole;
    uint64_t x = seed * 0x9E3779B97F4A7C15ull;
    for (int change = 0; change < 2; ++change) {
      x ^= x << 13, x ^= x >> 7, x ^= x << 17;
      damaged[x % damaged.size()] = static_cast<char>(32 + (x >> 32) % 95);
    }
    const auto spec = build(damaged);
    EXPECT_TRUE(spec.ok() || !spec.error().message.empty());
  }
}

}  // namespace
}  // namespace gloam
