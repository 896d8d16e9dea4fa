#include "world/weather/roof_drips.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace gloam {
namespace {

constexpr float kLeastDrop = 0.3f;  // from an edge [m]
constexpr float kUphill = 0.01f;    // height that water of some depth runs over [m]
constexpr double kDripGravity = 9.81;
constexpr double kDripSlot = 0.25;  // for which drips are sampled at once [s]
// Drops hang from edges about as far apart as the fastest growing ripples of a film do: 2 pi sqrt 2
// times the capillary length, 24 mm (Fermigier et al. 1992). Four to a usual cell.
constexpr float kSites = 4;
// Drops that drip are larger than rain: 4 to 5 mm (Bond's number of gravity and surface tension,
// rho g D² / sigma, is 2.1 to 3.4), whatever the rain.
constexpr double kLow = double{kSmallestDrip}, kHigh = double{kLargestDrip};

struct Step {
  int i, j;
};
constexpr Step kDripSteps[4] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};

/// Water runs from one cell to another until it falls: found from the edges upwards, lowest first
/// (after Barnes, Lehman and Mulla 2014, "Priority-flood").
class Runoff {
 public:
  explicit Runoff(const ShelterMap& map) : map_(map), next_(map.height.size(), kNowhere), order_() {
    for (int j = 0; j < map.ny; ++j)
      for (int i = 0; i < map.nx; ++i) begin_at(i, j);
    while (!open_.empty()) {
      const Entry here = open_.top();
      open_.pop();
      order_.push_back(here.cell);
      for (const Step& step : kDripSteps) climb(here, step);
    }
  }

  std::vector<DripEdge> edges(double rain) const {
    std::vector<double> flow(next_.size());
    const double fallen = rain * static_cast<double>(map_.cell) * static_cast<double>(map_.cell);
    std::vector<DripEdge> out;
    for (auto at = order_.rbegin(); at != order_.rend(); ++at) {
      const auto cell = static_cast<size_t>(*at);
      flow[cell] += fallen;
      if (next_[cell] >= 0) flow[static_cast<size_t>(next_[cell])] += flow[cell];
    }
    for (const int cell : order_)
      if (next_[static_cast<size_t>(cell)] < 0) add(cell, flow[static_cast<size_t>(cell)], &out);
    return out;
  }

 private:
  static constexpr int kNowhere = -2, kFalls = -1;
  struct Entry {
    float height;
    int rank;  // in the order found, so that level ground is gone over by distance
    int cell;
    bool operator<(const Entry& o) const {
      return height != o.height ? height > o.height : rank > o.rank;
    }
  };

  bool is_inside(int i, int j) const { return i >= 0 && j >= 0 && i < map_.nx && j < map_.ny; }
  int cell_of(int i, int j) const { return j * map_.nx + i; }
  float height(int i, int j) const {
    return is_inside(i, j) ? map_.height[static_cast<size_t>(cell_of(i, j))] : -1e30f;
  }
  bool falls(int i, int j, const Step& step) const {
    return height(i + step.i, j + step.j) < height(i, j) - kLeastDrop;
  }
  void begin_at(int i, int j) {
    const float z = height(i, j);
    if (!std::isfinite(z)) return;
    if (std::none_of(std::begin(kDripSteps), std::end(kDripSteps),
                     [&](const Step& step) { return falls(i, j, step); }))
      return;
    next_[static_cast<size_t>(cell_of(i, j))] = kFalls;
    open_.push({z, rank_++, cell_of(i, j)});
  }
  void climb(const Entry& from, const Step& step) {
    const int i = from.cell % map_.nx + step.i, j = from.cell / map_.nx + step.j;
    if (!is_inside(i, j)) return;
    const int cell = cell_of(i, j);
    const float z = height(i, j);
    if (next_[static_cast<size_t>(cell)] != kNowhere || !std::isfinite(z) ||
        z < from.height - kUphill || z > from.height + kLeastDrop)
      return;
    next_[static_cast<size_t>(cell)] = from.cell;
    open_.push({std::max(z, from.height), rank_++, cell});
  }
  /// Its sides that are edges have a share each.
  void add(int cell, double flow, std::vector<DripEdge>* out) const {
    const int i = cell % map_.nx, j = cell / map_.nx;
    const auto sides = std::count_if(std::begin(kDripSteps), std::end(kDripSteps),
                                     [&](const Step& step) { return falls(i, j, step); });
    for (const Step& step : kDripSteps) {
      if (!falls(i, j, step)) continue;
      out->push_back({{map_.low.x + (static_cast<float>(i) + 0.5f) * map_.cell,
                       map_.low.y + (static_cast<float>(j) + 0.5f) * map_.cell, height(i, j)},
                      {static_cast<float>(step.i), static_cast<float>(step.j)},
                      map_.cell,
                      static_cast<float>(flow / static_cast<double>(sides))});
    }
  }

