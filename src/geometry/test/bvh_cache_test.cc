#include "geometry/bvh/bvh_cache.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "base/cache.h"
#include "base/files.h"
#include "geometry/test/read_helper.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

std::vector<BvhBox> boxes_of(size_t count) {
  std::vector<BvhBox> boxes(count);
  for (size_t i = 0; i < count; ++i) {
    const float t = static_cast<float>(i);
    boxes[i].add(Vec3f{std::sin(t), std::cos(0.7f * t), 0.001f * t});
    boxes[i].add(Vec3f{std::sin(t) + 0.01f, std::cos(0.7f * t), 0.001f * t + 0.02f});
  }
  return boxes;
}

std::vector<fs::path> entries_now() {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(cache_folder(kBvhCache)))
    paths.push_back(entry.path());
  return paths;
}

void expect_same(const BvhTree& a, const BvhTree& b) {
  EXPECT_EQ(a.root, b.root);
  EXPECT_EQ(a.order, b.order);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BvhNode)), 0);
}

TEST(BvhCache, ASecondTreeIsTheFirst) {
  const TestFolder folder;
  ::setenv("GLOAM_CACHE", (folder.path / "cache").c_str(), 1);
  const BvhBuild options{4, bvh::kMeshDepth};
  std::vector<BvhBox> boxes = boxes_of(kBvhWorthCaching);
  const BvhTree built = build_bvh(boxes, options);
  const auto cached = [&](const BvhBuild& how) {
    BvhTree tree = build_bvh_cached(boxes, how);
    finish_cache_writes();
    return tree;
  };
  expect_same(cached(options), built);
  const std::vector<fs::path> entries = entries_now();
  ASSERT_EQ(entries.size(), 1u);
  expect_same(cached(options), built);

  // It is read: another tree in the entry is what comes back.
  const std::vector<uint8_t> whole = read_file(entries[0]).value();
  const BvhBuild coarse{8, bvh::kMeshDepth};
  cached(coarse);
  ASSERT_EQ(entries_now().size(), 2u);
  for (const fs::path& entry : entries_now()) ASSERT_TRUE(write_file_atomic(entry, whole).ok());
  expect_same(cached(coarse), built);

  // A damaged one is not.
  std::vector<uint8_t> bad = whole;
  bad[bad.size() / 2] ^= 1;
  ASSERT_TRUE(write_file_atomic(entries[0], bad).ok());
  expect_same(cached(options), built);
  EXPECT_EQ(read_file(entries[0]).value(), whole);  // and mended

  boxes[5].add(Vec3f{9, 9, 9});
  expect_same(cached(options), build_bvh(boxes, options));
  ASSERT_EQ(entries_now().size(), 3u);
  build_bvh_cached(boxes_of(1000), options);  // not worth it
  ASSERT_EQ(entries_now().size(), 3u);
  ::unsetenv("GLOAM_CACHE");
}

}  // namespace
}  // namespace gloam
