#include "sim/state/state_transfer.h"

#include <set>

#include "sim/commands/live_fields.h"
#include "sim/state/state_layout.h"

namespace gloam {
namespace {

// Calls use(id before, id after) for all that remains.
template <class Use>
void for_each_pair(const std::vector<int>& matched, Use&& use) {
  for (size_t id = 0; id < matched.size(); ++id) {
    if (matched[id] >= 0) use(matched[id], static_cast<int>(id));
  }
}

// Arrays that elements of several kinds share, whose models say only where each part begins.
class Parts {
 public:
  explicit Parts(mjtSize end) : begins_{static_cast<int>(end)} {}
  void add(const int* addresses, mjtSize count) { begins_.insert(addresses, addresses + count); }
  int length(int address) const {
    return address < 0 ? 0 : *begins_.upper_bound(address) - address;
  }

 private:
  std::set<int> begins_;
};

Parts history_parts(const mjModel& m) {
  Parts parts(m.nhistory);
  parts.add(m.actuator_historyadr, m.nactuator);
  parts.add(m.sensor_historyadr, m.nsensor);
  return parts;
}

Parts plastic_parts(const mjModel& m) {
  Parts parts(m.nplastic);
  parts.add(m.jnt_plasticadr, m.njnt);
  parts.add(m.tendon_plasticadr, m.ntendon);
  parts.add(m.flex_plasticadr, m.nflex);
  return parts;
}

class Transfer {
 public:
  Transfer(const Correspondence& same, const mjData& before, mjData& after)
      : same_(same), b_(*same.before.model), a_(*same.after.model), from_(before), to_(after) {}

  void joints() const {
    for_each_pair(same_.joint, [&](int b, int a) {
      const int type = a_.jnt_type[a];
      if (b_.jnt_type[b] != type) return;
      const JointWidth width = joint_width(type);
      mju_copy(to_.qpos + a_.jnt_qposadr[a], from_.qpos + b_.jnt_qposadr[b], width.qpos);
      const int dof_b = b_.jnt_dofadr[b], dof_a = a_.jnt_dofadr[a];
      mju_copy(to_.qvel + dof_a, from_.qvel + dof_b, width.qvel);
      mju_copy(to_.qacc_warmstart + dof_a, from_.qacc_warmstart + dof_b, width.qvel);
      mju_copy(to_.qfrc_applied + dof_a, from_.qfrc_applied + dof_b, width.qvel);
    });
  }

  void actuators() const {
    for_each_pair(same_.actuator, [&](int b, int a) {
      copy_block(from_.ctrl, b_.actuator_ctrladr[b], b_.actuator_ctrlnum[b], to_.ctrl,
                 a_.actuator_ctrladr[a], a_.actuator_ctrlnum[a]);
      copy_block(from_.act, b_.actuator_actadr[b], b_.actuator_actnum[b], to_.act,
                 a_.actuator_actadr[a], a_.actuator_actnum[a]);
    });
  }

  void histories() const {
    const Shared shared{from_.history, history_parts(b_), to_.history, history_parts(a_)};
    copy_shared(shared, same_.actuator, b_.actuator_historyadr, a_.actuator_historyadr);
    copy_shared(shared, same_.sensor, b_.sensor_historyadr, a_.sensor_historyadr);
  }

  void plastic() const {
    const Shared shared{from_.plastic, plastic_parts(b_), to_.plastic, plastic_parts(a_)};
    copy_shared(shared, same_.joint, b_.jnt_plasticadr, a_.jnt_plasticadr);
    copy_shared(shared, same_.tendon, b_.tendon_plasticadr, a_.tendon_plasticadr);
    copy_shared(shared, same_.flex, b_.flex_plasticadr, a_.flex_plasticadr);
  }

  void bodies() const {
    for_each_pair(same_.body, [&](int b, int a) {
      mju_copy(to_.xfrc_applied + 6 * a, from_.xfrc_applied + 6 * b, 6);
      const int mocap_b = b_.body_mocapid[b], mocap_a = a_.body_mocapid[a];
      if (mocap_b < 0 || mocap_a < 0) return;
      mju_copy3(to_.mocap_pos + 3 * mocap_a, from_.mocap_pos + 3 * mocap_b);
      mju_copy4(to_.mocap_quat + 4 * mocap_a, from_.mocap_quat + 4 * mocap_b);
    });
  }

  void others() const {
    to_.time = from_.time;
    for_each_pair(same_.equality, [&](int b, int a) {
      if (b_.eq_type[b] == a_.eq_type[a]) to_.eq_active[a] = from_.eq_active[b];
    });
    for_each_pair(same_.plugin, [&](int b, int a) {
      if (b_.plugin[b] != a_.plugin[a]) return;
      copy_block(from_.plugin_state, b_.plugin_stateadr[b], b_.plugin_statenum[b], to_.plugin_state,
                 a_.plugin_stateadr[a], a_.plugin_statenum[a]);
    });
    if (b_.nuserdata == a_.nuserdata)
      mju_copy(to_.userdata, from_.userdata, static_cast<int>(a_.nuserdata));
  }

 private:
  // One array that elements of several kinds share, before and after.
  struct Shared {
    const mjtNum* from;
    Parts parts_b;
    mjtNum* to;
    Parts parts_a;
  };

  static void copy_shared(const Shared& shared, const std::vector<int>& matched, const int* adr_b,
                          const int* adr_a) {
    for_each_pair(matched, [&](int b, int a) {
      copy_block(shared.from, adr_b[b], shared.parts_b.length(adr_b[b]), shared.to, adr_a[a],
                 shared.parts_a.length(adr_a[a]));
    });
  }

  static void copy_block(const mjtNum* from, int adr_b, int count_b, mjtNum* to, int adr_a,
                         int count_a) {
    if (count_b == count_a && count_a > 0) mju_copy(to + adr_a, from + adr_b, count_a);
  }

  const Correspondence& same_;
  const mjModel &b_, &a_;
  const mjData& from_;
  mjData& to_;
};

}  // namespace

void transfer_state(const Correspondence& same, const mjData& before, mjData& after) {
  const Transfer transfer(same, before, after);
  transfer.joints();
  transfer.actuators();
  transfer.histories();
  transfer.plastic();
  transfer.bodies();
  transfer.others();
}

std::vector<SetLiveField> remaining_live_fields(const Correspondence& same,
                                                const LiveFields& live) {
  std::vector<SetLiveField> changes;
  for (int i = 0; i < kLiveFieldCount; ++i) {
    const auto field = static_cast<LiveFieldId>(i);
    const std::vector<double>& values = live.values[static_cast<size_t>(i)];
    if (values.empty()) continue;
    const std::vector<double> before = read_live_field(*same.before.model, field);
    std::vector<double> after = read_live_field(*same.after.model, field);
    bool any = false;
    const std::vector<int> places = same.live_values(field);
    for (size_t a = 0; a < places.size(); ++a) {
      const auto b = static_cast<size_t>(places[a]);
      if (places[a] < 0 || values[b] == before[b]) continue;
      after[a] = values[b];
      any = true;
    }
    if (any) changes.push_back({field, 0, std::move(after)});
  }
  return changes;
}

}  // namespace gloam
