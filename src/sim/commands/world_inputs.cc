// gloam::World::inputs: what robots and bodies can be told, and the live fields of the model.

#include "gloam/world.h"
#include "sim/commands/live_fields.h"
#include "world/streams.h"

namespace gloam {

std::vector<InputInfo> World::inputs() const {
  std::vector<InputInfo> inputs = list_inputs(*compiled_);
  for (int i = 0; i < kLiveFieldCount; ++i) {
    const auto field = static_cast<LiveFieldId>(i);
    const LiveFieldRange range = live_field_range(field);
    const int count = live_field_size(*compiled_->model, field);
    if (count > 0)
      inputs.push_back({.kind = InputKind::kLiveField,
                        .name = live_field_name(field),
                        .count = count,
                        .low = {range.low},
                        .high = {range.high},
                        .unit = range.unit});
  }
  return inputs;
}

Result<std::vector<double>> World::live_field(const std::string& name) const {
  GLOAM_TRY(const LiveFieldId field, find_live_field(name));
  return read_live_field(*compiled_->model, field);
}

}  // namespace gloam
