// Parts of a model that its pictures do not show.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "gloam/world.h"
#include "world/model_names.h"
#include "world/render_description.h"
#include "world/shapes/tendon_path.h"
#include "world/shapes/visual_site.h"
#include "world/world.h"

namespace gloam {
namespace {

std::string source_of(const Scene& scene, const std::string& name) {
  for (const RobotOptions& robot : scene.robots)
    if (name.starts_with(robot.name + "/")) return robot.file.string();
  if (!scene.bare_model.empty()) return scene.bare_model.string();
  return (scene.environment.file.empty() ? scene.file : scene.environment.file).string();
}

// Colliders that an [[object]] is given: its mesh is drawn for them.
bool stands_for_an_object(const Scene& scene, const std::string& geom) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const ObjectOptions& object) {
    return geom.starts_with(object.name + "/collider_");
  });
}

int line_in(const std::vector<int>& lines, int id) {
  return static_cast<size_t>(id) < lines.size() ? lines[static_cast<size_t>(id)] : 0;
}

// Elements of one kind in one file, that one cause hides.
struct HiddenElements {
  std::string what;  // "geom"
  std::string why;   // "", "for which visuals are drawn"
  int count = 0;
  SourceLoc first;
  std::set<int> groups;
};

class HiddenTable {
 public:
  explicit HiddenTable(const CompiledWorld& world) : world_(world) {}

  void add(const char* what, const char* why, const std::string& owner, int line, int group) {
    const std::string file = source_of(world_.scene, owner);
    HiddenElements& hidden = table_[{file, what, why}];
    hidden.what = what;
    hidden.why = why;
    ++hidden.count;
    hidden.groups.insert(group);
    const bool is_earlier = hidden.first.line == 0 || (line > 0 && line < hidden.first.line);
    if (is_earlier) hidden.first = {file, line, 0};
  }

  std::vector<Error> errors() const {
    std::vector<Error> out;
    for (const auto& [key, hidden] : table_) {
      const bool is_site = hidden.what == "site";
      std::string groups;
      for (const int group : hidden.groups)
        groups += fmt::format("{}{}", groups.empty() ? "" : ", ", group);
      out.push_back({ErrorKind::kInput,
                     fmt::format("{} {}{} of group{} {} {} not drawn{}", hidden.count, hidden.what,
                                 hidden.count == 1 ? "" : "s", hidden.groups.size() == 1 ? "" : "s",
                                 groups, hidden.count == 1 ? "is" : "are", hidden.why),
                     hidden.first, hint_of(hidden, is_site)});
    }
    return out;
  }

 private:
  std::string hint_of(const HiddenElements& hidden, bool is_site) const {
    std::set<int> groups = hidden.groups;
    for (int group = 0; group < kFirstHiddenGroup; ++group) groups.insert(group);
    std::string list;
    for (const int group : groups) list += fmt::format("{}{}", list.empty() ? "" : ",", group);
    const bool beyond = *hidden.groups.rbegin() >= kFirstHiddenGroup;
    std::string flags = is_site ? "--sites" : "";
    if (beyond || !is_site) flags += fmt::format("{}--groups {}", flags.empty() ? "" : " ", list);
    return fmt::format("use {} to show {}, or in a scene [render] {}", flags,
                       hidden.count == 1 ? "it" : "them",
                       is_site && !beyond ? "sites = true"
                       : is_site          ? fmt::format("sites = true, groups = [{}]", list)
                                          : fmt::format("groups = [{}]", list));
  }

  const CompiledWorld& world_;
  std::map<std::tuple<std::string, std::string, std::string>, HiddenElements> table_;
};

}  // namespace

NotDrawn World::not_drawn() const {
  const CompiledWorld& world = *compiled_;
  const mjModel& m = *world.model;
  NotDrawn out;
  const Result<RenderDescription> described = describe_for_rendering(world);
  if (!described.ok()) {
    out.lacking.push_back(described.error());
    return out;
  }
  out.lacking = described->unsupported;
  HiddenTable hidden(world);
  for (const InstanceDescription& instance : described->instances) {
    const int g = instance.geom;
    if (instance.shown || g < 0) continue;
    if (stands_for_an_object(world.scene, name_of(m, mjOBJ_GEOM, g))) continue;
    const bool stands_back = draws_group(world.scene.render, instance.group);
    hidden.add("geom", stands_back ? ": visuals are drawn instead" : "",
               name_of(m, mjOBJ_BODY, m.geom_bodyid[g]), line_in(world.lines.geoms, g),
               instance.group);
  }
  for (int i = 0; i < static_cast<int>(m.nsite); ++i) {
    const bool drawn = world.scene.render.sites && draws_group(world.scene.render, m.site_group[i]);
    if (!drawn)
      hidden.add("site", "", name_of(m, mjOBJ_BODY, m.site_bodyid[i]),
                 line_in(world.lines.sites, i), m.site_group[i]);
  }
  for (int i = 0; i < static_cast<int>(m.ntendon); ++i) {
    if (tendon_segments(m, i) == 0 || draws_group(world.scene.render, m.tendon_group[i])) continue;
    hidden.add("tendon", "", name_of(m, mjOBJ_TENDON, i), line_in(world.lines.tendons, i),
               m.tendon_group[i]);
  }
  out.hidden = hidden.errors();
  return out;
}

}  // namespace gloam
