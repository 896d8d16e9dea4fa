#include "sensors/lidar/lidar_sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/text.h"
#include "render/kernel/lidar/lidar_particles.h"
#include "render/scene/pose.h"
#include "sensors/camera/camera_sensor.h"
#include "world/materials/authored_material.h"
#include "world/media/medium_presets.h"

namespace gloam {
namespace {

/// 0 … 255, as LidarScan::intensity says.
float calibrated_reflectivity(float g) {
  if (g <= 1) return 100 * g;
  return std::min(100 + 155.0f / 3 * std::log10(g), 255.0f);
}

/// Packets of rays are fast when they are narrow both ways: four rings by four columns.
constexpr uint64_t kBlock = 4;

}  // namespace

Result<std::unique_ptr<LidarSensor>> LidarSensor::create(const RenderDescription& rendered,
                                                         const LidarDescription& lidar,
                                                         uint64_t seed) {
  GLOAM_TRY(LidarModel model, make_lidar_model(lidar.options));
  const std::string& name = lidar.options.name;
  std::unique_ptr<LidarSensor> sensor(new LidarSensor(rendered, lidar, std::move(model),
                                                      hash_bytes(name.data(), name.size(), seed)));
  GLOAM_TRY_STATUS(sensor->find_surfaces());
  return sensor;
}

LidarSensor::LidarSensor(const RenderDescription& rendered, const LidarDescription& lidar,
                         LidarModel model, uint64_t seed)
    : rendered_(rendered), lidar_(lidar), model_(std::move(model)), seed_(seed) {
  for (const VolumeDescription& volume : rendered.volumes) {
    lidar_ratios_.push_back(lidar_ratio(rendered.media[static_cast<size_t>(volume.medium)].name));
  }
  origin_ = rendered.origin;
  if (!lidar.hidden.empty()) {
    for (const InstanceDescription& in : rendered.instances)
      hidden_.push_back(lidar.hidden[static_cast<size_t>(in.body)]);
  }
  particle_tables_ = tabulate_particles(rendered, model_.optics);
  for (const LidarParticleTable& table : particle_tables_) particles_.push_back(table.view());
}

Status LidarSensor::find_surfaces() {
  const std::vector<LidarSurfaceOptions>& wanted = lidar_.options.surfaces;
  const size_t band = model_.optics.band == MediumBand::k1550nm ? 1 : 0;
  const bool knows_insides =
      std::any_of(rendered_.materials.begin(), rendered_.materials.end(),
                  [&](const auto& m) { return m.infrared_absorption[band] >= 0; });
  if (wanted.empty() && !knows_insides) return {};
  surfaces_.resize(rendered_.instances.size());
  std::vector<bool> found(wanted.size());
  for (size_t i = 0; i < surfaces_.size(); ++i) {
    const auto row = static_cast<size_t>(rendered_.instances[i].material);
    const MaterialDescription& material = rendered_.materials[row];
    surfaces_[i].absorption = material.infrared_absorption[band];
    for (size_t k = 0; k < wanted.size(); ++k) {
      if (material.name.empty() || !fits(wanted[k].material, material.name)) continue;
      found[k] = true;
      const double red = std::max(static_cast<double>(material.base_color.x), 1e-3);
      surfaces_[i].diffuse = static_cast<float>(wanted[k].diffuse.value_or(red) / red);
      surfaces_[i].retro = static_cast<float>(wanted[k].retro);
    }
  }
  for (size_t k = 0; k < wanted.size(); ++k) {
    if (found[k]) continue;
    std::vector<std::string> names;
    for (const MaterialDescription& material : rendered_.materials) names.push_back(material.name);
    return Error{ErrorKind::kInput,
                 fmt::format("lidar '{}': this scene does not render a material '{}'",
                             lidar_.options.name, wanted[k].material),
                 wanted[k].loc, suggest_name(wanted[k].material, names)};
  }
  return {};
}

// Decides when beams are fired among the keys, and in which order they are traced.
void LidarSensor::plan(std::span<const PoseFrame> keys, int64_t index) {
  const double start = keys.front().time, length = keys.back().time - start;
  std::vector<float> cuts;
  for (size_t k = 0; k < keys.size(); ++k) {
    const double even = static_cast<double>(k) / static_cast<double>(keys.size() - 1);
    cuts.push_back(static_cast<float>(length > 0 ? (keys[k].time - start) / length : even));
  }
  const LidarPattern& pattern = lidar_pattern(model_.pattern);
  if (!firings_.empty() && pattern.repeats && cuts == cuts_) return;
  cuts_ = std::move(cuts);
  firings_ = pattern.fire(model_, index);

  struct Place {
    uint64_t key;
    uint32_t firing, stretch;
  };
  std::vector<Place> places(firings_.size());
  const auto last_stretch = static_cast<uint32_t>(cuts_.size() - 2);
  for (uint32_t i = 0; i < firings_.size(); ++i) {
    const LidarFiring& f = firings_[i];
    const auto above = std::upper_bound(cuts_.begin() + 1, cuts_.end(), f.time);
    const auto stretch = std::min(static_cast<uint32_t>(above - cuts_.begin()) - 1, last_stretch);
    uint64_t key = uint64_t{stretch} << 40;
    if (pattern.grid) key |= (f.column / kBlock) << 20 | f.ring / kBlock;
    places[i] = {key, i, stretch};
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.key < b.key; });
  beams_.resize(places.size());
  place_.resize(places.size());
  const auto stretches = static_cast<float>(cuts_.size() - 1);
  for (size_t b = 0; b < places.size(); ++b) {
    const auto& [key, firing, stretch] = places[b];
    const LidarFiring& f = firings_[firing];
    const float from = cuts_[stretch], to = cuts_[stretch + 1];
    const float share = to > from ? std::clamp((f.time - from) / (to - from), 0.0f, 1.0f) : 0.0f;
    beams_[b] = {f.d, (static_cast<float>(stretch) + share) / stretches, firing};
    place_[firing] = static_cast<uint32_t>(b);
  }
}

