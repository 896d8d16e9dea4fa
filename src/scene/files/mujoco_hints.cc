#include "scene/files/mujoco_hints.h"

namespace gloam {
namespace {

struct Hint {
  std::string_view said;     // a part of MuJoCo's message
  std::string_view element;  // "" = any
  std::string_view hint;
};

// Hints from MuJoCo's changelog for removed elements, attributes and plugins, and remedies for
// requirements of its compiler. The first match applies.
constexpr Hint kHints[] = {
    {"unrecognized element", "composite",
     "MuJoCo 4 no longer has <composite>: use <flexcomp dim=\"1\"> with <elasticity> for a cable, "
     "rope or loop, dim=\"2\" for cloth, dim=\"3\" for a soft solid, and <replicate> for "
     "particles"},
    {"unrecognized element", "flexvert", "MuJoCo 4 no longer has <flexvert>: use <flexstrain>"},
    {"unrecognized attribute: 'collision'", "option",
     "MuJoCo no longer has this attribute: remove it"},
    {"unrecognized attribute: 'apirate'", "option",
     "MuJoCo no longer has this attribute: remove it"},
    {"unrecognized attribute: 'exactmeshinertia'", "compiler",
     "MuJoCo no longer has this attribute: set inertia=\"exact\" on meshes"},
    {"unrecognized attribute: 'convexhull'", "compiler",
     "MuJoCo no longer has this attribute: remove it"},
    {"plugin mujoco.elasticity", "",
     "MuJoCo 4 no longer has this plugin: use <elasticity> in <flexcomp>"},
    {"plugin ", "plugin",
     "Gloam loads only the plugins that come with MuJoCo: remove it, or use an MJCF actuator or a "
     "[robot.controller]"},
    {"inertia must satisfy A + B >= C", "",
     "no body can have these moments of inertia: correct them, or let MuJoCo average them with "
     "<compiler balanceinertia=\"true\"/>, in a scene with [override.ROBOT.compiler] "
     "balanceinertia = true"},
    {"mass and inertia of moving bodies must be larger than mjMINVAL", "",
     "give the body a mass, or set a minimum for all bodies with <compiler boundmass=\"0.001\" "
     "boundinertia=\"1e-6\"/>, in a scene with [override.ROBOT.compiler] boundmass = 0.001"},
};

}  // namespace

std::string mujoco_hint(std::string_view message, std::string_view element) {
  for (const Hint& hint : kHints) {
    if (message.find(hint.said) == std::string_view::npos) continue;
    if (hint.element.empty() || hint.element == element) return std::string(hint.hint);
  }
  return {};
}

}  // namespace gloam
