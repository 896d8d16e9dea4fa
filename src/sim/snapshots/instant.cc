// gloam::Instant: a forward pass of MuJoCo's at a Snapshot, on the caller's thread.

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "base/memory.h"
#include "scene/files/mujoco_guard.h"
#include "sim/agents/body_contact.h"
#include "sim/commands/live_fields.h"
#include "sim/commands/model_fields.h"
#include "sim/effects/wind/air_drag.h"
#include "sim/effects/wind/wind.h"
#include "sim/loop/step_halves.h"
#include "sim/loop/step_schedule.h"
#include "sim/loop/stepper.h"
#include "sim/snapshots/snapshot.h"
#include "sim/state/state_layout.h"
#include "world/model_memory.h"

namespace gloam {
namespace {

Vec3 vec3(const mjtNum* v) { return {v[0], v[1], v[2]}; }

}  // namespace

struct Instant::Solved {
  std::shared_ptr<const CompiledWorld> world;
  mjModel model{};     // options of its own; its arrays are the World's, or own_model's
  ModelPtr own_model;  // once live fields have changed
  uint64_t live_serial = 0;
  DataPtr data, scratch;
  std::optional<WindOnBodies> wind;    // wind of steps as long as wind_timestep, if it blows
  std::optional<AirDrag> drag;         // none: MuJoCo's own
  std::optional<BodyContacts> people;  // where steps replace MuJoCo's contacts with people
  double wind_timestep = 0;
  std::vector<double> others;  // forces from outside but the drag [N, N m], (nv)
  bool good = false;           // the last forward pass was

  void begin(const SnapshotData& in);
  Status follow_live_fields(const SnapshotData& in);
  void make_wind(const SnapshotData& in);
  void blow(const SnapshotData& in);
  void add_contacts_and_drag();

