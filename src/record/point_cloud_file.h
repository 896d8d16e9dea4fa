#pragma once
// LidarScans as files that others read: PCD 0.7 (PCL, CloudCompare), PLY (Open3D, MeshLab, Blender)
// and NPY (NumPy, a structured array), each binary and little-endian. Fields: x y z intensity ring
// time range column return_number, and, where the scan has them, part instance semantic.

#include <cstdint>
#include <string>
#include <vector>

#include "gloam/sensor.h"

namespace gloam {

std::vector<uint8_t> encode_pcd(const LidarScan& scan);
std::vector<uint8_t> encode_ply(const LidarScan& scan);
std::vector<uint8_t> encode_npy(const LidarScan& scan);

}  // namespace gloam
