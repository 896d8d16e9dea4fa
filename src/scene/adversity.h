#pragma once
// Effect of a level of adversity on a scene: docs/weather.md has its table and sources.

#include <span>

#include "gloam/scene.h"

namespace gloam {

/// The numbers of a level for the kind of place a scene has.
struct AdversityNumbers {
  double rain = 0, wind = 0, gusts = 0.15;  ///< [mm/h], [m/s], 1
  std::optional<double> visibility = {};    ///< [m]; empty = clear
  std::string_view medium = "fog";          ///< medium in the air
  double lens_drops = 0;                    ///< fraction of the picture
  double light = 1, failing = 0;            ///< lamps of the place
  double clutter = 0.5;                     ///< clutter of the place
  int people = 0;
  double people_speed = 1.2;  ///< [m/s]
};
AdversityNumbers adversity_numbers(const EnvironmentOptions& place, std::string_view level);

/// Fills [weather], the place's clutter and a crowd with what the level of [adversity] says and the
/// scene leaves open. A scene without [adversity] stays as it is.
void apply_adversity(Scene* scene);

/// Dims and breaks lamps of the place.
void apply_adversity_to_lamps(const Scene& scene, std::span<LightOptions> lamps);

}  // namespace gloam
