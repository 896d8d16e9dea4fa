#pragma once
// Model fields that change while the simulation runs: the closed list LiveFieldId. The simulation
// and every PoseSolver that needs it write them into private copies of the model by the same code.

#include <memory>
#include <span>

#include "gloam/command.h"
#include "gloam/result.h"
#include "sim/snapshots/snapshot.h"
#include "world/world.h"

namespace gloam {

/// Values that a field may have, and their unit.
struct LiveFieldRange {
  double low, high;
  const char* unit;
};
LiveFieldRange live_field_range(LiveFieldId field);
/// Number of values of a field.
int live_field_size(const mjModel& model, LiveFieldId field);
/// The field as it stands in a model.
std::vector<double> read_live_field(const mjModel& model, LiveFieldId field);
/// The field at an instant: from `live` where it was changed, else from the World's model.
/// T: double, or float for what is drawn.
template <class T>
void live_field_at(const mjModel& model, const LiveFields* live, LiveFieldId field,
                   std::vector<T>* values);
/// Whether MuJoCo derives other values of the model from this field (mj_setConst).
bool derives_constants(LiveFieldId field);

/// Refuses a range outside the field and values that physics or light cannot take.
Status check_live_field(const mjModel& model, const SetLiveField& change);

/// `current` (null = nothing changed yet) with one more change, the `serial`-th of its simulation.
/// `change` has passed check_live_field.
std::shared_ptr<const LiveFields> change_live_field(const mjModel& world_model,
                                                    const LiveFields* current,
                                                    const SetLiveField& change, uint64_t serial);

/// Hash of the version number and of all changed values.
uint64_t live_fields_digest(const LiveFields& live);

/// Gives `model`, which refers to another model's arrays, an array of its own for this field, in
/// `storage`. Not for a field that derives_constants().
void own_live_field(LiveFieldId field, mjModel& model, std::vector<std::byte>* storage);

/// Writes one field into `model`, a private copy of `world_model`, or one that owns the field. New
/// masses scale the inertias. A field that derives_constants() calls mj_setConst, which needs
/// `scratch`, a mjData of the model whose content is lost. Errors: what MuJoCo says of the
/// new values.
Status write_live_field(const mjModel& world_model, LiveFieldId field,
                        std::span<const double> values, mjModel& model, mjData* scratch);

}  // namespace gloam
