#include "scene/adversity.h"

#include "base/rng.h"
#include "places/generators.h"

namespace gloam {
namespace {

// Open country, and scenes without a generated place. Rain is moderate to 7.6 mm/h and heavy above
// (AMS Glossary of Meteorology); 12 m/s is a strong breeze, 6 Beaufort.
constexpr AdversityNumbers kOpenCountry[] = {
    {},
    {.rain = 5, .wind = 5, .gusts = 0.2, .visibility = 150, .lens_drops = 0.02, .people = 2},
    {.rain = 30,
     .wind = 12,
     .gusts = 0.3,
     .visibility = 40,
     .lens_drops = 0.1,
     .people = 6,
     .people_speed = 1.5}};
// Rooms: smoke. People turn back at visibilities of 13 m in a building that they do not know, and
// of 4 m in one that they know (Jin 1978, "Visibility through fire smoke").
constexpr AdversityNumbers kRooms[] = {{},
                                       {.visibility = 13,
                                        .medium = "smoke",
                                        .light = 0.6,
                                        .failing = 0.15,
                                        .clutter = 0.7,
                                        .people = 2,
                                        .people_speed = 1},
                                       {.visibility = 4,
                                        .medium = "smoke",
                                        .light = 0.2,
                                        .failing = 0.4,
                                        .clutter = 1,
                                        .people = 5,
                                        .people_speed = 1.4}};
// Halls, tunnels and mines: dust.
constexpr AdversityNumbers kHalls[] = {{},
                                       {.visibility = 40,
                                        .medium = "dust",
                                        .light = 0.6,
                                        .failing = 0.15,
                                        .clutter = 0.7,
                                        .people = 3,
                                        .people_speed = 1.2},
                                       {.visibility = 12,
                                        .medium = "dust",
                                        .light = 0.2,
                                        .failing = 0.4,
                                        .clutter = 1,
                                        .people = 8,
                                        .people_speed = 1.5}};

template <class T, class U>
void fill(std::optional<T>* option, const U& value) {
  if (!*option) *option = value;
}

/// Calls f with the clutter of the place.
template <class F>
void with_clutter(EnvironmentOptions* place, const F& f) {
  if (place->house) f(&place->house->clutter);
  if (place->warehouse) f(&place->warehouse->clutter);
  if (place->office) f(&place->office->clutter);
  if (place->hallway) f(&place->hallway->clutter);
  if (place->bedroom) f(&place->bedroom->clutter);
  if (place->tunnel) f(&place->tunnel->clutter);
  if (place->mine) f(&place->mine->clutter);
}

}  // namespace

AdversityNumbers adversity_numbers(const EnvironmentOptions& place, std::string_view level) {
  const size_t row = level == "major" ? 2 : (level == "minor" ? 1 : 0);
  if (place.warehouse || place.tunnel || place.mine) return kHalls[row];
  return has_rooms(place) ? kRooms[row] : kOpenCountry[row];
}

void apply_adversity(Scene* scene) {
  if (!scene->adversity) return;
  const AdversityOptions& in = *scene->adversity;
  const AdversityNumbers level = adversity_numbers(scene->environment, in.level);
  if (in.level != "none") {
    if (!scene->weather) {
      scene->weather.emplace();
      scene->weather->loc = in.loc;
    }
    WeatherOptions& weather = *scene->weather;
    fill(&weather.rain, level.rain);
    fill(&weather.wind, level.wind);
    fill(&weather.gusts, level.gusts);
    fill(&weather.lens_drops, level.lens_drops);
    if (level.visibility && !weather.visibility) {
      weather.visibility = level.visibility;
      fill(&weather.medium, level.medium);
      fill(&weather.where, has_rooms(scene->environment) ? "rooms" : "everywhere");
    }
  }
  if (in.clutter || in.level != "none") {
    with_clutter(&scene->environment,
                 [&](double* clutter) { *clutter = in.clutter.value_or(level.clutter); });
  }
  if (const int people = in.people.value_or(level.people); people > 0) {
    CrowdOptions crowd;
    crowd.name = "people";
    crowd.count = people;
    crowd.seed = scene->sim.seed;
    crowd.speed = in.people_speed.value_or(level.people_speed);
    crowd.loc = in.loc;
    scene->crowds.push_back(std::move(crowd));
  }
}

void apply_adversity_to_lamps(const Scene& scene, std::span<LightOptions> lamps) {
  if (!scene.adversity) return;
  const AdversityOptions& in = *scene.adversity;
  const AdversityNumbers level = adversity_numbers(scene.environment, in.level);
  const double share = in.light.value_or(level.light), failing = in.failing.value_or(level.failing);
  const RandomStream random{scene.sim.seed, stream_id("adversity.lamps")};
  uint64_t row = 0;
  for (LightOptions& lamp : lamps) {
    for (auto* strength : {&lamp.intensity, &lamp.flux, &lamp.luminance, &lamp.illuminance})
      if (*strength) **strength *= share;
    const Philox4 draw = random.draw(row++, 0);
    if (!(static_cast<double>(uniform_float(draw.v[0])) < failing)) continue;
    // A tube at its end: it goes out for moments, and is unsteady in between.
    LightScheduleOptions schedule = lamp.schedule.value_or(LightScheduleOptions{});
    schedule.on_off = {.period = 0.3 + 2 * static_cast<double>(uniform_float(draw.v[1])),
                       .duty = 0.5 + 0.4 * static_cast<double>(uniform_float(draw.v[2])),
                       .phase = static_cast<double>(uniform_float(draw.v[3]))};
    schedule.flame = {.bandwidth = 12, .depth = 0.6};
    lamp.schedule = std::move(schedule);
  }
}

}  // namespace gloam
