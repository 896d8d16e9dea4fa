#pragma once
// The order of surfaces that move beside a World's model: waters, then beds of soil. Their vertices
// follow those of the model's own deformables (world/shapes/deformable_layout.h) in this order.

#include <cstddef>

namespace gloam {

struct CompiledWorld;

/// Row of a water, of a bed of soil, among all surfaces.
size_t water_surface(const CompiledWorld& world, size_t water);
size_t soil_surface(const CompiledWorld& world, size_t soil);
size_t surface_count(const CompiledWorld& world);

/// Indices of the first vertex of the first water and of the first bed.
int first_water_vertex(const CompiledWorld& world);
int first_soil_vertex(const CompiledWorld& world);

}  // namespace gloam
