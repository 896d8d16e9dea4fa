#pragma once
// The studio: light, sky and a floor for models that bring none, so that a robot is seen at first
// sight. Colour pictures alone show it; physics, exact channels, LiDARs, hashes and exports know
// nothing of it. docs/light.md tells the rule.

#include <span>

#include "gloam/scene.h"
#include "world/render_description.h"
#include "world/shapes/drawn_points.h"

namespace gloam {

/// True if the studio lights the scene: `look` says so, or is "auto" and the model has no lamp but
/// the headlight and no sky.
bool needs_studio(const Scene& scene, const RenderDescription& description);

/// Puts the studio around `subject`, seen by the free camera at X_WC, in place of the headlight:
/// a soft sky, a key light from above the camera's left, and where the model has no floor of its
/// own, one at the subject's lowest point that fades into the sky. Sets the exposure by the
/// reflectances that the camera sees of the subject.
void add_studio(std::span<const DrawnPart> subject, std::span<const DrawnPart> all,
                const Affine3f& X_WC, RenderDescription* out);

/// Lowers the EV100 of a model with lights of its own, which is fitted to white surfaces, so that a
/// dark subject is seen. It is never raised.
void open_exposure(std::span<const DrawnPart> subject, const Affine3f& X_WC,
                   RenderDescription* out);

}  // namespace gloam