  const ShelterMap& map_;
  std::vector<int> next_;   // cell that a cell's water runs to, or kFalls
  std::vector<int> order_;  // cells whose water falls somewhere, from the edges on
  std::priority_queue<Entry> open_;
  int rank_ = 0;
};

}  // namespace

std::vector<DripEdge> find_drip_edges(const ShelterMap& map, double rain) {
  return Runoff(map).edges(rain);
}

double mean_drip_volume() {
  // Mean over evenly distributed diameters.
  const auto fourth = [](double d) { return d * d * d * d; };
  return 3.14159265358979323846 / 6 * (fourth(kHigh) - fourth(kLow)) / (4 * (kHigh - kLow));
}

void find_drips(const DripEdge& edge, uint64_t seed, double from, double to,
                std::vector<Drip>* out) {
  const double mean = static_cast<double>(edge.flow) / mean_drip_volume() * kDripSlot;
  if (!(mean > 0)) return;
  const RandomStream random{seed, stream_id("drips")};
  const auto place = [](float x) {  // [cm]
    return static_cast<uint64_t>(static_cast<int64_t>(std::lround(x * 100))) & 0xFFFFF;
  };
  // Key of the edge's middle, so that those of one cell differ.
  const uint64_t site = place(edge.from.x + 0.4f * edge.way * edge.out.x) |
                        place(edge.from.y + 0.4f * edge.way * edge.out.y) << 20;
  const auto first = static_cast<int64_t>(std::floor(from / kDripSlot));
  const auto last = static_cast<int64_t>(std::floor(to / kDripSlot));
  for (int64_t slot = first; slot <= last; ++slot) {
    const uint64_t key = site | static_cast<uint64_t>(slot) << 40;
    double at = 0;  // time by Poisson's law, from the times between one and the next
    for (uint32_t n = 0;; ++n) {
      const Philox4 draw = random.draw(key, n);
      at -= std::log(1 - static_cast<double>(uniform_float(draw.v[0]))) / mean;
      if (!(at < 1)) break;
      const double time = (static_cast<double>(slot) + at) * kDripSlot;
      if (time < from || time >= to) continue;
      const float tip = std::floor(kSites * uniform_float(draw.v[1])) + 0.5f;
      const double size = static_cast<double>(uniform_float(draw.v[2]));
      out->push_back(
          {time, tip / kSites - 0.5f, static_cast<float>(kLow + (kHigh - kLow) * size), draw});
    }
  }
}

DripFall::DripFall(float diameter)
    : last_speed(9.65 - 10.3 * std::exp(-600 * static_cast<double>(diameter))) {}

double DripFall::depth(double time) const {
  return last_speed * last_speed / kDripGravity *
         std::log(std::cosh(kDripGravity * time / last_speed));
}
double DripFall::speed(double time) const {
  return last_speed * std::tanh(kDripGravity * time / last_speed);
}
double DripFall::time(double depth) const {
  return last_speed / kDripGravity *
         std::acosh(std::exp(kDripGravity * depth / (last_speed * last_speed)));
}

}  // namespace gloam
