#include "geometry/bvh/bvh_build.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"

namespace gloam {
namespace {

constexpr int kBins = 32;
/// Items of a part that is worth a task of its own.
constexpr uint32_t kTaskItems = 8192;

bool is_finite(const BvhBox& b) {
  float far = 0;
  for (int k = 0; k < 3; ++k) far += fabsf(b.low[k]) + fabsf(b.high[k]);
  return far < 1e18f;
}

struct Item {
  Vec3f center;
  uint32_t box = 0;
};

struct Part {
  uint32_t first = 0, count = 0;
  int depth = 0;  ///< nodes that may still be above its leaves
};

/// Nodes that halving takes down to leaves of `most`.
int depth_of_halves(uint32_t count, int most) {
  int depth = 0;
  for (; count > static_cast<uint32_t>(most); count = (count + 1) / 2) ++depth;
  return depth;
}

class Builder {
 public:
  Builder(const std::vector<BvhBox>& boxes, std::vector<Item>* items, const BvhBuild& options)
      : boxes_(boxes), items_(*items), options_(options) {}

  BvhBox bounds(const Part& part) const {
    BvhBox all;
    for (uint32_t i = part.first; i < part.first + part.count; ++i) all.add(boxes_[items_[i].box]);
    return all;
  }
  bool is_leaf(const Part& part) const {
    return part.count <= static_cast<uint32_t>(options_.most_in_leaf);
  }

  /// Orders the part's items so that each side's lie together.
  void split(const Part& part, Part* left, Part* right) {
    uint32_t middle = 0;
    const bool must_halve = depth_of_halves(part.count, options_.most_in_leaf) + 1 >= part.depth;
    if (must_halve || !split_by_bins(part, &middle)) middle = split_in_half(part);
    *left = {part.first, middle - part.first, part.depth - 1};
    *right = {middle, part.first + part.count - middle, part.depth - 1};
  }

  /// Appends the part's tree to `nodes`; what it refers to counts from the first of them.
  BvhRef build(const Part& part, std::vector<BvhNode>* nodes) {
    if (is_leaf(part)) return bvh::triangles_ref(part.first, part.count);
    Part left, right;
    split(part, &left, &right);
    const auto node = static_cast<uint32_t>(nodes->size());
    nodes->emplace_back();
    const BvhRef a = build(left, nodes), b = build(right, nodes);
    (*nodes)[node].child[0] = a;
    (*nodes)[node].child[1] = b;
    return node;
  }

 private:
  struct Bin {
    BvhBox box;
    uint32_t count = 0;
  };

  BvhBox centers(const Part& part) const {
    BvhBox all;
    for (uint32_t i = part.first; i < part.first + part.count; ++i) all.add(items_[i].center);
    return all;
  }

  /// Both sides get an item; false where all centres are in one place.
  bool split_by_bins(const Part& part, uint32_t* middle) {
    const BvhBox span = centers(part);
    int best_axis = -1, best_bin = 0;
    float best_cost = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
      const float size = span.high[axis] - span.low[axis];
      if (!(size > 0)) continue;
      const float per_bin = kBins / size;
      if (!(per_bin < 1e30f)) continue;
      Bin bins[kBins];
      for (uint32_t i = part.first; i < part.first + part.count; ++i) {
        Bin& bin = bins[bin_of(items_[i], span, axis, per_bin)];
        bin.box.add(boxes_[items_[i].box]);
        ++bin.count;
      }
      float right_area[kBins];
      uint32_t right_count[kBins];
      BvhBox box;
      uint32_t count = 0;
      for (int b = kBins - 1; b > 0; --b) {
        box.add(bins[b].box);
        count += bins[b].count;
        right_area[b] = box.area();
        right_count[b] = count;
      }
      box = {};
      count = 0;
      for (int b = 1; b < kBins; ++b) {
        box.add(bins[b - 1].box);
        count += bins[b - 1].count;
        if (count == 0 || right_count[b] == 0) continue;
        const float cost = box.area() * static_cast<float>(count) +
                           right_area[b] * static_cast<float>(right_count[b]);
        if (cost < best_cost) {
          best_cost = cost;
          best_axis = axis;
          best_bin = b;
        }
      }
    }
    if (best_axis < 0) return false;
    const float per_bin = kBins / (span.high[best_axis] - span.low[best_axis]);
    const auto begin = items_.begin() + part.first;
    const auto cut = std::stable_partition(begin, begin + part.count, [&](const Item& item) {
      return bin_of(item, span, best_axis, per_bin) < best_bin;
    });
    *middle = static_cast<uint32_t>(cut - items_.begin());
    return *middle > part.first && *middle < part.first + part.count;
  }

  static int bin_of(const Item& item, const BvhBox& span, int axis, float per_bin) {
    return std::min(kBins - 1, static_cast<int>((item.center[axis] - span.low[axis]) * per_bin));
  }

