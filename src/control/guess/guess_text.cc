#include "control/guess/guess_text.h"

#include <fmt/format.h>

#include <toml++/toml.h>

#include "gloam/text.h"
#include "scene/toml/value_reader.h"

namespace gloam {
namespace {

std::string quoted(const std::string& text) { return toml_text(toml::value<std::string>(text)); }

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + quoted(name);
  return "[" + text + "]";
}

std::string comment(const std::string& text) { return "# " + printable(text) + "\n"; }

std::string rate_text(const Rational& rate) {
  return rate.den == 1 ? std::to_string(rate.num) : fmt::format("\"{}/{}\"", rate.num, rate.den);
}

}  // namespace

std::string guess_text(const RobotOptions& options, const std::vector<std::string>& comments,
                       const GuessedController& controller) {
  std::string text;
  for (const std::string& line : comments) text += comment(line);
  text += fmt::format("[[robot]]\nname = {}\nfile = {}\n", quoted(options.name),
                      quoted(options.file.string()));
  if (!options.keyframe.empty()) text += fmt::format("keyframe = {}\n", quoted(options.keyframe));
  if (options.base != RobotOptions().base) text += fmt::format("base = {}\n", quoted(options.base));
  text += "\n";
  for (const std::string& line : controller.reasons) text += comment(line);
  if (controller.type != "none") {
    text += fmt::format("[robot.controller]\ntype = {}\n", quoted(controller.type));
    if (!(options.controller.rate == ControllerOptions().rate))
      text += fmt::format("rate = {}\n", rate_text(options.controller.rate));
  }
  const RobotJoints& joints = controller.joints;
  const std::pair<const char*, const std::vector<std::string>*> rows[] = {
      {"FL", &joints.front_left},
      {"FR", &joints.front_right},
      {"RL", &joints.rear_left},
      {"RR", &joints.rear_right},
      {"feet", &joints.feet}};
  std::string table;
  for (const auto& [role, names] : rows)
    if (!names->empty()) table += fmt::format("{} = {}\n", role, list_of(*names));
  if (!table.empty()) text += "\n[robot.joints]\n" + table;
  return text;
}

}  // namespace gloam