  template <class Kind>
  Status check(Handle<Kind> handle, mjtSize count) const {
    if (!good) return Error{ErrorKind::kUsage, "no instant has been computed"};
    if (handle.world != 0 && handle.world != world->serial) {
      return Error{ErrorKind::kUsage,
                   "the handle belongs to another World, not to that of this instant",
                   {},
                   "look it up again in Snapshot::world(): a recompile creates a new World"};
    }
    if (handle.id < 0 || handle.id >= count)
      return Error{ErrorKind::kUsage,
                   fmt::format("the handle's number {} is out of range", handle.id)};
    return {};
  }
};

// Room for instants of another World than before.
void Instant::Solved::begin(const SnapshotData& in) {
  if (world == in.world) return;
  world.reset();  // until all of the new one is there
  own_model.reset();
  scratch.reset();
  live_serial = 0;
  wind.reset();
  drag.reset();
  people.reset();
  model = *in.world->model;
  if (has_halves(model)) people.emplace(*in.world, model);
  if (people && !people->any()) people.reset();
  if (in.world->wind.blows() && !has_own_drag(model)) drag.emplace(model);
  others.resize(static_cast<size_t>(model.nv));
  data = make_data(*in.world->model);
  world = in.world;
}

Status Instant::Solved::follow_live_fields(const SnapshotData& in) {
  const uint64_t serial = in.live != nullptr ? in.live->serial : 0;
  if (serial == live_serial) return {};
  if (own_model == nullptr) own_model = copy_model(*world->model);
  mjModel* copy = own_model.get();
  GLOAM_TRY_STATUS(guarded([&] { mj_copyModel(copy, world->model.get()); }));
  if (scratch == nullptr) scratch = make_data(*copy);
  for (int f = 0; in.live != nullptr && f < kLiveFieldCount; ++f) {
    const std::vector<double>& values = in.live->values[static_cast<size_t>(f)];
    if (values.empty()) continue;
    GLOAM_TRY_STATUS(
        write_live_field(*world->model, static_cast<LiveFieldId>(f), values, *copy, scratch.get()));
  }
  model = *copy;
  if (drag) drag->measure(model);
  live_serial = serial;
  return {};
}

// Outside of MuJoCo's guard, since it allocates.
void Instant::Solved::make_wind(const SnapshotData& in) {
  if (!world->wind.blows() || (wind && wind_timestep == in.timestep)) return;
  wind.emplace(*world, exact_rational(in.timestep));
  wind_timestep = in.timestep;
}

// As Stepper::blow().
void Instant::Solved::blow(const SnapshotData& in) {
  const auto field = static_cast<size_t>(LiveFieldId::kWind);
  if (!world->wind.blows()) return;
  if (!drag) give_air(&model.opt);
  if (in.live != nullptr && !in.live->values[field].empty()) return;
  wind->blow(in.step, data->qpos, &model.opt);
}

// Solves for accelerations and contact forces again, with the springs of people in place of
// MuJoCo's contacts and with the drag of the wind among the applied forces, as Stepper does.
void Instant::Solved::add_contacts_and_drag() {
  if (!drag && !people) return;
  std::copy_n(data->qfrc_applied, model.nv, others.begin());
  if (people) people->soften(model, data.get());
  if (drag) drag->push(model, *data);
  mj_forwardSkip(&model, data.get(), mjSTAGE_VEL, 0);
  std::copy(others.begin(), others.end(), data->qfrc_applied);
}

Instant::Instant() : solved_(std::make_unique<Solved>()) {}
Instant::~Instant() = default;
Instant::Instant(Instant&&) noexcept = default;
Instant& Instant::operator=(Instant&&) noexcept = default;

Status Instant::solve(const Snapshot& snapshot) {
  const SnapshotData& in = snapshot.data();
  Solved& s = *solved_;
  s.good = false;
  GLOAM_TRY_STATUS(or_no_memory("the instant", [&]() -> Status {
    s.begin(in);
    s.make_wind(in);
    return s.follow_live_fields(in);
  }));
  s.model.opt.timestep = in.timestep;
  s.model.opt.enableflags &= ~mjENBL_SLEEP;  // sleeping bodies would be left out
  const mjModel* model = &s.model;
  mjData* data = s.data.get();
  GLOAM_TRY_STATUS(guarded([&] {
    mj_setState(model, data, in.state.data(), mjSTATE_INTEGRATION);
    s.blow(in);
    set_applied_controls(in.actuators, *in.world->model, &s.model, data);
    mj_forward(model, data);
    s.add_contacts_and_drag();
    if (!in.actuators.empty())
      std::ranges::copy(state_part(*model, in.state, mjSTATE_CTRL), data->ctrl);  // commanded
    // Quantities that a forward pass computes only if a sensor asks for them.
    mj_energyPos(model, data);
    mj_energyVel(model, data);
    mj_subtreeVel(model, data);
    mj_rnePostConstraint(model, data);
  }));
  s.good = true;
  return {};
}

Result<BodyState> Instant::body(Body body) const {
  const Solved& s = *solved_;
  GLOAM_TRY_STATUS(s.check(body, s.model.nbody));
  const mjData& d = *s.data;
  const int id = body.id;
  const mjtNum* q = d.xquat + 4 * id;
  mjtNum velocity[6];  // angular, linear
  mj_objectVelocity(&s.model, &d, mjOBJ_XBODY, id, velocity, 0);
  BodyState state;
  state.X_WB = {vec3(d.xpos + 3 * id), {q[0], q[1], q[2], q[3]}};
  state.velocity = vec3(velocity + 3);
  state.angular_velocity = vec3(velocity);
  state.external_force = vec3(d.xfrc_applied + 6 * id);
  state.external_torque = vec3(d.xfrc_applied + 6 * id + 3);
  return state;
}

Result<TendonState> Instant::tendon(Tendon tendon) const {
  const Solved& s = *solved_;
  GLOAM_TRY_STATUS(s.check(tendon, s.model.ntendon));
  return TendonState{s.data->ten_length[tendon.id], s.data->ten_velocity[tendon.id]};
}

Result<double> Instant::force(Actuator actuator) const {
  const Solved& s = *solved_;
  GLOAM_TRY_STATUS(s.check(actuator, s.model.nactuator));
  return s.data->actuator_force[s.model.actuator_outadr[actuator.id]];
}

std::vector<ContactState> Instant::contacts() const {
  std::vector<ContactState> list;
  contacts(&list);
  return list;
}

void Instant::contacts(std::vector<ContactState>* contacts) const {
  const Solved& s = *solved_;
  contacts->clear();
  if (!s.good) return;
  for (int i = 0; i < s.data->ncon; ++i) {
    const mjContact& from = s.data->contact[i];
    mjtNum in_frame[6], force[3], torque[3];
    mj_contactForce(&s.model, s.data.get(), i, in_frame);
    mju_mulMatTVec3(force, from.frame, in_frame);  // the frame's rows are its axes
    mju_mulMatTVec3(torque, from.frame, in_frame + 3);
    ContactState contact;
    for (int side = 0; side < 2; ++side) contact.geoms[side] = {from.geom[side], s.world->serial};
    contact.position = vec3(from.pos);
    contact.normal = vec3(from.frame);
    contact.tangents[0] = vec3(from.frame + 3);
    contact.tangents[1] = vec3(from.frame + 6);
    contact.distance = from.dist;
    contact.friction = from.friction[0];
    contact.force = vec3(force);
    contact.torque = vec3(torque);
    contacts->push_back(contact);
  }
}

const mjModel* Instant::model() const { return &solved_->model; }
const mjData* Instant::data() const { return solved_->data.get(); }

Result<std::vector<double>> Instant::value(const std::string& field,
                                           const std::string& element) const {
  if (!solved_->good) return Error{ErrorKind::kUsage, "no instant has been computed"};
  return read_field(solved_->model, *solved_->data, field, element);
}

}  // namespace gloam
