#pragma once
// Fields of mjSpec for which MJCF has no attribute: a document keeps them, and they are set in the
// model once MuJoCo has parsed the rest.

#include <mujoco/mujoco.h>

#include "gloam/mjcf.h"

namespace gloam {

/// The first attribute of `document` that XML has no place for, as an Error; or ok.
Status check_fits_xml(const mjcf::Element& element);

/// Sets in `spec`, parsed from `document`, what the parser could not read. Errors: an element
/// without a name, a number of values that the field does not have.
Status set_spec_only(const mjcf::Document& document, mjSpec* spec);

}  // namespace gloam
