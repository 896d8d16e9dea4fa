#include "robots.h"

#include <cstdlib>

#include "base/rng.h"
#include "scene/files/mujoco_guard.h"
#include "scene/files/mujoco_plugins.h"

namespace gloam {

StockModel::StockModel(const std::filesystem::path& file) {
  load_mujoco_plugins();  // as the stock programs that these files were written for
  const MujocoWarningCapture warnings;
  char text[1000] = "";
  model.reset(mj_loadXML(file.c_str(), nullptr, text, sizeof(text)));
  error = text;
  if (model != nullptr) data.reset(mj_makeData(model.get()));
}

void ThirdPartyRobot::SetUp() {
  const auto file = third_party_file(GetParam());
  if (!file) GTEST_SKIP() << "no third-party robots: run tests/fetch_data.py, set GLOAM_TEST_DATA";
  ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
  file_ = *file;
  stock_.emplace(file_);
  ASSERT_NE(stock_->model, nullptr) << stock_->error;
}

std::optional<std::filesystem::path> third_party_file(const std::string& name) {
  const char* data = std::getenv("GLOAM_TEST_DATA");
  if (data == nullptr) return {};
  const std::filesystem::path file = std::filesystem::path(data) / name;
  if (!std::filesystem::exists(file)) return {};
  return file;
}

RandomInputs::RandomInputs(const mjModel& m, int64_t step) {
  constexpr RandomStream kControl{11, stream_id("test.control")},
      kForce{11, stream_id("test.force")};
  const auto counter = static_cast<uint64_t>(step);
  for (int i = 0; i < m.nactuator; ++i) {
    const double u = kControl.uniform(counter, static_cast<uint32_t>(i));
    const int ctrl = m.actuator_ctrladr[i];
    const double* range = m.actuator_ctrlrange + 2 * ctrl;
    controls.push_back(m.actuator_ctrllimited[ctrl] ? range[0] + u * (range[1] - range[0])
                                                    : 2 * u - 1);
  }
  for (int b = 0; b < m.nbody; ++b) {
    const double weight = 9.81 * m.body_mass[b];
    const auto draw = [&](int axis) {
      return weight * (2 * kForce.uniform(counter, static_cast<uint32_t>(3 * b + axis)) - 1);
    };
    forces.push_back({draw(0), draw(1), draw(2)});
  }
}

void RandomInputs::write(const mjModel& m, mjData* d) const {
  for (size_t i = 0; i < controls.size(); ++i) d->ctrl[m.actuator_ctrladr[i]] = controls[i];
  for (size_t b = 1; b < forces.size(); ++b) {
    const double wrench[6] = {forces[b].x, forces[b].y, forces[b].z, 0, 0, 0};
    mju_copy(d->xfrc_applied + 6 * b, wrench, 6);
  }
}

Status RandomInputs::post(Simulation& simulation, int64_t step) const {
  for (size_t i = 0; i < controls.size(); ++i) {
    GLOAM_TRY_STATUS(simulation.post({step, SetControl{{static_cast<int>(i)}, controls[i]}}));
  }
  for (size_t b = 1; b < forces.size(); ++b) {
    GLOAM_TRY_STATUS(simulation.post({step, SetWrench{{static_cast<int>(b)}, forces[b], {}}}));
  }
  return {};
}

std::vector<double> motion_state(const mjModel& m, const mjData& d) {
  std::vector<double> state(d.qpos, d.qpos + m.nq);
  state.insert(state.end(), d.qvel, d.qvel + m.nv);
  state.insert(state.end(), d.act, d.act + m.na);
  return state;
}

std::vector<double> integration_state(const mjModel& m, const mjData& d) {
  std::vector<double> state(static_cast<size_t>(mj_stateSize(&m, mjSTATE_INTEGRATION)));
  mj_getState(&m, &d, state.data(), mjSTATE_INTEGRATION);
  return state;
}

std::string robot_name(const ::testing::TestParamInfo<const char*>& info) {
  const std::filesystem::path file(info.param);
  const bool named = file.stem() != "robot";
  return (named ? file.stem() : file.parent_path().filename()).string();
}

}  // namespace gloam
