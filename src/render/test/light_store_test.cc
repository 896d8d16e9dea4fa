// Light of first images on disk: a start with it shows what a start without it shows.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/cache.h"
#include "base/cache_writer.h"
#include "render/test/interactive_picture.h"
#include "render/test/room_with_window.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

/// Two images, one after the other, by a renderer of its own.
struct Start {
  explicit Start(const SceneBuilder& b, uint64_t seed = 1) {
    const CameraView view =
        SceneBuilder::camera(look_at({1.5f, -1.5f, 1.5f}, {-1, 1, 0.5f}), 320, 240, 70);
    const auto renderer = b.make();
    const auto history = renderer->make_history();
    for (uint32_t i = 0; i < 2; ++i) {
      RenderSettings settings = interactive_settings(history.get(), i);
      settings.seed = seed;
      Film film;
      rays[i] = renderer->render(view, settings, &film).rays;
      images[i] = film.radiance;
    }
    finish_cache_writes();
  }
  std::vector<Vec3f> images[2];
  uint64_t rays[2];
};

class LightStore : public ::testing::Test {
 protected:
  LightStore() {
    std::string name = (fs::temp_directory_path() / "gloam-light-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    ::setenv("GLOAM_CACHE", folder_.c_str(), 1);
  }
  ~LightStore() override {
    ::unsetenv("GLOAM_CACHE");
    fs::remove_all(folder_);
  }
  static std::vector<fs::path> entries() {
    std::vector<fs::path> paths;
    std::error_code code;
    for (const auto& entry : fs::directory_iterator(cache_folder(kLightCache), code))
      paths.push_back(entry.path());
    return paths;
  }

 private:
  fs::path folder_;
};

TEST_F(LightStore, ASecondStartShowsTheSameWithFewerRays) {
  const SceneBuilder b = room_with_window({"lamp", 40, 0, 0}, false);
  const Start cold(b);
  ASSERT_EQ(entries().size(), 1u);
  const Start warm(b);
  EXPECT_EQ(entries().size(), 1u);
  EXPECT_EQ(warm.images[0], cold.images[0]);
  EXPECT_EQ(warm.images[1], cold.images[1]);
  EXPECT_LT(2 * warm.rays[0], cold.rays[0]);
  EXPECT_EQ(warm.rays[1], cold.rays[1]);
}

TEST_F(LightStore, AnotherSceneOrSeedHasAnEntryOfItsOwn) {
  SceneBuilder b = room_with_window({"lamp", 40, 0, 0}, false);
  const Start first(b);
  b.description.materials[0].base_color = {0.2f, 0.3f, 0.4f};
  const Start other(b);
  EXPECT_EQ(entries().size(), 2u);
  EXPECT_NE(other.images[0], first.images[0]);
  const Start reseeded(b, 2);
  EXPECT_EQ(entries().size(), 3u);
}

TEST_F(LightStore, ADamagedEntryIsMadeAgain) {
  const SceneBuilder b = room_with_window({"lamp", 40, 0, 0}, false);
  const Start cold(b);
  ASSERT_EQ(entries().size(), 1u);
  const fs::path entry = entries()[0];
  for (const auto damage : {0, 1}) {
    if (damage == 0) {
      fs::resize_file(entry, fs::file_size(entry) / 2);
    } else {
      std::fstream file(entry, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(static_cast<std::streamoff>(fs::file_size(entry) / 2));
      file.write("\xff\x7f\x01\x02", 4);
    }
    const Start again(b);
    EXPECT_EQ(again.images[0], cold.images[0]) << damage;
    EXPECT_EQ(again.rays[0], cold.rays[0]) << damage;
  }
}

}  // namespace
}  // namespace gloam
