#include "sim/effects/soil_bed.h"

#include "base/hash.h"

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
  const size_t most = contacts_.most_touches();
  bodies_.reserve(geoms.size()), moduli_.reserve(geoms.size());
  lanes_.reserve(most / SoilLanes::kSide + geoms.size()), changes_.reserve(most);
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
                    a.rest == b.rest;
  if (!same) return false;
  cells_ = before.cells_;
  tracks_.take_over(before.tracks_);
  return true;
}

bool SoilBed::is_near(const mjModel& m, const mjData& d, int geom) const {
  const double *R = d.geom_xmat + 9 * geom, *box = m.geom_aabb + 6 * geom;
  if (d.geom_xpos[3 * geom + 2] - m.geom_rbound[geom] > soil_.level) return false;
  double centre[3], half[3];
  mju_mulMatVec3(centre, R, box);
  mju_addTo3(centre, d.geom_xpos + 3 * geom);
  edges_around(R, box + 3, half);
  double bottom = soil_.level - soil_.depth;
  if (!soil_.rest.empty()) bottom = -1e10;  // nobody is below uneven ground
  return std::abs(centre[0] - soil_.x) < half[0] + soil_.size_x / 2 &&
         std::abs(centre[1] - soil_.y) < half[1] + soil_.size_y / 2 &&
         centre[2] - half[2] < soil_.level && centre[2] + half[2] > bottom;
}

uint64_t SoilBed::press(uint32_t step, const mjModel& m, const mjData& d,
                        std::span<const ColliderBottom* const> colliders, uint64_t hash) {
  contacts_.clear();
  for (const ColliderBottom* collider : colliders) {
    if (is_near(m, d, collider->geom())) contacts_.add(*collider);
  }
  contacts_.finish();
  find_bodies();
  changes_.clear();
  const std::span<const SoilTouch> touches = contacts_.touches();
  for (const Body& body : bodies_) {
    double motion[6];
    velocity_at(m, d, body.id, body.point, motion);
    std::copy_n(d.cvel + 6 * body.id, 3, motion + 3);
    const std::span<SoilLanes> lanes = lanes_of(body);
    for (SoilLanes& four : lanes) four.find_loading(soil_, motion, m.opt.timestep);
    for (size_t n = 0; n < body.count; ++n) {
      const SoilTouch& touch = touches[body.first + n];
      press_cell(step, touch, lanes[n / SoilLanes::kSide], n % SoilLanes::kSide, motion);
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
      lanes_.back().set(n % SoilLanes::kSide, touch, body.point,
                        moduli_[static_cast<size_t>(touch.patch)]);
    }
    bodies_.push_back(body);
  }
}

std::span<SoilLanes> SoilBed::lanes_of(const Body& body) {
  constexpr size_t kSide = SoilLanes::kSide;
  return std::span(lanes_).subspan(body.lanes, (body.count + kSide - 1) / kSide);
}

// What has happened since the last step; `lanes`: with its i-th the touch's. `motion`: the body's.
void SoilBed::press_cell(uint32_t step, const SoilTouch& touch, const SoilLanes& lanes, size_t i,
                         const double* motion) {
  SoilCell& cell = cells_[static_cast<size_t>(touch.cell)];
  const bool is_fresh = cell.touched != step;
  cell.touched = step + 1;
  const double line =
      double{cell.pressure} - cell.unloading(soil_.strength) * (double{cell.sinkage} - touch.depth);
  const double loading = lanes.loading[i];
  const bool was_pressed = cell.sinkage > 0,
             presses = touch.depth > 0 && (!was_pressed || line > 0);
  if (is_fresh || !presses) std::fill_n(cell.shear, 3, 0.0f);
  if (!presses) return;
  if (!was_pressed || line >= loading) {
    cell.sinkage = static_cast<float>(touch.depth);
    cell.pressure = static_cast<float>(loading);
    const double share = std::min(touch.area / (soil_.dx * soil_.dy), 1.0);
    const double left = touch.depth - loading / cell.unloading(soil_.strength);
    const auto height = static_cast<float>(-left * share);
    const float lower = tracks_.height(touch.cell) - height;
    if (lower > 0) {
      tracks_.set_height(touch.cell, height);
      const double arm[2] = {lanes.arm[0][i], lanes.arm[1][i]};
      const double velocity[2] = {motion[0] - motion[5] * arm[1] + motion[4] * lanes.arm[2][i],
                                  motion[1] + motion[5] * arm[0] - motion[3] * lanes.arm[2][i]};
      push_aside(touch, velocity, double{lower} * soil_.dx * soil_.dy * soil_.strength.aside);
    }
  }
  for (size_t a = 0; a < 3; ++a) {
    const double shear = double{cell.shear[a]};
    cell.shear[a] = static_cast<float>(shear + (lanes.shearing[a][i] - shear) * lanes.share[i]);
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
