#pragma once
// Removing Monte Carlo noise from a Film: by Open Image Denoise where it is installed, else by a
// filter of our own. One interface; which one is a run-time choice.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "gloam/result.h"
#include "render/film/film.h"

namespace gloam {

/// Quality of Open Image Denoise. kHigh also denoises albedo and normals first and then trusts
/// them, which keeps the finest texture and costs about seven times as much: for stills.
enum class DenoiseQuality : uint8_t { kFast, kBalanced, kHigh };

enum class DenoiseDevice : uint8_t { kCpu, kCuda };

struct DenoiseOptions {
  bool use_oidn = true;  ///< false: our own filter even where Open Image Denoise is installed
  DenoiseDevice device = DenoiseDevice::kCpu;  ///< of Open Image Denoise; our own is the CPU's
  DenoiseQuality quality = DenoiseQuality::kBalanced;
};

/// Keeps its buffers from call to call. Not thread-safe; uses all threads of parallel_for.
class Denoiser {
 public:
  virtual ~Denoiser() = default;
  /// Writes the film's radiance without its noise to `out` [cd/m²], (height x width). Uses albedo,
  /// normal, depth and variance where the film has them. Pixels that are not numbers count as
  /// black; the light of single pixels far brighter than everything around them (fireflies) is
  /// spread. The picture keeps the film's light.
  virtual Status denoise(const Film& film, std::vector<Vec3f>* out) = 0;
  virtual const char* name() const = 0;
  /// Called during denoise(), on any thread; once it returns false, denoise() gives up and returns
  /// an Error. Denoisers that take less than a second may ignore it.
  virtual void set_may_continue(std::function<bool()> /*may_continue*/) {}
};

/// Open Image Denoise 2.x, loaded at run time from $GLOAM_OIDN (its library or folder), Gloam's
/// .venv, an installation or bundle, or the system. Results are equal for any number of threads on
/// one machine. Errors: not found, too old, refuses this machine or this card.
Result<std::unique_ptr<Denoiser>> make_oidn_denoiser(const DenoiseOptions& options);

/// Edge-avoiding à-trous wavelet filter (Dammertz et al. 2010) over radiance divided by albedo,
/// guided by normal, depth and variance (as in Schied et al. 2017, without the temporal part).
std::unique_ptr<Denoiser> make_edge_denoiser();

/// Open Image Denoise if wanted and present, on the CPU where the card refuses, else our own.
std::unique_ptr<Denoiser> make_denoiser(const DenoiseOptions& options);

/// Step that both do first: not-a-number to black, and pixels brighter than four times the third
/// brightest of their 5 x 5 neighbours down to that. Every thin line or highlight of three or more
/// pixels passes unchanged. What fireflies lose is spread, as light on the albedo there, over the
/// 33 x 33 pixels around that face the same way; a pixel gets at most 2 % of a firefly's limit of
/// it. `light`: the film's light as it is to be kept, where a firefly has at most ten times that
/// of all those pixels together: errors are not light.
void remove_fireflies(const Film& film, std::vector<Vec3f>* out, std::vector<Vec3f>* light);

/// Step that both do last: gives a denoised picture the light of `light`, per channel, in each
/// neighbourhood of some 65 x 65 pixels and as a whole. What fireflies could not give away nearby
/// and what a filter has lost brightens all that is seen there by one factor.
void restore_light(const std::vector<Vec3f>& light, int width, int height,
                   std::vector<Vec3f>* picture);

}  // namespace gloam
