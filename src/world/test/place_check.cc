#include "world/test/place_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <set>

#include "places/writer/spec_geom.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr double kStepHeight = 0.2, kProbeHeight = 0.6;  // [m]
constexpr double kFlight = 1;  // stairs are reached on the last steps below their floor [m]

std::string body_of(const mjModel& m, int geom) {
  const char* name = mj_id2name(&m, mjOBJ_BODY, m.geom_bodyid[geom]);
  return name != nullptr ? name : "?";
}

class Checker {
 public:
  Checker(const CompiledWorld& world, double cell)
      : world_(world),
        cell_(cell),
        m_(mj_copyModel(nullptr, world.model.get())),
        d_(mj_makeData(m_.get())) {
    on_slopes_ = m_->nhfield > 0;
    probe_ = mj_name2id(m_.get(), mjOBJ_GEOM, "probe/cylinder");
    for (int j = 0; j < static_cast<int>(m_->njnt); ++j) {
      const char* name = mj_id2name(m_.get(), mjOBJ_BODY, m_->jnt_bodyid[j]);
      const std::string_view body = name != nullptr ? name : "";
      const std::string_view stem = body.substr(0, body.rfind('/'));
      if (m_->jnt_type[j] == mjJNT_HINGE && stem.substr(0, stem.rfind('_')).ends_with("door"))
        doors_.push_back(j);
    }
  }

  PlaceReport run() {
    hide_probe();
    mj_forward(m_.get(), d_.get());
    look_at_contacts();
    let_settle(2);
    swing_doors();
    walk();
    return std::move(report_);
  }

 private:
  void hide_probe() {
    mj_resetData(m_.get(), d_.get());
    const int mocap = m_->body_mocapid[m_->geom_bodyid[probe_]];
    d_->mocap_pos[3 * mocap + 2] = -100;
  }

  void look_at_contacts() {
    for (int i = 0; i < d_->ncon; ++i) {
      const mjContact& c = d_->contact[i];
      if (-c.dist <= report_.deepest_contact) continue;
      report_.deepest_contact = -c.dist;
      report_.deepest = body_of(*m_, c.geom[0]) + " and " + body_of(*m_, c.geom[1]);
    }
  }

  void let_settle(double seconds) {
    const std::vector<mjtNum> before(d_->xpos, d_->xpos + 3 * m_->nbody);
    const std::vector<mjtNum> facing(d_->xquat, d_->xquat + 4 * m_->nbody);
    const int steps = static_cast<int>(seconds / m_->opt.timestep);
    for (int i = 0; i < steps; ++i) mj_step(m_.get(), d_.get());
    mj_forward(m_.get(), d_.get());
    for (int b = 1; b < static_cast<int>(m_->nbody); ++b) {
      const mjtNum* p = &before[3 * static_cast<size_t>(b)];
      const mjtNum* q = d_->xpos + 3 * b;
      const double moved = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
      if (!std::isfinite(moved)) report_.furthest = 1e9;
      if (moved > report_.furthest) {
        report_.furthest = moved;
        report_.furthest_body = mj_id2name(m_.get(), mjOBJ_BODY, b);
      }
      mjtNum turn[3];
      mju_subQuat(turn, d_->xquat + 4 * b, &facing[4 * static_cast<size_t>(b)]);
      const double turned = mju_norm3(turn);
      if (turned > report_.most_turned) {
        report_.most_turned = turned;
        report_.most_turned_body = mj_id2name(m_.get(), mjOBJ_BODY, b);
      }
    }
  }

  void swing_doors() {
    constexpr double kAllowed = 0.002;
    constexpr int kPositions = 12;
    for (const int joint : doors_) {
      hide_probe();
      const int leaf = m_->jnt_bodyid[joint];
      for (int i = 0; i <= kPositions; ++i) {
        const mjtNum* range = m_->jnt_range + 2 * joint;
        d_->qpos[m_->jnt_qposadr[joint]] = range[0] + (range[1] - range[0]) * i / kPositions;
        mj_kinematics(m_.get(), d_.get());
        mj_collision(m_.get(), d_.get());
        for (int c = 0; c < d_->ncon; ++c) {
          const mjContact& contact = d_->contact[c];
          const bool ours =
              m_->geom_bodyid[contact.geom[0]] == leaf || m_->geom_bodyid[contact.geom[1]] == leaf;
          if (!ours || -contact.dist <= kAllowed) continue;
          report_.blocked_doors.push_back(
              fmt::format("{} at {:.2f} rad by {}", mj_id2name(m_.get(), mjOBJ_BODY, leaf),
                          d_->qpos[m_->jnt_qposadr[joint]],
                          body_of(*m_, contact.geom[0]) + " and " + body_of(*m_, contact.geom[1])));
          i = kPositions;
          break;
        }
      }
    }
  }

