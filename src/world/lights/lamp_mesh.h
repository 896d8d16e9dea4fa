#pragma once
// Shapes of lamps with an area, in the lamp's frame: they shine along -Z, to where their triangles
// are counter-clockwise.

#include <filesystem>

#include "geometry/mesh/mesh.h"
#include "gloam/result.h"

namespace gloam {

/// In the plane z = 0, `width` along x and `height` along y [m].
TriangleMesh rect_lamp(double width, double height);

/// In the plane z = 0: a fan of 64 triangles with the area of the disk, whose corners are therefore
/// 0.08 % outside of it, so that luminance and flux are both right.
TriangleMesh disk_lamp(double radius);

/// Everything in an OBJ, STL, PLY or glTF file as one mesh without normals; materials are left out.
/// Errors: those of read_model_file(), no triangles.
Result<TriangleMesh> read_lamp(const std::filesystem::path& path);

double area_of(const TriangleMesh& mesh);

}  // namespace gloam