std::shared_ptr<const LidarScan> LidarSensor::scan(Renderer& renderer, RenderTurns& turns,
                                                   std::span<const PoseFrame> keys, int64_t index) {
  GLOAM_CHECK(keys.size() >= 2, "a scan needs poses at its start and its end");
  plan(keys, index);
  const Affine3f X_BL =
      to_affine(lidar_.body == 0 ? from_origin(lidar_.X_BL, origin_) : lidar_.X_BL);
  std::vector<Affine3f> X_WL;
  std::vector<const PoseFrame*> frames;
  for (const PoseFrame& key : keys) {
    X_WL.push_back(pose_in_world(key, lidar_.body, X_BL));
    frames.push_back(&key);
  }
  motions_.clear();
  for (size_t k = 0; k + 1 < keys.size(); ++k)
    motions_.push_back(make_lidar_motion(X_WL[k], X_WL[k + 1]));
  LidarView view;
  view.motions = motions_;
  view.optics = model_.optics;
  view.optics.lidar_ratios = {lidar_ratios_.data(), static_cast<uint32_t>(lidar_ratios_.size())};
  view.optics.particles = {particles_.data(), static_cast<uint32_t>(particles_.size())};
  view.optics.hidden = {hidden_.data(), static_cast<uint32_t>(hidden_.size())};
  view.optics.surfaces = {surfaces_.data(), static_cast<uint32_t>(surfaces_.size())};
  view.seed = seed_;
  view.scan = static_cast<uint64_t>(index);
  view.beams = beams_;
  view.turns = &turns;
  returns_.resize(beams_.size() * static_cast<size_t>(model_.optics.most_returns));
  {
    const RenderTurn turn(turns, use_);
    renderer.update(frames, keys.front());
    renderer.scan(view, returns_);
  }
  auto scan = std::make_shared<LidarScan>();
  scan->lidar = lidar_.options.name;
  scan->index = index;
  scan->step = keys.back().step;
  scan->start = keys.front().time;
  scan->end = keys.back().time;
  const LidarPattern& pattern = lidar_pattern(model_.pattern);
  const bool spins = model_.pattern == LidarPatternKind::kSpinning;
  scan->rings =
      pattern.grid ? (spins ? static_cast<int>(model_.elevations.size()) : model_.rows) : 1;
  scan->columns = pattern.grid ? model_.columns : 0;
  scan->beams = static_cast<int>(beams_.size());
  scan->deskewed = lidar_.options.deskew;
  scan->X_WL_start = in_world(X_WL.front(), origin_);
  scan->X_WL_end = in_world(X_WL.back(), origin_);
  write_points(X_WL, scan.get());
  if (lidar_.options.truth) add_truth(scan.get());
  return scan;
}