  uint32_t split_in_half(const Part& part) {
    const BvhBox span = centers(part);
    const Vec3f size = span.high - span.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const auto begin = items_.begin() + part.first;
    std::nth_element(
        begin, begin + part.count / 2, begin + part.count, [axis](const Item& a, const Item& b) {
          return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis] : a.box < b.box;
        });
    return part.first + part.count / 2;
  }

  const std::vector<BvhBox>& boxes_;
  std::vector<Item>& items_;
  const BvhBuild options_;
};

/// Room for rounding in the box itself.
void set_child(const BvhBox& b, int side, BvhNode* node) {
  const Vec3f c = (b.low + b.high) * 0.5f;
  const auto half = [](float low, float high, float center) {
    return max(high - center, center - low) * (1 + 1e-6f) + fabsf(center) * 3e-7f;
  };
  node->center[side] = c;
  node->half[side] = {half(b.low.x, b.high.x, c.x), half(b.low.y, b.high.y, c.y),
                      half(b.low.z, b.high.z, c.z)};
}

}  // namespace

BvhTree build_bvh(const std::vector<BvhBox>& boxes, const BvhBuild& options) {
  GLOAM_CHECK(options.most_in_leaf >= 1 && options.most_in_leaf <= bvh::kMostTriangles,
              "a BVH leaf must hold one to eight triangles");
  std::vector<Item> items;
  items.reserve(boxes.size());
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    if (is_finite(boxes[i])) items.push_back({(boxes[i].low + boxes[i].high) * 0.5f, i});
  }
  BvhTree tree;
  if (items.empty()) return tree;
  const auto count = static_cast<uint32_t>(items.size());
  GLOAM_CHECK(
      items.size() < (1u << 27) && depth_of_halves(count, options.most_in_leaf) < options.depth,
      "a BVH can hold at most 134 million triangles and two million instances");
  Builder builder(boxes, &items, options);

  // The upper part of the tree one node after the other; what hangs below it side by side.
  std::vector<Part> tasks;
  struct Hanging {
    uint32_t node, side, task;
  };
  std::vector<Hanging> hanging;
  const Part all{0, count, options.depth};
  struct Open {
    Part part;
    uint32_t node, side;
  };
  std::vector<Open> open;
  const auto place = [&](const Part& part, uint32_t node, uint32_t side) {
    if (part.count > kTaskItems) {
      open.push_back({part, node, side});
    } else {
      hanging.push_back({node, side, static_cast<uint32_t>(tasks.size())});
      tasks.push_back(part);
    }
  };
  constexpr uint32_t kRoot = ~0u;
  place(all, kRoot, 0);
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const auto node = static_cast<uint32_t>(tree.nodes.size());
    tree.nodes.emplace_back();
    if (next.node == kRoot) {
      tree.root = node;
    } else {
      tree.nodes[next.node].child[next.side] = node;
    }
    Part left, right;
    builder.split(next.part, &left, &right);
    place(left, node, 0);
    place(right, node, 1);
  }
  std::vector<std::vector<BvhNode>> below(tasks.size());
  std::vector<BvhRef> roots(tasks.size());
  parallel_for("BVH", static_cast<int64_t>(tasks.size()), [&](int64_t i) {
    const auto k = static_cast<size_t>(i);
    roots[k] = builder.build(tasks[k], &below[k]);
  });
  for (const Hanging& h : hanging) {
    const auto shift = static_cast<uint32_t>(tree.nodes.size());
    const auto moved = [shift](BvhRef ref) { return (ref & bvh::kKind) == 0 ? ref + shift : ref; };
    for (BvhNode node : below[h.task]) {
      for (BvhRef& child : node.child) child = moved(child);
      tree.nodes.push_back(node);
    }
    BvhRef& ref = h.node == kRoot ? tree.root : tree.nodes[h.node].child[h.side];
    ref = moved(roots[h.task]);
  }
  tree.order.reserve(items.size());
  for (const Item& item : items) tree.order.push_back(item.box);
  refit_bvh(boxes, &tree);
  return tree;
}

float refit_bvh(const std::vector<BvhBox>& boxes, BvhTree* tree) {
  std::vector<BvhBox> of_node(tree->nodes.size());
  const auto box_of = [&](BvhRef ref) {
    if ((ref & bvh::kKind) == 0) return of_node[ref];
    BvhBox all;
    const uint32_t first = bvh::first_triangle(ref);
    for (uint32_t i = 0; i < bvh::triangle_count(ref); ++i) all.add(boxes[tree->order[first + i]]);
    return all;
  };
  float cost = 0;
  for (size_t n = tree->nodes.size(); n-- > 0;) {
    BvhNode& node = tree->nodes[n];
    for (int side = 0; side < 2; ++side) {
      const BvhBox b = box_of(node.child[side]);
      of_node[n].add(b);
      set_child(b, side, &node);
      cost += b.area();
    }
  }
  const float whole = tree->nodes.empty() ? 0.0f : of_node[0].area();
  return whole > 0 ? cost / whole : 0.0f;
}

}  // namespace gloam
