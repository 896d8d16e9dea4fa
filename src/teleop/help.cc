#include "teleop/help.h"

#include <fmt/format.h>

namespace gloam::teleop {
namespace {

struct HelpRow {
  const char *keys, *gamepad, *meaning;
};

const char* kind_of(const ik::FrameName& frame) {
  switch (frame.kind) {
    case ik::FrameKind::kBody:
      return "body";
    case ik::FrameKind::kSite:
      return "site";
    case ik::FrameKind::kGeom:
      return "geom";
  }
  return "";
}

std::vector<HelpRow> motion_rows(const RobotGoals& goals, bool moves_frame) {
  const bool is_sideways = moves_frame || !goals.velocity->vy.is_zero();
  const bool is_vertical = moves_frame || !goals.velocity->vz.is_zero();
  std::vector<HelpRow> rows = {{"W S, Up Down", "left stick", "forward, back"}};
  if (is_sideways) rows.push_back({"A D", "left stick", "left, right"});
  rows.push_back({is_sideways ? "Q E, Left Right" : "A D, Q E, Left Right", "right stick",
                  "turn left, right"});
  if (is_vertical) rows.push_back({"R F", "right stick", "up, down"});
  if (moves_frame) rows.push_back({"I K", "directional pad", "tilt up, down"});
  if (moves_frame) rows.push_back({"J L", "directional pad", "roll left, right"});
  return rows;
}

}  // namespace

std::vector<std::string> help_lines(const std::string& robot, const RobotGoals& goals,
                                    bool moves_frame) {
  std::vector<HelpRow> rows = motion_rows(goals, moves_frame);
  if (goals.gripper) rows.push_back({"G", "triggers, A", "open, close the gripper"});
  if (goals.velocity && goals.frame)
    rows.push_back({"Tab", "Y", "switch between driving and moving the frame"});
  rows.push_back({"1 to 9, + -", "bumpers", "speed"});
  rows.push_back({"Space", "B", "stop"});
  rows.push_back({"H", "", "show this help"});
  rows.push_back({"Esc, Ctrl-C", "", "end the run"});
  std::vector<std::string> lines = {
      moves_frame ? fmt::format("Each key press moves the goal of {} '{}':", kind_of(*goals.frame),
                                goals.frame->name)
                  : fmt::format("Keys drive robot '{}' while they are held:", robot)};
  rows.insert(rows.begin(), {"keyboard", "gamepad", ""});
  for (const HelpRow& row : rows)
    lines.push_back(fmt::format("  {:<22} {:<17} {}", row.keys, row.gamepad, row.meaning));
  return lines;
}

}  // namespace gloam::teleop
