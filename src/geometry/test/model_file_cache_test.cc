#include "geometry/mesh/model_file_cache.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <ctime>

#include "base/files.h"
#include "geometry/test/gltf_builder.h"
#include "geometry/test/read_helper.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder) {
  return {fs::directory_iterator(folder), fs::directory_iterator()};
}

GltfBuilder rich_file() {
  GltfBuilder file;
  file.add_triangle();
  file.json["images"] = {{{"uri", "a.png"}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["materials"] = {{{"name", "paint"},
                             {"pbrMetallicRoughness", {{"roughnessFactor", 0.25}}},
                             {"normalTexture", {{"index", 0}}}}};
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"name", "lamp"}}};
  file.push("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  file.json["animations"] = nlohmann::json::array();
  return file;
}

void expect_same(const ModelFile& a, const ModelFile& b) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  EXPECT_EQ(a.meshes[0].positions, b.meshes[0].positions);
  EXPECT_EQ(a.meshes[0].indices, b.meshes[0].indices);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  EXPECT_EQ(a.materials[0].name, b.materials[0].name);
  EXPECT_EQ(a.materials[0].roughness, b.materials[0].roughness);
  EXPECT_EQ(a.materials[0].normal_texture, b.materials[0].normal_texture);
  ASSERT_EQ(a.images.size(), b.images.size());
  EXPECT_EQ(a.images[0].bytes, b.images[0].bytes);
  ASSERT_EQ(a.instances.size(), b.instances.size());
  EXPECT_EQ(a.instances[0].material, b.instances[0].material);
  EXPECT_EQ(a.instances[0].X_FI.y, b.instances[0].X_FI.y);
  ASSERT_EQ(a.lights.size(), b.lights.size());
  EXPECT_EQ(a.lights[0].name, b.lights[0].name);
  EXPECT_EQ(a.notes, b.notes);
}

TEST(ModelFileCache, ASecondReadGivesTheSameUntilAFileChanges) {
  const TestFolder folder;
  const fs::path cache = folder.path / "cache";
  const GltfBuilder file = rich_file();
  const fs::path path = folder.write("m/m.gltf", file.gltf_with_file("m.bin"));
  folder.write("m/m.bin", std::string(file.bin.begin(), file.bin.end()));
  folder.write("m/a.png", "picture");
  bool was_cached = true;
  const auto read = [&] {
    Result<ModelFile> model = read_model_file_cached(path, cache, {}, &was_cached);
    finish_cache_writes();
    return std::move(model).value();
  };
  const ModelFile first = read();
  EXPECT_FALSE(was_cached);
  EXPECT_EQ(first.materials.at(0).roughness, 0.25f);
  const ModelFile second = read();
  EXPECT_TRUE(was_cached);
  expect_same(first, second);

  folder.write("m/a.png", "another");
  EXPECT_EQ(read().images.at(0).bytes[0], 'a');
  EXPECT_FALSE(was_cached);
  read();
  EXPECT_TRUE(was_cached);

  std::vector<Vec3f> moved = {{0, 0, 0}, {5, 0, 0}, {0, 1, 0}};
  folder.write("m/m.bin", std::string(reinterpret_cast<const char*>(moved.data()), 36));
  EXPECT_EQ(read().meshes.at(0).positions, moved);
  EXPECT_FALSE(was_cached);

  // Errors are not kept, and a file that is gone is an error however warm the cache is.
  fs::remove(folder.path / "m/m.bin");
  EXPECT_FALSE(read_model_file_cached(path, cache).ok());
}

TEST(ModelFileCache, AMissingPictureOfAnObjThatTurnsUpIsRead) {
  const TestFolder folder;
  const fs::path cache = folder.path / "cache";
  const fs::path path = folder.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  bool was_cached = false;
  EXPECT_EQ(read_model_file_cached(path, cache)->materials.size(), 0u);
  finish_cache_writes();
  EXPECT_EQ(read_model_file_cached(path, cache, {}, &was_cached)->materials.size(), 0u);
  EXPECT_TRUE(was_cached);
  folder.write("m.mtl", "newmtl a\n");
  EXPECT_EQ(read_model_file_cached(path, cache, {}, &was_cached)->materials.size(), 1u);
  EXPECT_FALSE(was_cached);
  EXPECT_EQ(read_model_file_cached(path, cache)->parts, std::vector<std::string>({"m.mtl"}));
}

TEST(ModelFileCache, DamagedEntriesAndUnusableFoldersDoNoHarm) {
  const TestFolder folder;
  const fs::path cache = folder.path / "cache";
  GltfBuilder file;
  file.add_triangle();
  const fs::path path = folder.write("m.glb", file.glb());
  const auto whole_model = read_model_file_cached(path, cache).value();
  finish_cache_writes();
  const std::vector<fs::path> entries = files_in(cache);
  ASSERT_EQ(entries.size(), 1u);
  const std::vector<uint8_t> whole = read_file(entries[0]).value();
  bool was_cached = true;
  for (size_t i = 0; i < whole.size(); ++i) {
    std::vector<uint8_t> bytes = whole;
    if (i % 2 == 0)
      bytes.resize(i);
    else
      bytes[i] ^= 0x40;
    ASSERT_TRUE(write_file_atomic(entries[0], bytes).ok());
    const Result<ModelFile> model = read_model_file_cached(path, cache, {}, &was_cached);
    finish_cache_writes();
    ASSERT_TRUE(model.ok());
    EXPECT_FALSE(was_cached) << i;
    EXPECT_EQ(model->meshes.at(0).positions, whole_model.meshes[0].positions);
  }
  folder.write("file", "not a folder");
  EXPECT_TRUE(read_model_file_cached(path, folder.path / "file").ok());
}

