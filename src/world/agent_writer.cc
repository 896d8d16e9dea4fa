#include "world/agent_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scene/spec_geom.h"
#include "world/agent_description.h"
#include "world/person_skin.h"

namespace gloam {
namespace {

constexpr double kLeastLeaf = 0.7;  // half the height of a door leaf at least [m]

void name_element(mjsElement* element, const std::string& name) {
  mjs_setName(element, name.c_str());
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
    for (int part = 0; part < agent_.parts(); ++part) {
      const std::string name = agent_.body_name(part);
      if (mjs_findBody(spec_, name.c_str()) != nullptr) {
        return Error{
            ErrorKind::kInput,
            fmt::format("agent '{}': the environment has a body '{}' already", agent_.name, name),
            agent_.loc, "rename the agent"};
      }
      mjsBody* body = mjs_addBody(mjs_findBody(spec_, "world"), nullptr);
      name_element(body->element, name);
      body->mocap = 1;
      const double p[3] = {agent_.position.x, agent_.position.y, agent_.position.z};
      std::copy(p, p + 3, body->pos);
      bodies_.push_back(body);
      for (const std::string& leaf : leaves) {
        mjsExclude* exclude = mjs_addExclude(spec_);
        mjs_setString(exclude->bodyname1, leaf.c_str());
        mjs_setString(exclude->bodyname2, name.c_str());
      }
    }
    if (agent_.kind == AgentKind::kPerson) {
      write_person();
      add_person_skins(agent_, spec_);
    } else {
      write_vehicle();
    }
    return {};
  }

 private:
  mjsGeom* add_geom(int part, mjtGeom type) {
    mjsGeom* geom = add_collider_geom(
        bodies_[static_cast<size_t>(part)],
        fmt::format("{}/{}_{}", agent_.name, part_name(agent_.kind, part), ++geoms_));
    geom->type = type;
    geom->contype = geom->conaffinity = 1;  // whatever the environment's defaults are
    return geom;
  }

  // From a to b, in the frame of the part.
  void add_capsule(int part, double radius, const Vec3& a, const Vec3& b) {
    mjsGeom* geom = add_geom(part, mjGEOM_CAPSULE);
    geom->size[0] = radius;
    const double fromto[6] = {a.x, a.y, a.z, b.x, b.y, b.z};
    std::copy(fromto, fromto + 6, geom->fromto);
  }

  void add_box(int part, const Vec3& centre, const Vec3& edges) {
    mjsGeom* geom = add_geom(part, mjGEOM_BOX);
    const double size[3] = {edges.x / 2, edges.y / 2, edges.z / 2};
    const double p[3] = {centre.x, centre.y, centre.z};
    std::copy(size, size + 3, geom->size);
    std::copy(p, p + 3, geom->pos);
  }

  // Trunk, head, legs; hips, head and feet belong to the parts next to them, and arms touch
  // nothing: each body that can collide costs every step of physics. Thicknesses: shares of the
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

  mjsGeom* show(int part, mjtGeom type, const char* material) {
    mjsGeom* geom = mjs_addGeom(bodies_[static_cast<size_t>(part)], nullptr);
    name_element(geom->element, fmt::format("{}/{}_{}_{}", agent_.name,
                                            part_name(agent_.kind, part), material, ++geoms_));
    geom->type = type;
    geom->contype = geom->conaffinity = 0;
    geom->group = kVisualGroup;
    geom->mass = 0;
    mjs_setString(geom->material, fmt::format("{}/{}", agent_.name, material).c_str());
    return geom;
  }

  void show_box(int part, const char* material, const Vec3& centre, const Vec3& edges) {
    mjsGeom* geom = show(part, mjGEOM_BOX, material);
    const double size[3] = {edges.x / 2, edges.y / 2, edges.z / 2};
    const double p[3] = {centre.x, centre.y, centre.z};
    std::copy(size, size + 3, geom->size);
    std::copy(p, p + 3, geom->pos);
  }

  void show_bar(int part, const char* material, double radius, const Vec3& a, const Vec3& b) {
    mjsGeom* geom = show(part, mjGEOM_CAPSULE, material);
    geom->size[0] = radius;
    const double fromto[6] = {a.x, a.y, a.z, b.x, b.y, b.z};
    std::copy(fromto, fromto + 6, geom->fromto);
  }

  void add_material(const char* what, const std::array<float, 3>& color, float roughness,
                    float metallic = 0) {
    mjsMaterial* material = mjs_addMaterial(spec_, nullptr);
    name_element(material->element, fmt::format("{}/{}", agent_.name, what));
    std::copy(color.begin(), color.end(), material->rgba);
    material->roughness = roughness;
    material->metallic = metallic;
  }

  // The axle is along y.
  void add_wheel(int part) {
    const VehicleShape& s = agent_.vehicle;
    const auto shape = [&](mjsGeom* geom, double radius, double width) {
      geom->size[0] = radius;
      geom->size[1] = width / 2;
      const double lying[4] = {M_SQRT1_2, M_SQRT1_2, 0, 0};
      std::copy(lying, lying + 4, geom->quat);
    };
    shape(add_geom(part, mjGEOM_CYLINDER), s.wheel_radius, s.wheel_width);
    shape(show(part, mjGEOM_CYLINDER, "tyre"), s.wheel_radius, s.wheel_width);
    shape(show(part, mjGEOM_CYLINDER, "metal"), 0.55 * s.wheel_radius, 1.04 * s.wheel_width);
    for (const double angle : {0.0, M_PI / 2})  // spokes, so that one sees it turn
      show_box(part, "tyre", {},
               {0.9 * s.wheel_radius * std::cos(angle) + 0.01, 1.06 * s.wheel_width,
                0.9 * s.wheel_radius * std::sin(angle) + 0.01});
  }

