#pragma once
// Object that a visible part belongs to, and its class.

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gloam/camera.h"
#include "world/world.h"

namespace gloam {

/// Class of an object from its name: the path before the last '/' and trailing digits, underscores,
/// dots, dashes and spaces are cut off ("kitchen/chair_3" is a "chair"); "object" when nothing is
/// left.
std::string semantic_class(std::string_view name);

/// Name of a body in tables: its own, or "body 3", which no other body has.
std::string body_label(const mjModel& model, int body);
/// Name of a geom in tables: its own, or "body 3 geom 7 (box)", which no other geom has.
std::string geom_label(const mjModel& model, int geom);

/// Hands out instance and semantic ids, from 1, in order of first use. An object is a robot, or a
/// body directly under the world with all below it, or one geom of the world body. Robots are those
/// of the scene; of a bare model, the trees that robot_roots() finds.
class LabelTable {
 public:
  explicit LabelTable(const CompiledWorld& world);

  /// Label without part and geom of something fixed to body `body`; `own_name` = its own name,
  /// which names the object if the body is the world. `kind`, `id` make world geoms distinct.
  LabelRow label(int body, const std::string& own_name, int kind, int id);
  bool is_robot(int body) const { return robot_of(body) >= 0; }

 private:
  int robot_of(int body) const;
  std::string robot_name(int robot) const;

  const CompiledWorld& world_;
  std::vector<int> bare_roots_;  // roots of a bare model's robots
  std::map<std::pair<int, int>, uint32_t> instances_;
  std::map<std::string, uint32_t> classes_;
};

}  // namespace gloam