// The entry is made of what was read, whatever the reader's caller does with that meanwhile, and
// the same file may be read again before it is written.
TEST(ModelFileCache, EntriesAreWrittenBehindTheCaller) {
  const TestFolder folder;
  const fs::path cache = folder.path / "cache";
  GltfBuilder file;
  file.add_triangle();
  const fs::path path = folder.write("m.glb", file.glb());
  ModelFile first = read_model_file_cached(path, cache).value();
  EXPECT_FALSE(fs::exists(cache));
  const std::vector<Vec3f> positions = std::exchange(first.meshes.at(0).positions, {});
  bool was_cached = true;
  EXPECT_EQ(read_model_file_cached(path, cache, {}, &was_cached)->meshes[0].positions, positions);
  EXPECT_FALSE(was_cached);
  finish_cache_writes();
  EXPECT_EQ(files_in(cache).size(), 1u);
  EXPECT_EQ(read_model_file_cached(path, cache, {}, &was_cached)->meshes[0].positions, positions);
  EXPECT_TRUE(was_cached);
}

// A grid of n x n squares with a height that no two vertices share.
struct Grid {
  explicit Grid(int n) {
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x)
        positions.push_back({static_cast<float>(x) * 0.01f, static_cast<float>(y) * 0.01f,
                             std::sin(static_cast<float>(x * 7 + y * 13))});
    const auto row = static_cast<uint32_t>(n + 1);
    for (uint32_t y = 0; y + 1 < row; ++y)
      for (uint32_t x = 0; x + 1 < row; ++x) {
        const uint32_t a = y * row + x;
        indices.insert(indices.end(), {a, a + 1, a + row, a + row, a + 1, a + row + 1});
      }
  }
  std::string obj() const {
    std::string out;
    for (const Vec3f& p : positions) out += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (size_t i = 0; i < indices.size(); i += 3)
      out += fmt::format("f {} {} {}\n", indices[i] + 1, indices[i + 1] + 1, indices[i + 2] + 1);
    return out;
  }
  std::string glb() const {
    GltfBuilder file;
    const int p = file.add_positions(positions);
    const int i = file.add_accessor(indices, "SCALAR", 5125, indices.size());
    const int mesh = file.add_mesh({{"attributes", {{"POSITION", p}}}, {"indices", i}});
    file.push("nodes", {{"mesh", mesh}});
    return file.glb();
  }
  std::vector<Vec3f> positions;
  std::vector<uint32_t> indices;
};

struct Seconds {
  double wall, cpu;
};
template <class F>
Seconds time_of(F&& f) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  f();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC};
}

// GLOAM_BIG_MESH=1000 makes it two million triangles and prints what the readers take.
TEST(ModelFileCache, BigMeshesComeBackWholeFromBothFormats) {
  const char* size = std::getenv("GLOAM_BIG_MESH");
  const Grid grid(size != nullptr ? std::atoi(size) : 100);
  const TestFolder folder;
  for (const auto& [name, text] : {std::pair{"big.obj", grid.obj()}, {"big.glb", grid.glb()}}) {
    const fs::path path = folder.write(name, text);
    Result<ModelFile> model = ModelFile{};
    const auto check = [&] {
      ASSERT_TRUE(model.ok()) << error_of(model);
      const TriangleMesh& mesh = model->meshes.at(0);
      ASSERT_EQ(mesh.positions.size(), grid.positions.size());
      ASSERT_EQ(mesh.indices.size(), grid.indices.size());
      size_t different = 0;
      for (size_t i = 0; i < mesh.indices.size(); ++i)
        different += mesh.positions[mesh.indices[i]] == grid.positions[grid.indices[i]] ? 0 : 1;
      ASSERT_EQ(different, 0u);
    };
    const auto cached = [&] { model = read_model_file_cached(path, folder.path / "cache"); };
    const Seconds plain = time_of([&] { model = read_model_file(path); });
    check();
    const Seconds first = time_of(cached);
    finish_cache_writes();
    check();
    const Seconds second = time_of(cached);
    check();
    if (size == nullptr) continue;
    const double mb = static_cast<double>(text.size()) / 1e6;
    fmt::print(
        "{}: {} triangles, {:.1f} MB, {:.0f} MB/s; wall (CPU): no cache {:.3f} ({:.3f}) s, "
        "first {:.3f} ({:.3f}) s, cached {:.3f} ({:.3f}) s\n",
        name, grid.indices.size() / 3, mb, mb / plain.wall, plain.wall, plain.cpu, first.wall,
        first.cpu, second.wall, second.cpu);
    if (const char* keep = std::getenv("GLOAM_BIG_MESH_FOLDER"))
      fs::copy_file(path, fs::path(keep) / name, fs::copy_options::overwrite_existing);
  }
}

}  // namespace
}  // namespace gloam
