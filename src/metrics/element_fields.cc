#include "metrics/element_fields.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

using Reader = QuantityReader;

void copy3(const mjtNum* from, double* out) { std::copy_n(from, 3, out); }

// A column of a body's rotation matrix: its axis in the world.
void copy_axis(const MetricInstant& in, int body, int axis, double* out) {
  for (int i = 0; i < 3; ++i) out[i] = in.data->xmat[9 * body + 3 * i + axis];
}

void body_velocity(const MetricInstant& in, int body, int first, double* out) {
  mjtNum velocity[6];  // angular, linear
  mj_objectVelocity(in.model, in.data, mjOBJ_XBODY, body, velocity, 0);
  copy3(velocity + first, out);
}

const mjtNum* body_matrix(const MetricInstant& in, int body) { return in.data->xmat + 9 * body; }

constexpr ElementField kBodyFields[] = {
    {"position", 3,
     [](const MetricInstant& in, const Reader& r, double* out) {
       copy3(in.data->xpos + 3 * r.id, out);
     }},
    {"velocity", 3,
     [](const MetricInstant& in, const Reader& r, double* out) {
       body_velocity(in, r.id, 3, out);
     }},
    {"angular_velocity", 3,
     [](const MetricInstant& in, const Reader& r, double* out) {
       body_velocity(in, r.id, 0, out);
     }},
    {"center_of_mass", 3,
     [](const MetricInstant& in, const Reader& r, double* out) {
       copy3(in.data->subtree_com + 3 * r.id, out);
     }},
    {"forward", 3,
     [](const MetricInstant& in, const Reader& r, double* out) { copy_axis(in, r.id, 0, out); }},
    {"left", 3,
     [](const MetricInstant& in, const Reader& r, double* out) { copy_axis(in, r.id, 1, out); }},
    {"up", 3,
     [](const MetricInstant& in, const Reader& r, double* out) { copy_axis(in, r.id, 2, out); }},
    {"roll", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       const mjtNum* R = body_matrix(in, r.id);
       *out = std::atan2(R[7], R[8]);
     }},
    {"pitch", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = std::asin(std::clamp(-body_matrix(in, r.id)[6], -1.0, 1.0));
     }},
    {"yaw", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       const mjtNum* R = body_matrix(in, r.id);
       *out = std::atan2(R[3], R[0]);
     }},
    {"mass", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = in.model->body_subtreemass[r.id];
     }},
};

constexpr ElementField kJointFields[] = {
    {"position", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = in.data->qpos[in.model->jnt_qposadr[r.id]];
     }},
    {"velocity", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = in.data->qvel[in.model->jnt_dofadr[r.id]];
     }},
    {"acceleration", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = in.data->qacc[in.model->jnt_dofadr[r.id]];
     }},
    {"force", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = in.data->qfrc_actuator[in.model->jnt_dofadr[r.id]];
     }},
};

double force_of(const MetricInstant& in, int actuator) {
  return in.data->actuator_force[in.model->actuator_outadr[actuator]];
}
double velocity_of(const MetricInstant& in, int actuator) {
  return in.data->actuator_velocity[in.model->actuator_outadr[actuator]];
}

constexpr ElementField kActuatorFields[] = {
    {"control", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = in.data->ctrl[in.model->actuator_ctrladr[r.id]];
     }},
    {"force", 1,
     [](const MetricInstant& in, const Reader& r, double* out) { *out = force_of(in, r.id); }},
    {"velocity", 1,
     [](const MetricInstant& in, const Reader& r, double* out) { *out = velocity_of(in, r.id); }},
    {"length", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = in.data->actuator_length[in.model->actuator_outadr[r.id]];
     }},
    {"power", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = force_of(in, r.id) * velocity_of(in, r.id);
     }},
};

constexpr ElementField kSiteFields[] = {
    {"position", 3, [](const MetricInstant& in, const Reader& r, double* out) {
       copy3(in.data->site_xpos + 3 * r.id, out);
     }}};
constexpr ElementField kGeomFields[] = {
    {"position", 3, [](const MetricInstant& in, const Reader& r, double* out) {
       copy3(in.data->geom_xpos + 3 * r.id, out);
     }}};
constexpr ElementField kTendonFields[] = {
    {"length", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = in.data->ten_length[r.id];
     }},
    {"velocity", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = in.data->ten_velocity[r.id];
     }},
};

constexpr ElementKind kKinds[] = {
    {"body", mjOBJ_BODY, &mjModel::nbody, kBodyFields},
    {"joint", mjOBJ_JOINT, &mjModel::njnt, kJointFields},
    {"actuator", mjOBJ_ACTUATOR, &mjModel::nactuator, kActuatorFields},
    {"site", mjOBJ_SITE, &mjModel::nsite, kSiteFields},
    {"geom", mjOBJ_GEOM, &mjModel::ngeom, kGeomFields},
    {"tendon", mjOBJ_TENDON, &mjModel::ntendon, kTendonFields},
};

constexpr ElementField kSceneNumbers[] = {
    {"time", 1,
     [](const MetricInstant& in, const Reader&, double* out) { *out = in.snapshot->time(); }},
    {"step", 1,
     [](const MetricInstant& in, const Reader&, double* out) {
       *out = static_cast<double>(in.snapshot->step());
     }},
    {"dt", 1,
     [](const MetricInstant& in, const Reader&, double* out) {
       *out = in.snapshot->data().timestep;
     }},
    {"kinetic_energy", 1,
     [](const MetricInstant& in, const Reader&, double* out) { *out = in.data->energy[1]; }},
    {"potential_energy", 1,
     [](const MetricInstant& in, const Reader&, double* out) { *out = in.data->energy[0]; }},
    {"gravity", 3,
     [](const MetricInstant& in, const Reader&, double* out) {
       copy3(in.model->opt.gravity, out);
     }},
};

template <class Visitor>
void visit_contacts(const MetricInstant& in, const Reader& r, Visitor visit) {
  for (const ContactState& contact : in.contacts) {
    if (contact.geoms[0].id < 0 || contact.geoms[1].id < 0) continue;
    const auto a = static_cast<size_t>(contact.geoms[0].id);
    const auto b = static_cast<size_t>(contact.geoms[1].id);
    const bool fits = (r.a[a] && r.b[b]) || (r.a[b] && r.b[a]);
    const Vec3& f = contact.force;
    if (fits) visit(contact, std::hypot(f.x, f.y, f.z));
  }
}

constexpr ElementField kContactFields[] = {
    {"count", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = 0;
       visit_contacts(in, r, [&](const ContactState&, double force) { *out += force > 0; });
     }},
    {"force", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = 0;
       visit_contacts(in, r, [&](const ContactState&, double force) { *out += force; });
     }},
    {"depth", 1,
     [](const MetricInstant& in, const Reader& r, double* out) {
       *out = 0;
       visit_contacts(in, r, [&](const ContactState& contact, double) {
         *out = std::max(*out, -contact.distance);
       });
     }},
};

}  // namespace

std::span<const ElementKind> element_kinds() { return kKinds; }
std::span<const ElementField> scene_numbers() { return kSceneNumbers; }
std::span<const ElementField> contact_fields() { return kContactFields; }
std::span<const ElementField> body_fields() { return kBodyFields; }

}  // namespace gloam
