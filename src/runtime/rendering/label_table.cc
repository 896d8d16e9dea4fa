#include "runtime/rendering/label_table.h"

namespace gloam {

LabelTableRows label_rows(const RenderDescription& description) {
  LabelTableRows table;
  for (const InstanceDescription& instance : description.instances) {
    if (instance.color_only) continue;
    table.rows.push_back(instance.label);
    table.ids.push_back({instance.geom, instance.body});
  }
  return table;
}

}  // namespace gloam
