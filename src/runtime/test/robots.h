#pragma once
// Robots for the tests of the runtime: other people's, unedited, beside stock MuJoCo's own load of
// the same file. tests/fetch_data.py gets them; GLOAM_TEST_DATA says where.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gloam/simulation.h"
#include "scene/test/temp_folder.h"
#include "sim/loop/stepper.h"
#include "world/world.h"

namespace gloam {

/// The file as a program without Gloam would have it.
struct StockModel {
  explicit StockModel(const std::filesystem::path& file);
  ModelPtr model;  ///< null when stock MuJoCo refuses the file; `error` says why
  DataPtr data;
  std::string error;
};

/// "mjlab/…" or "robosuite/…" in the test data; nothing when it was not fetched.
std::optional<std::filesystem::path> third_party_file(const std::string& name);

/// A test for each of the robots, skipped where they were not fetched; its cache is its own.
class ThirdPartyRobot : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override;

  const TempFolder folder_;
  std::filesystem::path file_;
  std::optional<StockModel> stock_;
};

inline constexpr const char* kGo1 = "mjlab/mjlab/asset_zoo/robots/unitree_go1/xmls/go1.xml";
inline constexpr const char* kG1 = "mjlab/mjlab/asset_zoo/robots/unitree_g1/xmls/g1.xml";
inline constexpr const char* kYam = "mjlab/mjlab/asset_zoo/robots/i2rt_yam/xmls/yam.xml";
inline constexpr const char* kPanda = "robosuite/robosuite/models/assets/robots/panda/robot.xml";

/// Random inputs of one step: a control for every actuator, in its range, and a force of up to the
/// body's own weight on every body (robots without actuators have nothing else to be driven by).
/// Pure functions of (model, step), so both sides draw the same.
struct RandomInputs {
  RandomInputs(const mjModel& model, int64_t step);
  void write(const mjModel& model, mjData* data) const;
  Status post(Simulation& simulation, int64_t step) const;
  int count() const { return static_cast<int>(controls.size() + forces.size()); }

  std::vector<double> controls;  // (nactuator)
  std::vector<Vec3> forces;      // (nbody) [N]
};

/// qpos, qvel and act.
std::vector<double> motion_state(const mjModel& model, const mjData& data);
/// mjSTATE_INTEGRATION.
std::vector<double> integration_state(const mjModel& model, const mjData& data);

/// Of its file, or of the folder of files called robot.xml.
std::string robot_name(const ::testing::TestParamInfo<const char*>& info);

}  // namespace gloam
