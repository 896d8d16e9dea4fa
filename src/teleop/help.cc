#include "teleop/help.h"

#include <fmt/format.h>

namespace gloam::teleop {
namespace {

struct HelpRow {
  const char *keys, *gamepad, *meaning;
};

void add_row(std::string* text, const HelpRow& row) {
  *text += fmt::format("\n  {:<18} {:<22} {}", row.keys, row.gamepad, row.meaning);
}

void add_motion(std::string* text, const RobotGoals& goals, bool moves_frame) {
  const bool is_sideways = moves_frame || !goals.velocity->vy.is_zero();
  add_row(text, {"W S  Up Down", "left stick", "forward, back"});
  if (is_sideways) add_row(text, {"A D", "left stick", "left, right"});
  add_row(text,
          {is_sideways ? "Q E  Left Right" : "A D  Left Right", "right stick", "turn left, right"});
  if (moves_frame || !goals.velocity->vz.is_zero())
    add_row(text, {"R F", "right stick", "up, down"});
  if (!moves_frame) return;
  add_row(text, {"I K", "directional pad", "tilt down, up"});
  add_row(text, {"J L", "directional pad", "roll left, right"});
}

}  // namespace

std::string help_text(const std::string& robot, const RobotGoals& goals, bool moves_frame) {
  std::string text = moves_frame
                         ? fmt::format("Keys move the goal of {} '{}'",
                                       goals.frame->kind == ik::FrameKind::kSite   ? "site"
                                       : goals.frame->kind == ik::FrameKind::kBody ? "body"
                                                                                   : "geom",
                                       goals.frame->name)
                         : fmt::format("Keys drive robot '{}' as long as they are held", robot);
  add_motion(&text, goals, moves_frame);
  if (goals.gripper) add_row(&text, {"G", "triggers, A", "open or close the gripper"});
  if (goals.velocity && goals.frame)
    add_row(&text, {"Tab", "Y", "switch between driving and moving the frame"});
  add_row(&text, {"1 ... 9  + -", "bumpers", "speed"});
  add_row(&text, {"Space", "B", "stop"});
  add_row(&text, {"H", "", "this help"});
  add_row(&text, {"Esc  Ctrl-C", "", "end the run"});
  return text;
}

}  // namespace gloam::teleop
