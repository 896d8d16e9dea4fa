#include "render/scene/light_split.h"

#include <algorithm>

namespace gloam {
namespace {

constexpr int kSplitBins = 12;
constexpr size_t kHalvedLights = 5;  // so many are halved along their longest extent

struct Box {
  Vec3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  void add(Vec3f a, Vec3f b) {
    low = {min(low.x, a.x), min(low.y, a.y), min(low.z, a.z)};
    high = {max(high.x, b.x), max(high.y, b.y), max(high.z, b.z)};
  }
  Vec3f size() const { return high - low; }
};

/// Bounds, sum of axes and power of some of the items together.
struct Part {
  Box box;
  Vec3f axes;  ///< sum
  float power = 0;
  uint32_t count = 0;

  void add(const LightItem& item) {
    box.add(item.center - item.half, item.center + item.half);
    axes += item.axis;
    power += item.power;
    ++count;
  }
  void add(const Part& other) {
    box.add(other.box.low, other.box.high);
    axes += other.axes;
    power += other.power;
    count += other.count;
  }
  /// Cost as Conty Estevez & Kulla's power x area x solid angle, of a form that a row of lamps on
  /// one line, whose area is zero, has too, and with the agreement of the axes for their cone.
  float cost() const {
    const float agreement = length(axes) / static_cast<float>(count);
    return power * length_squared(box.size()) * (1.0f - 0.75f * agreement);
  }
};

/// Bins along one axis of `key`.
class Bins {
 public:
  Bins(float low, float high)
      : low_(low), per_key_(high > low ? static_cast<float>(kSplitBins) / (high - low) : 0) {}
  int bin_of(float key) const {
    return std::min(kSplitBins - 1, static_cast<int>((key - low_) * per_key_));
  }
  void add(float key, const LightItem& item) { parts_[bin_of(key)].add(item); }
  /// The cheapest place: bins below it against the rest; 0 = none.
  int best(float* cost) const {
    float above[kSplitBins];
    Part part;
    for (int i = kSplitBins - 1; i > 0; --i) {
      if (parts_[i].count > 0) part.add(parts_[i]);
      above[i] = part.count > 0 ? part.cost() : -1;
    }
    part = {};
    int place = 0;
    for (int i = 1; i < kSplitBins; ++i) {
      if (parts_[i - 1].count > 0) part.add(parts_[i - 1]);
      if (part.count == 0 || above[i] < 0) continue;
      const float sum = part.cost() + above[i];
      if (place > 0 && !(sum < *cost)) continue;
      *cost = sum;
      place = i;
    }
    return place;
  }

 private:
  float low_, per_key_;
  Part parts_[kSplitBins];
};

size_t halve(std::span<LightItem> items, Vec3f LightItem::* key, int k) {
  const size_t half = items.size() / 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   [=](const LightItem& a, const LightItem& b) {
                     const float x = (a.*key)[k], y = (b.*key)[k];
                     return x != y ? x < y : a.light < b.light;
                   });
  return half;
}

}  // namespace

size_t split_lights(std::span<LightItem> items, bool evenly) {
  // Lamps at one place differ by the way they shine.
  Vec3f LightItem::* key = &LightItem::center;
  Box keys;
  for (const LightItem& item : items) keys.add(item.center, item.center);
  if (!(max_component(keys.size()) > 0)) {
    key = &LightItem::axis;
    keys = {};
    for (const LightItem& item : items) keys.add(item.axis, item.axis);
  }
  const Vec3f size = keys.size();
  const int longest = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  if (evenly || items.size() <= kHalvedLights || !(size[longest] > 0))
    return halve(items, key, longest);

  Bins bins[3] = {{keys.low.x, keys.high.x}, {keys.low.y, keys.high.y}, {keys.low.z, keys.high.z}};
  for (const LightItem& item : items) {
    for (int k = 0; k < 3; ++k) bins[k].add((item.*key)[k], item);
  }
  int axis = -1, place = 0;
  float least = 0;
  for (int k = 0; k < 3; ++k) {
    float cost = 0;
    const int at = bins[k].best(&cost);
    if (at == 0 || (axis >= 0 && !(cost < least))) continue;
    axis = k;
    place = at;
    least = cost;
  }
  if (axis < 0) return halve(items, key, longest);
  const auto middle = std::partition(items.begin(), items.end(), [&](const LightItem& item) {
    return bins[axis].bin_of((item.*key)[axis]) < place;
  });
  return static_cast<size_t>(middle - items.begin());
}

}  // namespace gloam
