#include "render/scene/light_tree_table.h"

#include <algorithm>

#include "base/parallel.h"
#include "render/scene/light_split.h"

namespace gloam {
namespace {

constexpr uint32_t kFirstPair = LightTreeView::kRoots + 1;  // an even row
constexpr size_t kOneTask = 4096;                           // lights that one thread builds over
constexpr int kHalvingDepth =
    48;  // from this depth on sets are halved: no order of lights makes a chain

/// A set of lights whose node is known and whose descendants are not: they fill the rows from
/// `pairs` on, two for each light but one.
struct Range {
  std::span<LightItem> items;
  uint32_t node = 0, pairs = 0;
  int depth = 0;
};

Vec3f corner(Vec3f a, Vec3f b, bool high) {
  return high ? Vec3f{max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}
              : Vec3f{min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}

/// The smallest cone around two.
void merge_cones(const LightNode& a, const LightNode& b, LightNode* out) {
  const LightNode &wide = a.spread >= b.spread ? a : b, &narrow = a.spread >= b.spread ? b : a;
  out->axis = wide.axis;
  out->spread = wide.spread;
  out->falloff = max(a.falloff, b.falloff);
  if (wide.spread >= kPi) return;
  const Vec3f normal = cross(wide.axis, narrow.axis);
  const float sine = length(normal), between = std::atan2(sine, dot(wide.axis, narrow.axis));
  if (between + narrow.spread <= wide.spread) return;
  out->spread = 0.5f * (wide.spread + between + narrow.spread);
  if (out->spread >= kPi || sine < 1e-6f) {
    if (between > 1) out->spread = kPi;
    return;
  }
  const float turn = out->spread - wide.spread;
  out->axis =
      normalize(wide.axis * std::cos(turn) + cross(normal / sine, wide.axis) * std::sin(turn));
}

void bound_two(const LightNode& a, const LightNode& b, LightNode* out) {
  const Vec3f low = corner(a.center - a.half, b.center - b.half, false);
  const Vec3f high = corner(a.center + a.half, b.center + b.half, true);
  out->center = (low + high) * 0.5f;
  out->half = corner(high - out->center, out->center - low, true);
  merge_cones(a, b, out);
  out->power = a.power + b.power;
  out->flags = (a.flags | b.flags) & ~LightNode::kLeaf;
  if (((a.flags ^ b.flags) & LightNode::kFar) != 0) {  // headlights of both kinds: no bounds at all
    out->flags &= ~LightNode::kFar;
    out->half = {1e15f, 1e15f, 1e15f};
    out->spread = kPi;
  }
}

class Builder {
 public:
  Builder(const std::vector<LightView>& lights, std::vector<LightNode>* nodes,
          std::vector<uint32_t>* leaf_of, float scale)
      : lights_(lights), nodes_(*nodes), leaf_of_(*leaf_of), scale_(scale) {}

  void build(const Range& whole) {
    // Large sets level by level, each by one thread; then the small ones below them.
    std::vector<Range> large{whole}, small, parted;
    while (!large.empty()) {
      std::vector<Range> next;
      for (const Range& range : large) {
        (range.items.size() > kOneTask ? next : small).push_back(range);
      }
      large.assign(2 * next.size(), {});
      parallel_for("light tree levels", static_cast<int64_t>(next.size()), [&](int64_t i) {
        const auto at = static_cast<size_t>(i);
        split(next[at], &large[2 * at], &large[2 * at + 1]);
      });
      parted.insert(parted.end(), next.begin(), next.end());
    }
    parallel_for("light tree", static_cast<int64_t>(small.size()),
                 [&](int64_t i) { build_all(small[static_cast<size_t>(i)]); });
    for (size_t i = parted.size(); i-- > 0;) conclude(parted[i]);
  }
  void fill_leaf(uint32_t row, uint32_t light) {
    const LightView& in = lights_[light];
    LightNode& leaf = nodes_[row];
    const bool far = in.kind == LightKind::kDirectional;
    leaf.center = far ? Vec3f{} : in.p;
    leaf.half = far ? Vec3f{} : in.half;
    leaf.axis = in.direction;
    leaf.spread = in.spread;
    leaf.falloff = in.falloff;
    // The mean intensity of a plane is a quarter of its most; that of a bent panel is more.
    const bool is_panel = in.kind == LightKind::kInstance && in.spread < kPi;
    leaf.power = in.strength * scale_ * (is_panel ? 4.0f : 1.0f);
    const bool shown = in.kind != LightKind::kInstance && !in.is_delta && in.casts_shadow;
    leaf.flags = LightNode::kLeaf | (far ? LightNode::kFar : 0u) | (shown ? LightNode::kShown : 0u);
    leaf.first = light;
    leaf_of_[light] = row;
  }

 private:
  void split(const Range& range, Range* a, Range* b) {
    const size_t count = split_lights(range.items, range.depth >= kHalvingDepth);
    const auto below = static_cast<uint32_t>(2 * (count - 1));
    *a = {range.items.first(count), range.pairs, range.pairs + 2, range.depth + 1};
    *b = {range.items.subspan(count), range.pairs + 1, range.pairs + 2 + below, range.depth + 1};
    nodes_[range.node].first = range.pairs;
    nodes_[a->node].parent = nodes_[b->node].parent = range.node;
  }
  void build_all(const Range& range) {
    if (range.items.size() == 1) return fill_leaf(range.node, range.items[0].light);
    Range a, b;
    split(range, &a, &b);
    build_all(a);
    build_all(b);
    conclude(range);
  }
  void conclude(const Range& range) {
    bound_two(nodes_[range.pairs], nodes_[range.pairs + 1], &nodes_[range.node]);
  }

  const std::vector<LightView>& lights_;
  std::vector<LightNode>& nodes_;
  std::vector<uint32_t>& leaf_of_;
  float scale_;
};

LightItem item_of(const LightView& light, uint32_t row) {
  const bool far = light.kind == LightKind::kDirectional;
  return {far ? light.direction : light.p, far ? Vec3f{} : light.half,
          light.spread < kPi ? light.direction : Vec3f{}, light.strength, row};
}

/// Factor that makes fractions of strengths.
float fraction_scale(const std::vector<LightView>& lights) {
  double sum = 0;
  for (const LightView& light : lights) sum += static_cast<double>(light.strength);
  return sum > 0 ? static_cast<float>(1 / sum) : 0;
}

}  // namespace

void LightTreeTable::build(const std::vector<LightView>& lights,
                           const std::vector<uint32_t>& headlights) {
  std::vector<LightItem> items[LightTreeView::kRoots];
  std::vector<uint32_t>::const_iterator carried = headlights.begin();
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const bool is_carried = carried != headlights.end() && *carried == i;
    if (is_carried) ++carried;
    const bool is_far = lights[i].kind == LightKind::kDirectional;
    const uint32_t root = is_carried ? LightTreeView::kCarried
                          : is_far   ? LightTreeView::kFar
                                     : LightTreeView::kNear;
    items[root].push_back(item_of(lights[i], i));
  }
  size_t rows = kFirstPair;
  for (const std::vector<LightItem>& part : items) rows += part.empty() ? 0 : 2 * (part.size() - 1);
  nodes_.assign(rows, {});
  leaf_of_.assign(lights.size(), LightNode::kNone);
  scale_ = fraction_scale(lights);
  Builder builder(lights, &nodes_, &leaf_of_, scale_);
  uint32_t pairs = kFirstPair;
  for (uint32_t root = 0; root < LightTreeView::kRoots; ++root) {
    if (root == LightTreeView::kCarried) first_carried_ = pairs;
    if (items[root].empty()) continue;
    builder.build({items[root], root, pairs, 0});
    pairs += static_cast<uint32_t>(2 * (items[root].size() - 1));
  }
}

void LightTreeTable::move_headlights(const std::vector<LightView>& lights,
                                     const std::vector<uint32_t>& headlights) {
  if (headlights.empty()) return;
  // One after another from below: a node comes after its parent.
  Builder builder(lights, &nodes_, &leaf_of_, scale_);
  for (const uint32_t light : headlights) builder.fill_leaf(leaf_of_[light], light);
  for (auto pair = static_cast<uint32_t>(nodes_.size()); pair > first_carried_; pair -= 2) {
    bound_two(nodes_[pair - 2], nodes_[pair - 1], &nodes_[nodes_[pair - 2].parent]);
  }
}

LightTreeView LightTreeTable::view() const {
  return {{nodes_.data(), static_cast<uint32_t>(nodes_.size())},
          {leaf_of_.data(), static_cast<uint32_t>(leaf_of_.size())}};
}

}  // namespace gloam
