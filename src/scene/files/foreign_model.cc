#include "scene/files/foreign_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace gloam {
namespace {

struct Format {
  std::string_view mark;  // begin of the text, or top element
  std::string_view name;
  std::string_view remedy;
};

constexpr std::string_view kUsdRemedy =
    "export the robot as URDF or MJCF from the program that created it; shapes alone can be "
    "exported as glTF and added as a [[visual]]";

// In lower case.
constexpr Format kTexts[] = {
    {"#usda", "a USD stage", kUsdRemedy},
    {"pxr-usdc", "a USD stage", kUsdRemedy},
    {"pk\x03\x04", "a ZIP archive", "unpack it and use the MJCF or URDF inside"},
    {"#vrml", "a VRML file (Webots)", "export the robot as URDF from Webots"},
    {"<!doctype html", "a web page", "download the file itself through the page's \"raw\" link"},
    {"<html", "a web page", "download the file itself through the page's \"raw\" link"},
    {"{", "JSON", "use an MJCF or URDF file, or a TOML scene"},
    {"%yaml", "YAML", "use an MJCF or URDF file, or a TOML scene"},
    {"---", "YAML", "use an MJCF or URDF file, or a TOML scene"},
    {"solid ", "a mesh (STL)", "add it as a [[visual]], or reference it in an MJCF or URDF"},
    {"ply", "a mesh (PLY)", "add it as a [[visual]], or reference it in an MJCF or URDF"},
    {"gltf", "a mesh (GLB)", "add it as a [[visual]], or as a body with [[object]]"},
};

constexpr Format kElements[] = {
    {"sdf", "an SDF (Gazebo)",
     "convert it: pip install sdformat-mjcf, then sdf2mjcf IN.sdf OUT.xml"},
    {"gazebo", "an old SDF (Gazebo)", "convert it with gz sdf -p, then with sdf2mjcf"},
    {"COLLADA", "a COLLADA mesh", "add it as a [[visual]], or reference it in an MJCF or URDF"},
    {"html", "a web page", "download the file itself through the page's \"raw\" link"},
    {"launch", "a ROS launch file", "use the URDF or MJCF that it loads"},
    {"package", "a ROS package manifest", "use the URDF or MJCF in the package"},
    {"model", "the model.config of a Gazebo model", "convert the SDF that it names with sdf2mjcf"},
    {"mujocoinclude", "an MJCF fragment", "use the file that includes it"},
    {"svg", "an image (SVG)", "use an MJCF or URDF file"},
    {"X3D", "an X3D file", "export it as glTF and add it as a [[visual]]"},
    {"Robot", "an OpenRAVE robot", "export it as URDF or COLLADA"},
    {"KinBody", "an OpenRAVE body", "export it as URDF or COLLADA"},
    {"Environment", "an OpenRAVE environment", "export it as URDF or COLLADA"},
};

constexpr std::string_view kSrdfElements[] = {
    "group",         "group_state",       "end_effector",
    "virtual_joint", "passive_joint",     "disable_collisions",
    "chain",         "enable_collisions", "disable_default_collisions",
    "joint_property"};

Error error_of(const Format& format, const std::string& file) {
  return {ErrorKind::kUnsupported,
          fmt::format("is {}, not MJCF or URDF", format.name),
          {file, 1, 0},
          std::string(format.remedy)};
}

}  // namespace

std::optional<Error> find_foreign_text(std::string_view text, const std::string& file) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  for (const Format& format : kTexts) {
    const bool fits =
        text.size() >= format.mark.size() &&
        std::equal(format.mark.begin(), format.mark.end(), text.begin(), [](char mark, char c) {
          return mark == std::tolower(static_cast<unsigned char>(c));
        });
    if (fits) return error_of(format, file);
  }
  return {};
}

Error foreign_element_error(std::string_view top, const std::string& file) {
  for (const Format& format : kElements)
    if (top == format.mark) return error_of(format, file);
  return {ErrorKind::kInput,
          fmt::format("the root element is <{:.40}>, so this is neither MJCF nor URDF", top),
          {file, 1, 0},
          "MJCF starts with <mujoco>, URDF with <robot>"};
}

Status check_is_urdf(const pugi::xml_node& robot, const std::string& file) {
  if (robot.child("link")) return {};
  for (const pugi::xml_node& child : robot.children())
    if (std::ranges::find(kSrdfElements, child.name()) != std::end(kSrdfElements))
      return Error{ErrorKind::kInput,
                   fmt::format("is an SRDF, not a URDF: it has <{}> and no <link>", child.name()),
                   {file, 1, 0},
                   "use the robot's URDF; an SRDF adds groups and poses for MoveIt"};
  return Error{
      ErrorKind::kInput,
      "is an empty robot: it has no <link>",
      {file, 1, 0},
      "if the robot is defined in included files, run xacro first: xacro FILE > FILE.urdf"};
}

}  // namespace gloam
