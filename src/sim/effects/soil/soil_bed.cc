#include "sim/effects/soil/soil_bed.h"

#include "base/hash.h"

namespace gloam {

SoilBed::SoilBed(const SoilDescription& soil, const mjModel& model, std::span<const int> geoms)
    : soil_(soil),
      contacts_(soil, model, geoms),
      cells_(soil.cells()),
      answers_of_(static_cast<size_t>(model.nbody)),
      tracks_(soil) {
  const size_t most = contacts_.most_touches();
  bodies_.reserve(geoms.size()), moduli_.reserve(geoms.size());
  lanes_.reserve(most / SoilLanes::kSide + geoms.size()), changes_.reserve(most);
  held_.reserve(most), unsettled_.reserve(kMostSlides + 1);
  loads_.reserve(geoms.size());
  for (const int geom : geoms) {
    const int body = model.geom_bodyid[geom];
    Answer& answer = answers_of_[static_cast<size_t>(body)];
    if (answer.count > 0) continue;
    answer.first = answers_.size();
    answer.count = static_cast<size_t>(chain_length(model, body));
    answers_.resize(answers_.size() + answer.count);
  }
}

void SoilBed::reset() {
  std::fill(cells_.begin(), cells_.end(), SoilCell{});
  for (Answer& answer : answers_of_) answer.step = 0;
  contacts_.reset();
  loads_.clear();
  held_.clear();
  tracks_.reset();
}

bool SoilBed::take_over(const SoilBed& before) {
  const SoilDescription &a = soil_, &b = before.soil_;
  const bool same = a.name == b.name && a.nx == b.nx && a.ny == b.ny && a.x == b.x && a.y == b.y &&
                    a.size_x == b.size_x && a.size_y == b.size_y && a.level == b.level &&
                    a.rest == b.rest && a.share == b.share && a.depth == b.depth &&
                    a.growth == b.growth;
  if (!same) return false;
  cells_ = before.cells_;
  tracks_.take_over(before.tracks_);
  return true;
}

bool SoilBed::is_near(const mjModel& m, const mjData& d, int geom) const {
  const double *R = d.geom_xmat + 9 * geom, *box = m.geom_aabb + 6 * geom;
  const double level = soil_.level + soil_.growth * d.time;
  if (d.geom_xpos[3 * geom + 2] - m.geom_rbound[geom] > level) return false;
  double centre[3], half[3];
  mju_mulMatVec3(centre, R, box);
  mju_addTo3(centre, d.geom_xpos + 3 * geom);
  edges_around(R, box + 3, half);
  double bottom = soil_.level - soil_.depth;
  if (!soil_.rest.empty()) bottom = -1e10;  // nobody is below uneven ground
  return std::abs(centre[0] - soil_.x) < half[0] + soil_.size_x / 2 &&
         std::abs(centre[1] - soil_.y) < half[1] + soil_.size_y / 2 &&
         centre[2] - half[2] < level && centre[2] + half[2] > bottom;
}

uint64_t SoilBed::press(uint32_t step, const mjModel& m, const mjData& d,
                        std::span<const ColliderBottom* const> colliders, uint64_t hash) {
  contacts_.clear(soil_.growth * d.time);
  tracks_.let_fall(soil_.growth * d.time);
  for (const ColliderBottom* collider : colliders) {
    if (is_near(m, d, collider->geom())) contacts_.add(*collider);
  }
  contacts_.finish();
  let_walls_fall();
  find_bodies();
  changes_.clear();
  const std::span<const SoilTouch> touches = contacts_.touches();
  for (const Body& body : bodies_) {
    double motion[6];
    velocity_at(m, d, body.id, body.point, motion);
    std::copy_n(d.cvel + 6 * body.id, 3, motion + 3);
    const std::span<SoilLanes> lanes = lanes_of(body);
    for (SoilLanes& four : lanes) four.find_loading(soil_.strength, motion, m.opt.timestep);
    for (size_t n = 0; n < body.count; ++n) {
      const SoilTouch& touch = touches[body.first + n];
      press_cell(step, m.opt.timestep, touch, lanes[n / SoilLanes::kSide], n % SoilLanes::kSide,
                 motion);
      changes_.push_back({touch.cell, cells_[static_cast<size_t>(touch.cell)]});
    }
  }
  if (changes_.empty()) return hash;
  return hash_span<Change>(changes_, hash);
}

void SoilBed::find_bodies() {
  const SoilStrength& s = soil_.strength;
  moduli_.clear();
  for (int patch = 0; patch < contacts_.patches(); ++patch)
    moduli_.push_back(s.k_c / contacts_.width(patch) + s.k_phi);
  bodies_.clear(), lanes_.clear();
  const std::span<const SoilTouch> all = contacts_.touches();
  for (size_t from = 0, to = 0; from < all.size(); from = to) {
    Body body{.id = all[from].body, .first = from, .lanes = lanes_.size()};
    double area = 0;
    for (; to < all.size() && all[to].body == body.id; ++to) {
      area += all[to].area;
      for (int a = 0; a < 3; ++a) body.point[a] += all[to].area * all[to].p[a];
    }
    for (double& x : body.point) x /= area;
    body.count = to - from;
    for (size_t n = 0; n < body.count; ++n) {
      if (n % SoilLanes::kSide == 0) lanes_.emplace_back();
      const SoilTouch& touch = all[from + n];
      const double share = soil_.share_of(static_cast<size_t>(touch.cell));
      lanes_.back().set(n % SoilLanes::kSide, touch, body.point,
                        moduli_[static_cast<size_t>(touch.patch)],
                        share * soil_.depth + touch.fallen);
    }
    bodies_.push_back(body);
  }
}

std::span<SoilLanes> SoilBed::lanes_of(const Body& body) {
  constexpr size_t kSide = SoilLanes::kSide;
  return std::span(lanes_).subspan(body.lanes, (body.count + kSide - 1) / kSide);
}

// Update of a cell since the last step; `lanes`: its i-th is the touch's. `motion`: the body's.
void SoilBed::press_cell(uint32_t step, double dt, const SoilTouch& touch, const SoilLanes& lanes,
                         size_t i, const double* motion) {
  SoilCell& cell = cells_[static_cast<size_t>(touch.cell)];
  fill_in(step, dt, touch, &cell);
  const bool is_fresh = cell.touched != step;
  cell.touched = step + 1;
  const double z = touch.depth, loading = lanes.loading[i];
  const SoilLine line =
      unloading_line(cell.sinkage_under(touch.fallen), double{cell.pressure},
                     cell.unloading(soil_.strength, touch.fallen), loading / z, z);
  const bool was_pressed = cell.pressure > 0,
             presses = z > 0 && lanes.bottom[i] > 0 && (!was_pressed || line.p > 0),
             yields = presses && (!was_pressed || line.p >= loading);
  if (yields) {
    cell.sinkage = static_cast<float>(z - touch.fallen);
    cell.pressure = static_cast<float>(loading);
  }
  // A body that stands in its print shelters it from falling snow.
  const bool sheltered = soil_.growth > 0 && cell.pressure > 0;
  const float lower = yields || sheltered ? lower_track(touch) : 0;
  if (yields && lower > 0) {
    const double arm[2] = {lanes.arm[0][i], lanes.arm[1][i]};
    const double velocity[2] = {motion[0] - motion[5] * arm[1] + motion[4] * lanes.arm[2][i],
                                motion[1] + motion[5] * arm[0] - motion[3] * lanes.arm[2][i]};
    push_aside(touch, velocity, double{lower} * soil_.dx * soil_.dy * soil_.strength.aside);
  }
  if (is_fresh || !presses) std::fill_n(cell.shear, 3, 0.0f);
  if (!presses) return;
  for (size_t a = 0; a < 3; ++a) {
    const double shear = double{cell.shear[a]};
    cell.shear[a] = static_cast<float>(shear + (lanes.shearing[a][i] - shear) * lanes.share[i]);
  }
}

// A print that nothing stands in has become as much shallower as snow has fallen since then, as in
// SoilTracks, and is felt as one that was never deeper.
void SoilBed::fill_in(uint32_t step, double dt, const SoilTouch& touch, SoilCell* cell) const {
  if (soil_.growth <= 0 || cell->pressure <= 0 || cell->touched >= step) return;
  const double share = soil_.share_of(static_cast<size_t>(touch.cell));
  const double fell = share * soil_.growth * dt * (step - cell->touched);
  const double now = cell->sinkage_under(touch.fallen) - 2 * fell, before = now + fell;
  if (now <= 0) {
    cell->sinkage = cell->pressure = 0;
  } else {
    cell->sinkage = static_cast<float>(now - touch.fallen);
    cell->pressure *= static_cast<float>(std::pow(now / before, soil_.strength.n));
  }
}

}  // namespace gloam
