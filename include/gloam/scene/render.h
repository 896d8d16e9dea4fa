#pragma once
// [render]: rendering of images. Part of gloam/scene.h.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gloam/result.h"
#include "gloam/text.h"

namespace gloam {

/// Method of rendering (docs/light.md).
enum class RenderTier : uint8_t {
  kPath,         ///< unbiased path tracing
  kInteractive,  ///< direct light, cached indirect light, one specular bounce; filtered over images
  kDirect,       ///< primary hit, direct light with shadows, one ambient light by facing
};
template <>
struct EnumTable<RenderTier> {
  static constexpr const char* kNoun = "render tier";
  static constexpr auto kNames =
      std::to_array<EnumName<RenderTier>>({{RenderTier::kPath, "path"},
                                           {RenderTier::kInteractive, "interactive"},
                                           {RenderTier::kDirect, "direct"}});
};

/// Processor that renders.
enum class RenderDevice : uint8_t {
  kAuto,  ///< an NVIDIA GPU if this build and this machine support one, otherwise the CPU
  kCpu,
  kCuda,
};
template <>
struct EnumTable<RenderDevice> {
  static constexpr const char* kNoun = "render device";
  static constexpr auto kNames = std::to_array<EnumName<RenderDevice>>(
      {{RenderDevice::kAuto, "auto"}, {RenderDevice::kCpu, "cpu"}, {RenderDevice::kCuda, "cuda"}});
};

/// Light of models without lights (docs/light.md).
enum class RenderLook : uint8_t {
  kAuto,    ///< kStudio for models without lamps and sky, otherwise kModel
  kStudio,  ///< a soft sky, a key light and a floor, only in colour images
  kModel,   ///< the lights of MuJoCo
};
template <>
struct EnumTable<RenderLook> {
  static constexpr const char* kNoun = "look";
  static constexpr auto kNames =
      std::to_array<EnumName<RenderLook>>({{RenderLook::kAuto, "auto"},
                                           {RenderLook::kStudio, "studio"},
                                           {RenderLook::kModel, "model"}});
};

/// [render]: rendering of images.
struct RenderOptions {
  /// path | interactive | direct (docs/light.md); empty = interactive for cameras that open while
  /// the simulation runs in real time, path for others.
  std::optional<RenderTier> tier = {};
  std::optional<int> spp = {};  ///< samples per pixel, 1 … 65536; with `error` the maximum, from 16
  /// Error bound of the path tier: each pixel is sampled until its standard error is this fraction
  /// of its value, 0.0001 … 1 (docs/light.md); empty = the same number of samples in every pixel.
  std::optional<double> error = {};
  /// Path vertices after the camera, 1 … 64; empty = 5, or 24 with media, where fog is white due to
  /// multiple scattering, and in the interactive tier.
  std::optional<int> max_depth = {};
  /// cpu | cuda | auto (an NVIDIA GPU if this build and this machine support one, otherwise the
  /// CPU).
  RenderDevice device = RenderDevice::kAuto;
  bool denoise = true;  ///< except in the interactive tier, which has its own filter
  /// auto | studio | model: light for models without lights. studio: a soft sky, a key light and a
  /// floor, only in colour images; model: the lights of MuJoCo; auto: studio for models without
  /// lamps and sky (docs/light.md).
  RenderLook look = RenderLook::kAuto;
  /// Exposure value at ISO 100; empty = determined by the scene (docs/light.md).
  std::optional<double> ev100 = {};
  /// Rendered groups of geoms, skins, flexes, tendons and sites, 0 … 5; empty = 0 to 2, and the
  /// collision shapes of bodies that have no other geoms
  std::vector<int> groups = {};
  bool sites = false;  ///< render sites; only cameras see them
  SourceLoc loc = {};

  /// tier, or the default one.
  RenderTier tier_or_default(bool real_time) const {
    return tier.value_or(real_time && !error ? RenderTier::kInteractive : RenderTier::kPath);
  }
  /// spp; if it is empty, 4, or 4096 with `error`.
  int samples() const { return spp.value_or(error ? 4096 : 4); }
};

}  // namespace gloam
