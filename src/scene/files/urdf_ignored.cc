#include "scene/files/urdf_ignored.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <string>

namespace gloam {
namespace {

constexpr std::string_view kOfRobot[] = {"link", "joint", "material", "mujoco"};
constexpr std::string_view kOfLink[] = {"inertial", "visual", "collision"};
constexpr std::string_view kOfJoint[] = {"origin", "parent",   "child", "axis",
                                         "limit",  "dynamics", "mimic"};

struct Remark {
  std::string_view element, meaning, remedy;
};
constexpr Remark kRemarks[] = {
    {"transmission", "joints have no motors or gears of their own",
     "use a [robot.controller] to move the joints (docs/scenes.md), or <actuator> in an MJCF"},
    {"ros2_control", "no hardware interface is loaded",
     "use a [robot.controller] to move the joints, and topics or follow_joint_trajectory to "
     "command it (docs/ros2.md)"},
    {"gazebo", "sensors, plugins and surfaces of Gazebo are not supported",
     "add a [[camera]], [[lidar]] … to the scene; set friction with [override]"},
    {"safety_controller", "soft limits are not supported", "the joint's <limit> applies"},
    {"calibration", "positions are measured from the joint's zero", ""},
    {"sensor", "sensors belong to the scene", "add a [[camera]], [[lidar]] … to the scene"},
};

// Elements of one name below nodes of one kind.
struct Ignored {
  pugi::xml_node first;
  int count = 0;
};

void collect(const pugi::xml_node& node, std::span<const std::string_view> known,
             std::map<std::string, Ignored>* found) {
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() != pugi::node_element) continue;
    if (std::ranges::find(known, child.name()) != known.end()) continue;
    Ignored& ignored = (*found)[child.name()];
    if (ignored.count++ == 0) ignored.first = child;
  }
}

}  // namespace

std::vector<Error> list_ignored_elements(
    const pugi::xml_node& robot, const std::function<SourceLoc(const pugi::xml_node&)>& loc_of) {
  std::map<std::string, Ignored> found;
  collect(robot, kOfRobot, &found);
  for (const pugi::xml_node& link : robot.children("link")) collect(link, kOfLink, &found);
  for (const pugi::xml_node& joint : robot.children("joint")) collect(joint, kOfJoint, &found);
  std::vector<Error> notes;
  for (const auto& [name, ignored] : found) {
    const auto* remark = std::ranges::find(kRemarks, name, &Remark::element);
    const bool is_known = remark != std::end(kRemarks);
    std::string text = fmt::format("<{:.60}> is ignored", name);
    if (is_known) text += fmt::format(": {}", remark->meaning);
    if (ignored.count > 1) text += fmt::format(" ({} of them)", ignored.count);
    notes.push_back(
        {ErrorKind::kUnsupported, std::move(text), loc_of(ignored.first),
         is_known ? std::string(remark->remedy) : "URDF does not define this element here"});
  }
  return notes;
}

}  // namespace gloam
