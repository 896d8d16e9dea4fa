#include "scene/files/mujoco_hints.h"

namespace gloam {
namespace {

struct Hint {
  std::string_view said;     // a part of MuJoCo's message
  std::string_view element;  // "" = any
  std::string_view hint;
};

// Hints from MuJoCo's changelog for elements, attributes and plugins that are gone, and for demands
// of its compiler that do not say how. The first that fits counts.
constexpr Hint kHints[] = {
    {"unrecognized element", "composite",
     "MuJoCo 4 no longer has <composite>: a cable, rope or loop is a <flexcomp dim=\"1\"> with "
     "<elasticity>, cloth one of dim=\"2\", a soft solid one of dim=\"3\", particles are a "
     "<replicate>"},
    {"unrecognized element", "flexvert", "MuJoCo 4 no longer has <flexvert>: use <flexstrain>"},
    {"unrecognized attribute: 'collision'", "option",
     "the attribute is gone from MuJoCo: leave it out"},
    {"unrecognized attribute: 'apirate'", "option",
     "the attribute is gone from MuJoCo: leave it out"},
    {"unrecognized attribute: 'exactmeshinertia'", "compiler",
     "the attribute is gone from MuJoCo: give meshes inertia=\"exact\""},
    {"unrecognized attribute: 'convexhull'", "compiler",
     "the attribute is gone from MuJoCo: leave it out"},
    {"plugin mujoco.elasticity", "",
     "MuJoCo 4 no longer has this plugin: <flexcomp> has <elasticity> of its own"},
    {"plugin ", "plugin",
     "Gloam loads the plugins that come with MuJoCo, and no others: leave it out, or use an "
     "actuator of MJCF or a [robot.controller]"},
    {"inertia must satisfy A + B >= C", "",
     "no body can have these moments: correct them, or let MuJoCo spread them evenly by <compiler "
     "balanceinertia=\"true\"/>, in a scene by [override.ROBOT.compiler] balanceinertia = true"},
    {"mass and inertia of moving bodies must be larger than mjMINVAL", "",
     "give the body a mass, or all of them a least one by <compiler boundmass=\"0.001\" "
     "boundinertia=\"1e-6\"/>, in a scene by [override.ROBOT.compiler] boundmass = 0.001"},
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
