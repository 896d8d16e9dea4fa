#include "geometry/bvh/bvh_cache.h"

#include "base/archive.h"
#include "base/cache.h"
#include "base/cache_writer.h"
#include "base/files.h"
#include "base/hash.h"

namespace gloam {
namespace {

// "GLOMVH01": changes with what build_bvh gives.
constexpr uint64_t kBvhMagic = 0x313048564D4F4C47ull;

template <class F>
void visit_tree(F& f, BvhTree& tree, uint64_t& boxes) {
  f(boxes), f(tree.nodes), f(tree.root), f(tree.order);
}

}  // namespace

BvhTree build_bvh_cached(const std::vector<BvhBox>& boxes, const BvhBuild& options) {
  if (boxes.size() < kBvhWorthCaching) return build_bvh(boxes, options);
  const std::span<const BvhBox> content(boxes);
  const uint64_t key =
      hash_large(std::as_bytes(content)) ^ hash_bytes(&options, sizeof(options), kBvhMagic);
  const std::filesystem::path path = cache_folder(kBvhCache) / cache_entry_name(kBvhCache, key);
  if (const auto bytes = read_file(path, UINT64_MAX); bytes.ok()) {
    ArchiveReader in(unseal_cache_entry(kBvhMagic, *bytes));
    BvhTree tree;
    uint64_t count = 0;
    visit_tree(in, tree, count);
    if (in.is_done() && count == boxes.size()) {
      mark_cache_use(path);
      return tree;
    }
  }
  BvhTree tree = build_bvh(boxes, options);
  uint64_t count = boxes.size();
  ArchiveWriter out;
  begin_cache_entry(&out.bytes);
  visit_tree(out, tree, count);
  keep_in_cache_later(path, kBvhMagic, std::move(out.bytes));
  return tree;
}

}  // namespace gloam
