#pragma once
#include "render/kernel/bsdf/bsdf.h"

namespace gloam {

/// Integrates the layer's directional albedo by a fixed point set: the same on every machine.
void fill_albedo_table(AlbedoTable* table);
void fill_glass_table(GlassTable* table);

}  // namespace gloam
