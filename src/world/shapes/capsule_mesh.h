#pragma once
// Capsules of triangles, for what bends as it moves: tendons and one-dimensional flexes are chains
// of them.

#include <array>
#include <cstdint>
#include <vector>

namespace gloam {

inline constexpr int kCapsuleVertices = 50;

/// Writes the 3 x kCapsuleVertices coordinates of a capsule from `a` to `b` [m]; its sections are
/// regular polygons of the circle's area. With a radius of zero it is a point that no ray hits.
void place_capsule(const double* a, const double* b, double radius, float* vertices);

/// Appends the triangles of `count` capsules whose vertices follow each other from 0.
void append_capsule_triangles(int count, std::vector<uint32_t>* indices);

}  // namespace gloam
