#include "world/compile/agent_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "places/writer/spec_edit.h"
#include "places/writer/spec_geom.h"
#include "world/agents/agent_description.h"
#include "world/agents/person_skin.h"

namespace gloam {
namespace {

constexpr double kLeastLeaf = 0.7;  // half the height of a door leaf at least [m]

void name_element(mjsElement* element, const std::string& name) {
  edit(mjs_setName, element, name.c_str());
}

// Environments' bodies that turn about the vertical and are as high as a door.
std::vector<std::string> find_leaves(mjSpec* spec) {
  std::vector<std::string> leaves;
  for (mjsElement* e = mjs_firstElement(spec, mjOBJ_JOINT); e != nullptr;
       e = mjs_nextElement(spec, e)) {
    const mjsJoint* joint = mjs_asJoint(e);
    if (joint->type != mjJNT_HINGE || std::abs(joint->axis[2]) < 0.99) continue;
    mjsBody* body = mjs_getParent(e);
    bool is_high = false;
    for (mjsElement* g = mjs_firstChild(body, mjOBJ_GEOM, 0); g != nullptr;
         g = mjs_nextChild(body, g, 0)) {
      const mjsGeom* geom = mjs_asGeom(g);
      is_high |= geom->type == mjGEOM_BOX && geom->size[2] >= kLeastLeaf;
    }
    const std::string name = mjs_getString(mjs_getName(body->element));
    if (is_high && !name.empty()) leaves.push_back(name);
  }
  return leaves;
}

class AgentWriter {
 public:
  AgentWriter(const AgentDescription& agent, mjSpec* spec) : agent_(agent), spec_(spec) {}

  Status write(const std::vector<std::string>& leaves) {
    if (agent_.kind == AgentKind::kPerson) GLOAM_TRY_STATUS(add_bodies());
    for (int part = 0; part < agent_.parts(); ++part) {
      for (const std::string& leaf : leaves) {
        mjsExclude* exclude = edit(mjs_addExclude, spec_);
        edit(mjs_setString, exclude->bodyname1, leaf.c_str());
        edit(mjs_setString, exclude->bodyname2, agent_.body_name(part).c_str());
      }
    }
    if (agent_.kind == AgentKind::kPerson) {
      write_person();
      add_person_skins(agent_, spec_);
    }
    return {};
  }

 private:
  Status add_bodies() {
    for (int part = 0; part < agent_.parts(); ++part) {
      const std::string name = agent_.body_name(part);
      if (mjs_findBody(spec_, name.c_str()) != nullptr) {
        return Error{
            ErrorKind::kInput,
            fmt::format("agent '{}': the environment already has a body '{}'", agent_.name, name),
            agent_.loc, "rename the agent"};
      }
      mjsBody* body = edit(mjs_addBody, mjs_findBody(spec_, "world"), nullptr);
      name_element(body->element, name);
      body->mocap = 1;
      const double p[3] = {agent_.position.x, agent_.position.y, agent_.position.z};
      std::copy(p, p + 3, body->pos);
      bodies_.push_back(body);
    }
    return {};
  }

  mjsGeom* add_geom(int part, mjtGeom type) {
    mjsGeom* geom = add_collider_geom(
        bodies_[static_cast<size_t>(part)],
        fmt::format("{}/{}_{}", agent_.name, part_name(agent_.kind, part), ++geoms_),
        own_defaults());
    geom->type = type;
    return geom;
  }

  // From a to b, in the frame of the part.
  void add_capsule(int part, double radius, const Vec3& a, const Vec3& b) {
    mjsGeom* geom = add_geom(part, mjGEOM_CAPSULE);
    geom->size[0] = radius;
    const double fromto[6] = {a.x, a.y, a.z, b.x, b.y, b.z};
    std::copy(fromto, fromto + 6, geom->fromto);
  }

  // Trunk, head, legs; hips, head and feet belong to the parts next to them, and arms touch
  // nothing: each body that can collide costs every step of physics. Thicknesses: fractions of the
  // height, from breadths and depths in Pheasant and Haslegrave 2006.
  void write_person() {
    const PersonShape& s = agent_.person;
    const double g = s.height * s.girth;
    const double trunk = 0.068 * g, head = s.trunk + s.neck;
    add_capsule(kChest, trunk, {0, 0, -s.waist}, {0, 0, s.trunk - 0.03 * s.height});
    add_capsule(kChest, 0.05 * s.height, {0.01, 0, head + 0.045 * s.height},
                {0.01, 0, head + 0.085 * s.height});
    for (const int side : {0, 3}) {
      const double shank = 0.031 * g;
      add_capsule(kThighL + side, 0.043 * g, {0, 0, 0}, {0, 0, -s.thigh});
      add_capsule(kShankL + side, shank, {0, 0, 0}, {0, 0, -s.shank - s.ankle + shank});
    }
  }

  const AgentDescription& agent_;
  mjSpec* spec_;
  std::vector<mjsBody*> bodies_;
  int geoms_ = 0;
};

}  // namespace

Status add_agents(const Scene& scene, mjSpec* spec) {
  GLOAM_TRY(const std::vector<AgentDescription> agents, list_agents(scene));
  if (agents.empty()) return {};
  const std::vector<std::string> leaves = find_leaves(spec);
  for (const AgentDescription& agent : agents)
    GLOAM_TRY_STATUS(AgentWriter(agent, spec).write(leaves));
  return {};
}

}  // namespace gloam
