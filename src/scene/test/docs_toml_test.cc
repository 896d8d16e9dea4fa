// The scenes that the manual shows are scenes.

#include <gtest/gtest.h>

#include "base/files.h"
#include "base/test/source_dir.h"
#include "scene/toml/toml_reader.h"
#include "scene/validate/validate.h"

namespace gloam {
namespace {

class Manual : public ::testing::TestWithParam<const char*> {};

TEST_P(Manual, ShowsValidScenes) {
  const std::string path = source_dir() / "docs" / GetParam();
  const Result<std::string> text = read_text_file(path);
  ASSERT_TRUE(text.ok()) << text.error().to_string();
  const std::string fence = "```toml\n";
  int blocks = 0;
  for (size_t at = text->find(fence); at != std::string::npos; at = text->find(fence, at)) {
    at += fence.size();
    const size_t end = text->find("```", at);
    Scene scene;
    Status status = read_scene_toml(text->substr(at, end - at), GetParam(), &scene);
    if (status.ok()) status = validate_scene(scene);
    EXPECT_TRUE(status.ok()) << status.error().to_string() << " in\n" << text->substr(at, end - at);
    at = end + 3;
    ++blocks;
  }
  EXPECT_GT(blocks, 0);
}

INSTANTIATE_TEST_SUITE_P(Pages, Manual,
                         ::testing::Values("scenes.md", "materials.md", "light.md", "media.md",
                                           "import.md", "cameras.md", "lidar.md", "sensors.md",
                                           "environments.md", "effects.md", "water.md", "soil.md",
                                           "wind.md", "agents.md", "weather.md"));

}  // namespace
}  // namespace gloam
