#pragma once
// Table of the meanings of the numbers in segmentation: of a simulation, a recording, stills.

#include "record/recorder.h"
#include "world/render_description.h"

namespace gloam {

struct LabelTableRows {
  std::vector<LabelRow> rows;
  std::vector<LabelIds> ids;  ///< MuJoCo's, of each row
};

/// A row for each instance that pictures with ids show.
LabelTableRows label_rows(const RenderDescription& description);

}  // namespace gloam
