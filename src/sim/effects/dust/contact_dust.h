#pragma once
// Dust from contacts with dusty ground, gathered on the sim thread between two ticks of a gas:
// impacts of feet last milliseconds, and ticks would miss them.
//
// Each contact of a body with the static ground gives: AP-42's law for the distance it rolls, by
// the fraction of its tree's weight that it carries; dust per energy for the work of friction and
// for the energy of impacts. In a bed of soil the greater of both counts, since rolling things sink
// in at each turn. People, whose feet have no contact with the ground, give a step's worth at each
// step.

#include <mujoco/mujoco.h>

#include <vector>

#include "sim/effects/effect.h"
#include "world/world.h"

namespace gloam {

struct DustDeposit {
  Vec3f p;         ///< middle of where it was raised [m], world
  float mass = 0;  ///< [kg]
};

class ContactDust {
 public:
  /// Gathers what is raised in the box from `low` to `high` [m].
  ContactDust(const CompiledWorld& world, Vec3f low, Vec3f high);

  void reset();
  /// After mj_step, while `data` has its contacts, forces and velocities. `events`: of that step.
  void gather(const mjModel& model, const mjData& data, const StepEvents& events);
  /// Deposits gathered since the last call, by what raised them.
  std::vector<DustDeposit> take();

 private:
  struct Heap {
    double mass = 0;        // [kg]
    double moment[3] = {};  // times position [kg m]
  };
  struct Ground {
    const DustDescription* box = nullptr;
    double per_energy = 0;  // dust [kg/J]
    // Dust per distance, by body, for the weight of its tree in the model [kg/m]
    std::vector<double> per_way;
  };
  const Ground* ground_at(const double* p) const;
  void gather_contact(const mjModel& model, const mjData& data, int contact);
  void gather_soil(const mjModel& model, const mjData& data, const ContactLoad& load);
  void gather_footfall(const Footfall& footfall);
  static void put(double mass, const double* p, Heap* heap);

  std::vector<Ground> grounds_;
  Vec3f low_, high_;
  std::vector<Heap> of_geoms_, of_agents_;
};

}  // namespace gloam