  // Where the probe stands on the floor at (x, y), near the height z; NaN where it cannot.
  double stand(double x, double y, double z) {
    const mjtNum from[3] = {x, y, z + 2.5 * kStepHeight}, down[3] = {0, 0, -1};
    mjtByte groups[mjNGROUP] = {};
    groups[kColliderGroup] = 1;
    int hit = -1;
    const double drop =
        mj_ray(m_.get(), d_.get(), from, down, groups, 1, m_->geom_bodyid[probe_], &hit, nullptr);
    const double ground = from[2] - drop;
    if (hit < 0 || std::abs(ground - z) > kStepHeight) return NAN;
    mjtNum* p = d_->geom_xpos + 3 * probe_;
    p[0] = x, p[1] = y, p[2] = ground + kStepHeight + (kProbeHeight - kStepHeight) / 2;
    mj_collision(m_.get(), d_.get());
    for (int i = 0; i < d_->ncon; ++i)
      if (d_->contact[i].dist < 0) return NAN;
    return ground;
  }

  void walk() {
    hide_probe();
    for (const int joint : doors_) d_->qpos[m_->jnt_qposadr[joint]] = m_->jnt_range[2 * joint + 1];
    mj_kinematics(m_.get(), d_.get());
    // Only what touches the probe is of interest.
    for (int g = 0; g < static_cast<int>(m_->ngeom); ++g)
      if (g != probe_) m_->geom_contype[g] = 0;
    for (int b = 0; b < static_cast<int>(m_->nbody); ++b)
      if (b != m_->geom_bodyid[probe_]) m_->body_contype[b] = 0;

    using Place = std::tuple<int, int, int>;  // cell, cell, height in quarters of a step
    std::set<Place> seen;
    std::map<std::string, double> area;
    std::deque<std::tuple<int, int, double>> open;
    double low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9;
    for (const Region& r : world_.regions) {
      low_x = std::min(low_x, r.low.x), high_x = std::max(high_x, r.high.x);
      low_y = std::min(low_y, r.low.y), high_y = std::max(high_y, r.high.y);
    }
    const auto visit = [&](int i, int j, double z) {
      const double x = i * cell_, y = j * cell_;
      if (x < low_x || x > high_x || y < low_y || y > high_y) return;
      if (!seen.insert({i, j, static_cast<int>(std::lround(z / (kStepHeight / 4)))}).second) return;
      const double ground = stand(x, y, z);
      if (!(std::abs(ground) < 1e6)) return;
      open.emplace_back(i, j, ground);
      report_.reached_area += cell_ * cell_;
      for (const Region& r : world_.regions)
        if (x > r.low.x && x < r.high.x && y > r.low.y && y < r.high.y &&
            ((ground < r.low.z + 0.05 &&
              ground > r.low.z - (r.label == "stairs" ? kFlight : 0.05)) ||
             (on_slopes_ && ground > r.low.z && ground < r.high.z)))
          area[r.name] += cell_ * cell_;
    };
    visit(0, 0, 0);
    while (!open.empty()) {
      const auto [i, j, z] = open.front();
      open.pop_front();
      for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
        visit(i + di, j + dj, z);
    }
    constexpr double kEnough = 0.25;  // [m²]
    for (const Region& r : world_.regions)
      if (area[r.name] < kEnough) report_.unreached.push_back(r.name);
  }

  const CompiledWorld& world_;
  const double cell_;
  ModelPtr m_;
  DataPtr d_;
  int probe_ = -1;
  bool on_slopes_ = false;  // floors of regions rise and fall
  std::vector<int> doors_;
  PlaceReport report_;
};

}  // namespace

std::string probe_model(double radius) {
  return fmt::format(
      "<mujoco><worldbody><body name='probe' mocap='true' pos='0 0 -100'>"
      "<geom name='cylinder' type='cylinder' size='{} {}'/></body></worldbody></mujoco>",
      radius, (kProbeHeight - kStepHeight) / 2);
}

PlaceReport check_place(const CompiledWorld& world, double cell) {
  return Checker(world, cell).run();
}

}  // namespace gloam
