// Settings and metadata of hostile files: values of any type under every key give a bounded policy
// or an error with a message.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "policy/policy_spec.h"
#include "policy/test/leg_robot.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace {

constexpr size_t kLargestObservation = 1000 * 10'000;  // history times the largest term

constexpr const char* kValues[] = {"0",
                                   "-1",
                                   "1e308",
                                   "inf",
                                   "-inf",
                                   "nan",
                                   "1000001",
                                   "0.5",
                                   "true",
                                   "\"\"",
                                   "\"hip\"",
                                   "\".*\"",
                                   "\"(\"",
                                   "\"zeros\"",
                                   "\"a.b\"",
                                   "[]",
                                   "[1, 2]",
                                   "[2, 1]",
                                   "[nan, 1]",
                                   "[1, [2]]",
                                   "[\"hip\"]",
                                   "[\"hip\", \"hip\"]",
                                   "[{}]",
                                   "{}",
                                   "{a = 1}",
                                   "{hip = 1}",
                                   "{vx = 1}",
                                   "{vx = [1, nan]}",
                                   "{\".*\" = inf}",
                                   "1979-05-27",
                                   "9223372036854775807"};

void expect_a_bounded_spec_or_an_error(const Result<PolicySpec>& spec, const std::string& text) {
  if (!spec.ok()) {
    EXPECT_FALSE(spec.error().message.empty()) << text;
    EXPECT_EQ(spec.error().kind, ErrorKind::kInput) << text;
    return;
  }
  for (const NetworkSpec& network : spec->networks)
    for (const ObservationPart& part : network.parts)
      EXPECT_LE(part.term->size() * static_cast<size_t>(part.history), kLargestObservation) << text;
}

void check_text(const std::string& text) {
  auto table = parse_toml(text, "p.toml");
  ASSERT_TRUE(table.ok()) << text << table.error().to_string();
  expect_a_bounded_spec_or_an_error(build_policy_spec(*table, "p.toml"), text);
}

TEST(HostileSettings, AnyValueUnderAnyKeyOfAPolicy) {
  const std::vector<std::string> keys = {
      "rate",         "joints",         "model_joints",  "kp",      "kd",      "default_positions",
      "action_scale", "action_clip",    "torque_limit",  "gait",    "feet",    "history_start",
      "gait_period",  "command_ranges", "history_order", "history", "unknown", "joints.hip"};
  const std::vector<std::pair<std::string, std::string>> good = {{"joints", "[\"knee\", \"hip\"]"},
                                                                 {"kp", "1"},
                                                                 {"kd", "1"},
                                                                 {"default_positions", "0"},
                                                                 {"action_scale", "1"}};
  for (const std::string& key : keys) {
    for (const char* value : kValues) {
      std::string text = "[policy]\n" + key + " = " + value + "\n";
      for (const auto& [name, usual] : good)
        if (!key.starts_with(name)) text += name + " = " + usual + "\n";
      check_text(text + "[[observation]]\nterm = \"joint_pos\"\n");
    }
  }
}

TEST(HostileSettings, AnyValueUnderAnyKeyOfATerm) {
  for (const TermKind& kind : term_kinds()) {
    std::vector<std::string> keys = {"scale", "clip",  "history", "sensor",
                                     "from",  "input", "first",   "count"};
    for (size_t begin = 0; begin < kind.keys.size();) {
      const size_t end = std::min(kind.keys.find(' ', begin), kind.keys.size());
      keys.emplace_back(kind.keys.substr(begin, end - begin));
      begin = end + 1;
    }
    for (const std::string& key : keys)
      for (const char* value : kValues)
        check_text(std::string(kLegPolicy) + "feet = [\"foot\"]\n[[observation]]\nterm = \"" +
                   std::string(kind.name) + "\"\n" + key + " = " + value + "\n");
  }
}

TEST(HostileSettings, AnyValueUnderAnyKeyOfANetwork) {
  for (const char* key :
       {"name", "file", "every", "history", "history_order", "prime", "observation", "unknown"}) {
    for (const char* value : kValues) {
      std::string text = std::string(kLegPolicy) + "[[network]]\n" + key + " = " + value + "\n";
      if (std::string_view(key) != "name") text += "name = \"a\"\n";
      if (std::string_view(key) != "observation")
        text += "[[network.observation]]\nterm = \"joint_pos\"\n";
      check_text(text);
    }
  }
}

using Metadata = std::vector<std::pair<std::string, std::string>>;

void check_metadata(const Metadata& good) {
  const std::vector<std::string> texts = {"",          "1.000",
                                          "a,b",       "1.000,2.000",
                                          "nan,1.000", "inf,nan",
                                          "inf,-inf",  "1e999",
                                          "-1",        "[]",
                                          "null",      "{\"lin_vel_x\": 3}",
                                          "[1, 2]",    "[\"a\"]",
                                          "[[1]]",     "3.000;1.000",
                                          "1e30",      ",,,,",
                                          ";;",        "[1, null]",
                                          "[[[[",      "{\"lin_vel_x\": [1, \"x\"]}",
                                          "\xff\xfe",  "base_ang_vel,joint_pos",
                                          "true",      "1.000,1.000,1.000",
                                          "0x10,1",    "1,2,"};
  for (size_t i = 0; i < good.size(); ++i) {
    for (size_t k = 0; k < good.size(); ++k) {
      for (const std::string& one : texts) {
        for (const std::string& other : texts) {
          Metadata metadata = good;
          metadata[k].second = other;
          metadata[i].second = one;
          const auto settings = settings_of_metadata(metadata, "p.onnx");
          const std::string text = metadata[i].first + " = " + one;
          if (settings.ok())
            expect_a_bounded_spec_or_an_error(build_policy_spec(*settings, "p.onnx"), text);
          else
            EXPECT_FALSE(settings.error().message.empty()) << text;
        }
      }
    }
  }
}

TEST(HostileSettings, AnyTextInMetadataOfMjlab) {
  check_metadata({{"joint_names", "a,b"},
                  {"joint_stiffness", "1.000,2.000"},
                  {"joint_damping", "1.000,2.000"},
                  {"default_joint_pos", "1.000,2.000"},
                  {"action_scale", "0.5"},
                  {"observation_names", "base_ang_vel,joint_pos"},
                  {"observation_terms_scale", "1.000,2.000"},
                  {"observation_terms_clip", "-inf;inf,-1.000;1.000"},
                  {"observation_terms_history_length", "0.000,3.000"},
                  {"observation_terms_flatten_history_dim", "1.000,1.000"}});
}

TEST(HostileSettings, AnyTextInMetadataOfHolosoma) {
  check_metadata({{"dof_names", "[\"a\", \"b\"]"},
                  {"kp", "[1, 2]"},
                  {"kd", "[1, 2]"},
                  {"action_scale", "0.5"},
                  {"command_ranges", "null"}});
}

}  // namespace
}  // namespace gloam
