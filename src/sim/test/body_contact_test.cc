// People as springs: peak forces of impacts against v sqrt(k m).

#include "sim/agents/body_contact.h"
#include "agent_rig.h"

namespace gloam {
namespace {

struct Impact {
  double speed = 0;    ///< at the first touch [m/s]
  double peak = 0;     ///< force [N]
  double leaves = 0;   ///< speed at which it parts [m/s]
  double deepest = 0;  ///< [m]
};

struct Setup {
  double mass = 12, speed = 3.5, height = 1.2, timestep = 0.001;
  std::string option = "cone='pyramidal'", geom = "type='sphere' size='.1'";
};

/// A thing that gravity along -x, small against the impact, drives against a person at x = 0.
Impact hit(const Setup& setup) {
  const double g = 2, way = setup.speed * setup.speed / (2 * g);
  char place[1200];
  snprintf(place, sizeof(place),
           "<mujoco><option timestep='%g' gravity='-%g 0 0' %s/><worldbody>"
           "<geom type='plane' size='20 20 .1' contype='2' conaffinity='1'/>"
           "<body name='ram' pos='%g %g %g'><joint type='slide' axis='1 0 0'/>"
           "<geom %s mass='%g' contype='1' conaffinity='1'/></body></worldbody></mujoco>",
           setup.timestep, g, setup.option.c_str(), way + 0.25, setup.height < 0.5 ? 0.0875 : 0,
           setup.height, setup.geom.c_str(), setup.mass);
  AgentRig rig(place);
  AgentOptions& ann = rig.add("ann", {0, 0, 0}, "stand");
  ann.height = 1.75;
  ann.yields = false;
  auto stepper = rig.stepper();
  Impact impact;
  bool touched = false;
  for (int i = 0; i * setup.timestep < 2 * setup.speed / g; ++i) {
    const double before = -stepper->data().qvel[0];
    if (!stepper->step()) break;
    const mjData& d = stepper->data();
    double force = 0;
    for (int c = 0; c < static_cast<int>(d.ncon); ++c) {
      mjtNum wrench[6];
      mj_contactForce(&stepper->model(), &d, c, wrench);
      force += wrench[0];
      impact.deepest = std::max(impact.deepest, -d.contact[c].dist);
    }
    if (force > 0 && !touched) impact.speed = before;
    touched |= force > 0;
    impact.peak = std::max(impact.peak, force);
    if (touched && force <= 0) {
      impact.leaves = d.qvel[0];
      break;
    }
  }
  return impact;
}

TEST(BodyContact, PeakForcesAreThoseOfTheRegionsSpring) {
  const struct {
    const char* name;
    double height, stiffness, bones;
  } regions[] = {{"chest", 1.2, kChestStiffness, 0.09}, {"shank", 0.3, kShankStiffness, 0.04}};
  for (const auto& region : regions) {
    for (const auto& [mass, speed] : {std::pair{12.0, 3.5}, {3.0, 1.0}, {1.0, 2.0}, {30.0, 1.0}}) {
      for (const double timestep : {0.0005, 0.002, 0.004}) {
        const Impact impact = hit({mass, speed, region.height, timestep});
        const double law = impact.speed * std::sqrt(region.stiffness * mass);
        std::printf("%s, %.0f kg at %.2f m/s, %.1f ms: %.0f N (law %.0f), %.0f mm, parts at %.2f\n",
                    region.name, mass, impact.speed, 1e3 * timestep, impact.peak, law,
                    1e3 * impact.deepest, impact.leaves);
        const double phase = timestep * std::sqrt(region.stiffness / mass);  // of a step
        if (impact.deepest > region.bones || phase > 0.5) continue;
        EXPECT_NEAR(impact.peak / law, 1, 0.12);
        EXPECT_GT(impact.leaves, 0);
        EXPECT_LT(impact.leaves, 0.8 * impact.speed) << "flesh is no spring that gives all back";
      }
    }
  }
}

TEST(BodyContact, DoesNotDependOnTheSolversConeOrTheShape) {
  for (const char* option : {"cone='elliptic'", "cone='pyramidal' solver='CG'",
                             "cone='elliptic' integrator='implicitfast'"}) {
    for (const char* geom : {"type='sphere' size='.1'", "type='box' size='.1 .1 .1'",
                             "type='sphere' size='.1' condim='1'"}) {
      SCOPED_TRACE(std::string(option) + " " + geom);
      const Impact impact = hit({.option = option, .geom = geom});
      EXPECT_NEAR(impact.peak / (impact.speed * std::sqrt(kChestStiffness * 12)), 1, 0.12);
    }
  }
}

TEST(BodyContact, LightThingsDoNotJump) {
  const Impact impact = hit({.mass = 0.02, .speed = 2, .timestep = 0.005});
  EXPECT_GT(impact.peak, 0);
  EXPECT_LT(impact.leaves, 2);
  EXPECT_LT(impact.deepest, 0.03);
}

}  // namespace
}  // namespace gloam
