#pragma once
// Measurements of a depth camera with two eyes and a pattern projector.
//
// The disparity d = f B / Z of a pixel gets normal noise and is rounded to the matcher's steps, so
// the depth's error grows with its square: sigma_Z = Z² / (f B) sigma_d (Khoshelham and Elberink
// 2012, "Accuracy and Resolution of Kinect Depth Data for Indoor Mapping Applications"; Keselman et
// al. 2017, "Intel RealSense Stereoscopic Depth Cameras").
//
// Lost are pixels beyond the range or the widest disparity; those that the second eye does not see
// (half-occlusion: in one row the images of points keep their order, except behind an edge); those
// near jumps in depth, where the matcher's window covers two surfaces; and by chance those that
// send little of the projector's light back. The signal is 1 for a white wall that faces the camera
// at 1 m: diffuse albedo, times the cosine, over Z²; what glass lets through and smooth metal
// mirrors away is lost. A share s² / (s² + half_signal²) of pixels of signal s has a depth.
//
// Media take their fraction of the projector's light on both ways, T², and send some back, which
// veils the pattern: with the signal b = pi Int beta T² / r² dr of what they scatter back (as a
// LiDAR's, render/kernel/lidar/lidar_media.h), from where the second eye's view meets the
// projector's beam on, the pattern's contrast is s T² / (s T² + b), and the signal that is left s
// T² times that. The band is the one nearest to projectors' 850 nm, of 905 nm.

#include <cstdint>
#include <vector>

#include "gloam/camera.h"
#include "gloam/scene/sensor.h"
#include "render/film/film.h"
#include "render/renderer.h"
#include "sensors/sensor_air.h"
#include "world/render_description.h"

namespace gloam {

/// StereoDepthOptions with nothing left out; 0 = off.
struct StereoDepthModel {
  double baseline = 0.05;  ///< [m]
  double subpixel = 0, noise = 0;
  double min_range = 0, max_range = 0;
  int max_disparity = 0;
  bool occlusion = false;
  int edge_loss = 0;
  double half_signal = 0;
};

/// Values of the table, else of its preset, else nothing. d435: Intel RealSense D400 series
/// (baseline 50 mm, 126 disparities, 1/32 px: white paper "Subpixel Linearity Improvement"; 0.08 px
/// of noise: the value that its makers advise, librealsense issue 3904). kinect: Khoshelham and
/// Elberink 2012 (75 mm, steps and noise of 1/8 and 1/16 px, 0.5 … 5 m). Their edge and signal
/// losses are estimates.
StereoDepthModel stereo_depth_model(const StereoDepthOptions& options);

/// Signal per pixel, (height x width), of exact channels: see above.
std::vector<float> projector_signal(const RenderDescription& description, const MediaView& media,
                                    const Film& film, const CameraView& view);

/// Depths [m] from true ones along the optical axis (+inf = nothing), (height x width); 0 =
/// nothing. A function of (seed, frame, depth, signal). `signal` may be empty where half_signal is
/// 0.
std::vector<float> measure_stereo_depth(const StereoDepthModel& model, const Intrinsics& intrinsics,
                                        const std::vector<float>& depth,
                                        const std::vector<float>& signal, uint64_t seed,
                                        int64_t frame);

}  // namespace gloam
