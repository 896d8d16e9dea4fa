#pragma once
// Checks that a [[probe]] has the keys that its quantity needs, and no others.

#include "gloam/scene.h"

namespace gloam {

Status validate_probe(const ProbeOptions& probe);

}  // namespace gloam
