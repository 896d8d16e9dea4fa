#pragma once
// The surfaces of beds of soil as rows of the render description: meshes whose vertices sink where
// something stepped.

#include <span>
#include <vector>

#include "world/effects/soil_description.h"
#include "world/render_description.h"
#include "world/visual_label.h"

namespace gloam {

/// Vertices of a bed in PoseFrame::vertices; those of beds follow, in their order, all waters'.
int soil_vertices(const SoilDescription& soil);

/// Appends x, y, z of each at a time [s]. `tracks`: of each cell, for track_height(), empty = none.
void append_soil_vertices(const SoilDescription& soil, std::span<const float> tracks, double time,
                          std::vector<float>* out);

/// Appends a material and a deformable for each bed. `first_vertex`: of the first.
void author_soils(const std::vector<SoilDescription>& soils, int first_vertex, LabelTable* labels,
                  RenderDescription* out);

}  // namespace gloam
