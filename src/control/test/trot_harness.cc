#include "trot_harness.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "base/rng.h"
#include "control/trot_legs.h"

namespace gloam {
namespace {

struct Sample {
  std::array<double, 3> goal, measured;
};

double rms(const std::vector<double>& x) {
  double sum = 0;
  for (double v : x) sum += v * v;
  return x.empty() ? 0 : std::sqrt(sum / static_cast<double>(x.size()));
}

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Centred moving mean over `width` samples.
std::vector<double> smooth(const std::vector<double>& x, int width) {
  std::vector<double> sum(x.size() + 1, 0), out(x.size());
  for (size_t i = 0; i < x.size(); ++i) sum[i + 1] = sum[i] + x[i];
  for (size_t i = 0; i < x.size(); ++i) {
    const size_t half = static_cast<size_t>(width) / 2;
    const size_t a = i > half ? i - half : 0, b = std::min(x.size(), i + half + 1);
    out[i] = (sum[b] - sum[a]) / static_cast<double>(b - a);
  }
  return out;
}

}  // namespace

TrialResult run_trial(const mjModel& known_model, const Trial& trial) {
  TrialResult out;
  auto made = make_trot_controller(known_model, robot_instance(known_model), trial.options);
  if (!made.ok()) {
    ADD_FAILURE() << made.error().to_string();
    out.fell = true;
    return out;
  }
  TrotController& trot = *made.value();
  ModelPtr real_model(mj_copyModel(nullptr, &known_model));
  const mjModel& model = *real_model;
  if (trial.surprise_mass > 0) {
    const int trunk = mj_name2id(&model, mjOBJ_BODY, "trunk");
    const double grow = 1 + trial.surprise_mass / model.body_mass[trunk];
    real_model->body_mass[trunk] *= grow;
    for (int i = 0; i < 3; ++i) real_model->body_inertia[3 * trunk + i] *= grow;
    TestData scratch(mj_makeData(&model));
    mj_setConst(real_model.get(), scratch.get());
  }
  TestData data(mj_makeData(&model));
  mjData* d = data.get();
  if (model.nkey > 0) mj_resetDataKeyframe(&model, d, 0);
  mj_forward(&model, d);
  trot.reset(&model, d);

  const int trunk = mj_name2id(&model, mjOBJ_BODY, "trunk");
  const int base_dof = model.jnt_dofadr[model.body_jntadr[trunk]];
  const Quadruped robot = find_quadruped(known_model, robot_instance(known_model)).value();
  std::array<int, 4> feet;
  for (int k = 0; k < 4; ++k) feet[k] = robot.legs[k].foot_geom;

  const double dt = model.opt.timestep;
  const int every = std::max(1, static_cast<int>(std::lround(trial.control_period / dt)));
  const auto steps = static_cast<int64_t>(std::lround((trial.duration + trial.settle) / dt));
  const RandomStream random{trial.seed, stream_id("trot.push")};
  std::vector<int64_t> push_steps;
  for (int i = 0; i < trial.pushes; ++i)
    push_steps.push_back(static_cast<int64_t>(
        (trial.settle + (i + random.uniform(0, i)) * trial.duration / trial.pushes) / dt));

  std::vector<Sample> samples;
  std::vector<double> tilt, height;
  std::array<double, 4> top{};
  std::array<bool, 4> down{true, true, true, true};
  double clearance_sum = 0, slip_sum = 0;
  int64_t clearance_count = 0, slip_count = 0;
  double spent = 0;  // [s]
  VelocityTarget goal;
  for (int64_t step = 0; step < steps; ++step) {
    const double time = static_cast<double>(step) * dt - trial.settle;
    goal = {};
    for (const auto& g : trial.goals)
      if (time >= g.time - 1e-9) goal = g.target;
    for (size_t i = 0; i < push_steps.size(); ++i)
      if (push_steps[i] == step) {
        const double angle = 2 * M_PI * random.uniform(1, static_cast<uint32_t>(i));
        d->qvel[base_dof] += trial.push * std::cos(angle);
        d->qvel[base_dof + 1] += trial.push * std::sin(angle);
      }
    if (step % every == 0) {
      const double start = cpu_seconds();
      trot.control({&model, d, {}, step, every * dt, goal});
      spent += cpu_seconds() - start;
    }
    mj_step(&model, d);
    if (trot.fallen()) {
      out.fell = true;
      break;
    }
    for (int i = 0; i < model.nu; ++i) {
      const int dof = model.jnt_dofadr[model.actuator_trnid[2 * i]];
      out.torque_share =
          std::max(out.torque_share, std::abs(d->ctrl[i]) / model.actuator_ctrlrange[2 * i + 1]);
      out.speed = std::max(out.speed, std::abs(d->qvel[dof]));
    }
    const mjtNum* p = d->xpos + 3 * trunk;
    out.extent = {std::min(out.extent[0], p[0]), std::max(out.extent[1], p[0]),
                  std::min(out.extent[2], p[1]), std::max(out.extent[3], p[1])};
    if (time < 0) continue;
    const mjtNum* R = d->xmat + 9 * trunk;
    const double yaw = std::atan2(R[3], R[0]), c = std::cos(yaw), s = std::sin(yaw);
    const mjtNum* v = d->qvel + base_dof;
    const double yaw_rate = R[6] * v[3] + R[7] * v[4] + R[8] * v[5];
    samples.push_back(
        {{goal.vx, goal.vy, goal.yaw_rate}, {c * v[0] + s * v[1], -s * v[0] + c * v[1], yaw_rate}});
    tilt.push_back(std::acos(std::clamp(R[8], -1.0, 1.0)) * 180 / M_PI);
    height.push_back(d->xpos[3 * trunk + 2]);
    for (int k = 0; k < 4; ++k) {
      bool touching = false;
      for (int n = 0; n < d->ncon; ++n)
        touching |= d->contact[n].geom[0] == feet[k] || d->contact[n].geom[1] == feet[k];
      const double z = d->geom_xpos[3 * feet[k] + 2] - model.geom_size[3 * feet[k]];
      if (touching) {
        mjtNum velocity[6];
        mj_objectVelocity(&model, d, mjOBJ_GEOM, feet[k], velocity, 0);
        const double r = model.geom_size[3 * feet[k]];  // of the sole, not the rolling centre
        slip_sum += std::hypot(velocity[3] - r * velocity[1], velocity[4] + r * velocity[0]);
        ++slip_count;
        if (!down[k] && top[k] > 0.01) {
          clearance_sum += top[k];
          ++clearance_count;
        }
        top[k] = 0;
      } else {
        top[k] = std::max(top[k], z);
      }
      down[k] = touching;
    }
  }
  out.stepping = trot.status().stepping;
  out.saturated = trot.status().saturated;
  out.calls = trot.status().calls;
  out.control_us = 1e6 * spent / static_cast<double>(std::max<int64_t>(1, out.calls));
  const int stride = static_cast<int>(trial.options.period / dt);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> error, commanded;
    for (const auto& s : samples) {
      error.push_back(s.goal[axis] - s.measured[axis]);
      if (s.goal[axis] != 0) commanded.push_back(s.goal[axis]);
      out.mean[axis] += s.measured[axis] / static_cast<double>(samples.size());
    }
    const double scale = commanded.empty() ? 1 : rms(commanded);
    out.raw[axis] = rms(error) / scale;
    out.stride[axis] = rms(smooth(error, stride)) / scale;
  }
  out.tilt_deg = rms(tilt);
  double mean_height = 0;
  for (double z : height) mean_height += z / static_cast<double>(height.size());
  for (double& z : height) z -= mean_height;
  out.height_sd = rms(height);
  out.slip = slip_count > 0 ? slip_sum / static_cast<double>(slip_count) : 0;
  out.clearance = clearance_count > 0 ? clearance_sum / static_cast<double>(clearance_count) : 0;
  return out;
}

std::string table_header() {
  return fmt::format(
      "{:<26} {:>4} | raw {:>5} {:>6} {:>6} | stride {:>5} {:>6} {:>6} | {:>17} | "
      "tilt  zsd  slip clear torq speed  sat   us",
      "trial", "fell", "vx", "vy", "yaw", "vx", "vy", "yaw", "mean");
}

std::string table_row(const std::string& name, const TrialResult& r) {
  return fmt::format(
      "{:<26} {:>4} | {:>9.3f} {:>6.3f} {:>6.3f} | {:>12.3f} {:>6.3f} {:>6.3f} | {:>5.2f} {:>5.2f} "
      "{:>5.2f} | {:>4.1f} {:>4.0f} {:>5.3f} {:>5.3f} {:>4.2f} {:>5.1f} {:>4} {:>4.1f}",
      name, r.fell ? "FELL" : "-", r.raw[0], r.raw[1], r.raw[2], r.stride[0], r.stride[1],
      r.stride[2], r.mean[0], r.mean[1], r.mean[2], r.tilt_deg, 1e3 * r.height_sd, r.slip,
      r.clearance, r.torque_share, r.speed, r.saturated, r.control_us);
}

}  // namespace gloam
