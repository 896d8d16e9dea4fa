#include "sim/effects/soil_bed.h"

#include "base/hash.h"
#include "base/wave_math.h"

namespace gloam {
namespace {

constexpr double kNoWay = 1e-9;     // [m]
constexpr double kMovesOn = 0.05;   // [m/s]
constexpr double kHeapWidth = 1.5;  // of a heap, over the sinkage beside it
constexpr double kNoSlide = 1e-5;   // [m]
constexpr int kFarthest = 64;       // cells to it

}  // namespace

SoilBed::SoilBed(const SoilDescription& soil, const mjModel& model, std::span<const int> geoms)
    : soil_(soil),
      contacts_(soil, model, geoms),
      cells_(soil.cells()),
      answers_of_(static_cast<size_t>(model.nbody)),
      tracks_(soil) {
  pushes_.reserve(contacts_.most_touches());
  reactions_.reserve(geoms.size());
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
  reactions_.clear();
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
  int body = -1;
  double motion[6] = {};
  for (const SoilTouch& touch : contacts_.touches()) {
    if (touch.body != body) {
      body = touch.body;
      mj_objectVelocity(&m, &d, mjOBJ_XBODY, body, motion, 0);  // angular, then linear
    }
    const double twist[6] = {motion[3], motion[4], motion[5], motion[0], motion[1], motion[2]};
    double v[3];
    soil_velocity_at(twist, d.xpos + 3 * body, touch.p, v);
    press_cell(step, m.opt.timestep, touch, v);
    const SoilCell& cell = cells_[static_cast<size_t>(touch.cell)];
    hash = hash_bytes(&cell, sizeof(cell), hash_bytes(&touch.cell, sizeof(touch.cell), hash));
  }
  return hash;
}

// What has happened since the last step.
void SoilBed::press_cell(uint32_t step, double dt, const SoilTouch& touch, const double* velocity) {
  SoilCell& cell = cells_[static_cast<size_t>(touch.cell)];
  const double modulus = soil_.strength.k_c / contacts_.widths()[static_cast<size_t>(touch.patch)] +
                         soil_.strength.k_phi;
  fill_in(step, dt, touch, &cell);
  const SoilPressure now =
      soil_pressure(soil_.strength, cell, modulus, depth_at(touch), touch.depth);
  if (now.yields) {
    cell.sinkage = static_cast<float>(touch.depth - touch.fallen);
    cell.pressure = static_cast<float>(now.p);
  }
  // What stands in its print keeps that from what falls.
  const bool sheltered = soil_.growth > 0 && cell.pressure > 0;
  const float lower = now.yields || sheltered ? lower_track(touch) : 0;
  if (now.yields)
    push_aside(touch, velocity, double{lower} * soil_.dx * soil_.dy * soil_.strength.aside);
  if (cell.touched != step || now.p <= 0) std::fill_n(cell.shear, 3, 0.0f);
  cell.touched = step + 1;
  if (now.p <= 0) return;
  double v[3];
  mju_copy3(v, velocity);
  project_along(touch.slope, v);
  const double speed = mju_norm3(v), way = speed * dt;
  if (way < kNoWay) return;
  const double share = 1 - exponential(-way / soil_.strength.shear);
  for (int a = 0; a < 3; ++a) {
    const double shear = double{cell.shear[a]};
    cell.shear[a] = static_cast<float>(shear - (v[a] / speed + shear) * share);
  }
}

// Returns by how much [m].
float SoilBed::lower_track(const SoilTouch& touch) {
  const SoilCell& cell = cells_[static_cast<size_t>(touch.cell)];
  const double share = std::min(touch.area / (soil_.dx * soil_.dy), 1.0);
  const double deepest = cell.sinkage_under(touch.fallen);
  const double left = deepest - double{cell.pressure} / cell.unloading(soil_.strength, deepest);
  const auto height = static_cast<float>(-left * share);
  const float lower = tracks_.height(touch.cell) - height;
  if (lower <= 0) return 0;
  tracks_.set_height(touch.cell, height);
  return lower;
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

// What is displaced rises beside what displaces it: away from its middle, or, where it moves on, at
// its sides. That is seen and not felt.
void SoilBed::push_aside(const SoilTouch& touch, const double* velocity, double volume) {
  if (volume <= 0) return;
  const double* centre = contacts_.centre(touch.patch);
  double way[2] = {touch.p[0] - centre[0], touch.p[1] - centre[1]};
  const double speed = std::hypot(velocity[0], velocity[1]);
  if (speed > kMovesOn) {
    const double across[2] = {-velocity[1] / speed, velocity[0] / speed};
    const double side = way[0] * across[0] + way[1] * across[1] < 0 ? -1 : 1;
    way[0] = side * across[0], way[1] = side * across[1];
  }
  const double length = std::hypot(way[0], way[1]);
  if (length < kNoWay) return;
  // From cell to cell, out of what is touched, then over as many as the heap is wide.
  const double step = std::min(soil_.dx, soil_.dy);
  const int wide = std::clamp(static_cast<int>(std::ceil(kHeapWidth * touch.depth / step)), 2, 8);
  int left = wide;
  for (int i = 1; i <= kFarthest && left > 0; ++i) {
    const double x = touch.p[0] + way[0] / length * step * i - soil_.low_x();
    const double y = touch.p[1] + way[1] / length * step * i - soil_.low_y();
    if (x < 0 || y < 0 || x >= soil_.size_x || y >= soil_.size_y) return;
    const int cell = std::min(static_cast<int>(y / soil_.dy), soil_.ny - 1) * soil_.nx +
                     std::min(static_cast<int>(x / soil_.dx), soil_.nx - 1);
    if (contacts_.is_touched(cell)) continue;
    const double share = 2.0 * left / (wide * (wide + 1));
    tracks_.set_height(
        cell, tracks_.height(cell) + static_cast<float>(share * volume / soil_.dx / soil_.dy));
    slide(cell);
    --left;
  }
}

// What lies loose slides down from a cell to the lowest beside it, and from there, until it is no
// steeper than its friction holds; not into what is in the ground.
void SoilBed::slide(int cell) {
  for (int way = 0; way < kFarthest; ++way) {
    const int i = cell % soil_.nx, j = cell / soil_.nx;
    int lowest = -1;
    double excess = 0;  // [m]
    const auto look = [&](bool is_inside, int beside, double distance) {
      if (!is_inside || contacts_.is_touched(beside)) return;
      const double over = double{tracks_.height(cell)} - double{tracks_.height(beside)} -
                          distance * soil_.strength.tan_friction;
      if (over > excess) excess = over, lowest = beside;
    };
    look(i > 0, cell - 1, soil_.dx);
    look(i + 1 < soil_.nx, cell + 1, soil_.dx);
    look(j > 0, cell - soil_.nx, soil_.dy);
    look(j + 1 < soil_.ny, cell + soil_.nx, soil_.dy);
    if (excess < kNoSlide) return;
    const auto part = static_cast<float>(excess / 2);
    tracks_.set_height(cell, tracks_.height(cell) - part);
    tracks_.set_height(lowest, tracks_.height(lowest) + part);
    cell = lowest;
  }
}

}  // namespace gloam
