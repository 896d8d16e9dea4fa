#pragma once
// Strength of lamps: from the units of a scene to candela and cd/m². Angles in radians.

#include "gloam/scene.h"
#include "world/lights/ies_profile.h"
#include "world/render_description.h"

namespace gloam {

/// The lamp's hue: linear Rec. 709 of luminance 1, of its colour or of a black body of its
/// temperature; white when none is given.
Vec3f light_color(const LightOptions& light);

/// Luminous flux of a light of 1 cd [lm], a factor [sr]: of a point or spot light whose cone,
/// softness and type are set, with its profile's shape, or (null) even in all directions.
double solid_angle(const LightDescription& light, const IesProfile* profile);

/// Greatest intensity of a point or spot light [cd]. `light` as above. `profile`: as in the file.
double candela(const LightOptions& options, const LightDescription& light,
               const IesProfile* profile);

/// [cd/m²] of a rect, disk, sphere or mesh whose surface is `area` [m²], even in all directions.
double area_luminance(const LightOptions& options, double area);

}  // namespace gloam
