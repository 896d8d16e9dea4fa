#pragma once
// Water that rain leaves on roofs, tables and the like and that falls from their edges in drops: a
// pure function of (seed, time).

#include <vector>

#include "base/rng.h"
#include "world/weather/particle_set.h"
#include "world/weather/shelter_map.h"

namespace gloam {

/// Edge over which water leaves a roof: between the middle of a cell of the shelter map and that of
/// a lower one beside it.
struct DripEdge {
  Vec3f from;      ///< the cell's middle, at its height [m]
  Vec2f out;       ///< unit vector to the lower cell
  float way = 0;   ///< to its middle [m]
  float flow = 0;  ///< [m³/s]
};

/// Edges that are at least 0.3 m high. All that falls on a cell runs down, over level ground the
/// shortest way, to where it can fall. `rain`: [m/s].
std::vector<DripEdge> find_drip_edges(const ShelterMap& map, double rain);

struct Drip {
  double time = 0;     ///< when it lets go [s]
  float along = 0;     ///< the edge, from the middle of the cell's, in widths of a cell
  float diameter = 0;  ///< [m]
  Philox4 bits;        ///< draws of its own
};

inline constexpr float kSmallestDrip = 4e-3f, kLargestDrip = 5e-3f;  ///< diameters [m]
/// Mean volume of drops from edges [m³].
double mean_drip_volume();

/// Adds those that let go at times in [from, to) [s].
void find_drips(const DripEdge& edge, uint64_t seed, double from, double to,
                std::vector<Drip>* out);

/// A drop that falls from rest against the drag that stops its speed from growing at the end.
struct DripFall {
  explicit DripFall(float diameter);
  double depth(double time) const;  ///< after so long [m]
  double speed(double time) const;  ///< [m/s]
  double time(double depth) const;  ///< [s]
  double last_speed;                ///< [m/s]
};

}  // namespace gloam