  void write_vehicle() {
    constexpr std::array<float, 3> kPaints[] = {
        {0.85f, 0.52f, 0.08f}, {0.70f, 0.12f, 0.10f}, {0.12f, 0.26f, 0.52f}, {0.80f, 0.80f, 0.78f}};
    add_material("paint", kPaints[agent_.seed % std::size(kPaints)], 0.35f);
    add_material("tyre", {0.07f, 0.07f, 0.07f}, 0.9f);
    add_material("metal", {0.55f, 0.55f, 0.56f}, 0.4f, 1);
    add_material("dark", {0.12f, 0.12f, 0.13f}, 0.5f);
    for (int part = kWheelFL; part <= kWheelRR; ++part) add_wheel(part);
    switch (agent_.kind) {
      case AgentKind::kForklift:
        write_forklift();
        break;
      case AgentKind::kCar:
        write_car();
        break;
      default:
        write_cart();
    }
  }

  void write_forklift() {
    const VehicleShape& s = agent_.vehicle;
    const double w = s.width, top = s.height;
    add_box(kChassis, {-0.25, 0, 0.62}, {s.length - 0.5, w, 0.8});
    add_box(kChassis, {0.65, 0, top / 2 + 0.05}, {0.2, 0.7, top - 0.1});  // mast
    add_box(kChassis, {-0.25, 0, top - 0.05}, {1.1, w - 0.1, 0.1});       // roof
    show_box(kChassis, "paint", {-0.15, 0, 0.5}, {1.4, 0.68, 0.55});
    show_box(kChassis, "paint", {-0.35, 0, 0.72}, {0.9, w - 0.06, 0.28});
    show_box(kChassis, "dark", {-0.92, 0, 0.6}, {0.26, w, 0.72});  // counterweight
    show_box(kChassis, "dark", {-0.3, 0, 0.95}, {0.45, 0.45, 0.14});
    show_box(kChassis, "dark", {-0.52, 0, 1.22}, {0.1, 0.45, 0.45});
    show_bar(kChassis, "dark", 0.02, {0.25, 0, 0.85}, {0.1, 0, 1.12});
    for (const double y : {-0.46, 0.46}) {
      show_bar(kChassis, "dark", 0.03, {0.42, y, 0.7}, {0.2, y, top - 0.06});
      show_bar(kChassis, "dark", 0.03, {-0.8, y, 0.9}, {-0.72, y, top - 0.06});
      show_box(kChassis, "dark", {0.65, 0.62 * y, top / 2 + 0.03}, {0.12, 0.08, top - 0.06});
    }
    for (int bar = 0; bar < 6; ++bar)
      show_box(kChassis, "dark", {-0.72 + 0.184 * bar, 0, top - 0.05}, {0.04, 0.96, 0.04});
    show_box(kFork, "metal", {0.76, 0, 0.22}, {0.05, 0.8, 0.34});  // carriage
    for (const double side : {-0.25, 0.25}) {
      add_box(kFork, {1.25, side, 0.02}, {1.0, 0.12, 0.04});
      show_box(kFork, "metal", {1.27, side, 0.02}, {1.0, 0.1, 0.035});
      show_box(kFork, "metal", {0.79, side, 0.2}, {0.04, 0.1, 0.4});
    }
  }

  void write_car() {
    const VehicleShape& s = agent_.vehicle;
    add_box(kChassis, {0, 0, 0.55}, {s.length, s.width, 0.7});
    add_box(kChassis, {-0.25, 0, 0.9 + (s.height - 0.9) / 2},
            {0.55 * s.length, 0.85 * s.width, s.height - 0.9});
    const double roof = s.height - 0.02;
    show_box(kChassis, "paint", {0, 0, 0.58}, {s.length, s.width - 0.06, 0.46});
    show_box(kChassis, "dark", {0, 0, 0.3}, {s.length - 0.1, s.width - 0.2, 0.16});
    show_box(kChassis, "dark", {-0.3, 0, 1.05}, {2.1, s.width - 0.24, 0.5});  // windows
    show_box(kChassis, "paint", {-0.4, 0, roof - 0.05}, {1.6, s.width - 0.28, 0.1});
    for (const double y : {-0.68, 0.68})
      for (const double x : {0.72, -0.3, -1.3})
        show_bar(kChassis, "paint", 0.035, {x, y, 0.82}, {x * 0.62 - 0.1, y * 0.96, roof - 0.06});
  }

  // A deck on wheels, with a bar to push it by.
  void write_cart() {
    const VehicleShape& s = agent_.vehicle;
    const double back = -s.length / 2 + 0.04, deck = 2 * s.wheel_radius + 0.03;
    add_box(kChassis, {0, 0, deck - 0.05}, {s.length, s.width, 0.14});
    add_box(kChassis, {back, 0, s.height / 2 + 0.1}, {0.05, s.width, s.height - 0.2});
    show_box(kChassis, "paint", {0, 0, deck}, {s.length, s.width, 0.05});
    show_box(kChassis, "dark", {0, 0, deck - 0.06}, {0.6 * s.length, 0.6 * s.width, 0.08});
    for (const double y : {-1.0, 1.0})
      show_bar(kChassis, "metal", 0.016, {back, 0.45 * y * s.width, deck},
               {back, 0.45 * y * s.width, s.height});
    for (const double z : {0.5 * s.height, s.height})
      show_bar(kChassis, "metal", 0.016, {back, -0.45 * s.width, z}, {back, 0.45 * s.width, z});
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