void LidarSensor::write_points(std::span<const Affine3f> X_WL, LidarScan* scan) const {
  const auto most = static_cast<size_t>(model_.optics.most_returns);
  const auto count_of = [&](size_t firing) {
    size_t count = 0;
    while (count < most && returns_[place_[firing] * most + count].range > 0) ++count;
    return count;
  };
  // Where the points of each block of firings begin, so that all threads write at once.
  constexpr size_t kFirings = 2048;
  const size_t blocks = (firings_.size() + kFirings - 1) / kFirings;
  std::vector<size_t> begin(blocks + 1);
  const auto each_of = [&](size_t block, const auto& visit) {
    const size_t end = std::min((block + 1) * kFirings, firings_.size());
    for (size_t i = block * kFirings; i < end; ++i) visit(i);
  };
  parallel_for("lidar points", static_cast<int64_t>(blocks), [&](int64_t task) {
    const auto block = static_cast<size_t>(task);
    each_of(block, [&](size_t i) { begin[block + 1] += count_of(i); });
  });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  for (auto* values : {&scan->x, &scan->y, &scan->z, &scan->intensity, &scan->range, &scan->time})
    values->resize(begin.back());
  for (auto* values : {&scan->ring, &scan->column}) values->resize(begin.back());
  scan->return_number.resize(begin.back());
  scan->part.resize(lidar_.options.truth ? begin.back() : 0);
  parallel_for("lidar points", static_cast<int64_t>(blocks), [&](int64_t task) {
    size_t point = begin[static_cast<size_t>(task)];
    each_of(static_cast<size_t>(task), [&](size_t i) {
      const size_t count = count_of(i);
      for (size_t r = 0; r < count; ++r) write_point(X_WL.back(), {i, r, point++}, scan);
    });
  });
}

void LidarSensor::write_point(const Affine3f& end, const PlacedReturn& at, LidarScan* scan) const {
  const LidarFiring& firing = firings_[at.firing];
  const size_t beam = place_[at.firing], i = at.point;
  const LidarReturn& found =
      returns_[beam * static_cast<size_t>(model_.optics.most_returns) + at.number];
  Vec3f p = firing.d * found.range;
  if (lidar_.options.deskew) {
    const DeviceSpan<const LidarMotion> motions{motions_.data(),
                                                static_cast<uint32_t>(motions_.size())};
    const Ray ray = beam_ray(motions, firing.d, beams_[beam].time);
    const Vec3f from_end = ray.o - end.p + ray.d * found.range;
    p = {dot(from_end, end.x), dot(from_end, end.y), dot(from_end, end.z)};
  }
  scan->x[i] = p.x;
  scan->y[i] = p.y;
  scan->z[i] = p.z;
  // Sensors are calibrated for their overlap as for the range.
  const float overlap = std::max(lidar::overlap(model_.optics, found.range), 1e-6f);
  const float plain = found.signal * found.range * found.range / overlap;
  const bool reflectivity = lidar_.options.intensity == "reflectivity";
  scan->intensity[i] = reflectivity ? calibrated_reflectivity(plain) : found.signal;
  scan->range[i] = found.range;
  scan->time[i] = static_cast<float>(firing.time * (scan->end - scan->start));
  scan->ring[i] = firing.ring;
  scan->column[i] = firing.column;
  scan->return_number[i] = static_cast<uint8_t>(at.number);
  if (lidar_.options.truth) scan->part[i] = found.part;
}

void LidarSensor::add_truth(LidarScan* scan) const {
  scan->instance.resize(scan->part.size());
  scan->semantic.resize(scan->part.size());
  for (size_t i = 0; i < scan->part.size(); ++i) {
    if (scan->part[i] == 0) continue;
    const LabelRow& label = rendered_.instances[scan->part[i] - 1].label;
    scan->instance[i] = label.instance;
    scan->semantic[i] = label.semantic;
  }
}

}  // namespace gloam
