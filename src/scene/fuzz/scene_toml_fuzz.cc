// Any bytes as a scene file: an Error or a Scene, never a crash. Errors are one line with a place.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/test/custom_mutator.h"
#include "scene/randomize/randomize.h"
#include "scene/test/toml_mutator.h"
#include "scene/toml/toml_reader.h"
#include "scene/validate/validate.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  gloam::Scene scene;
  const gloam::Status status = gloam::read_scene_toml(text, "fuzz.toml", &scene);
  if (status.ok()) {
    if (gloam::validate_scene(scene).ok()) {
      std::vector<gloam::DrawnOption> drawn;
      (void)gloam::draw_options(gloam::DrawStage::kPlace, &scene, &drawn).ok();
      (void)gloam::draw_options(gloam::DrawStage::kRest, &scene, &drawn).ok();
    }
  } else if (status.error().message.empty() ||
             status.error().to_string().find('\n') != std::string::npos) {
    std::abort();
  }
  const size_t split = text.find('=');
  if (split != std::string::npos) {
    gloam::Scene target;
    target.robots.emplace_back().name = "a";
    target.cameras.emplace_back().name = "b";
    (void)gloam::set_option(target, std::string_view(text).substr(0, split),
                            std::string_view(text).substr(split + 1))
        .ok();
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned seed) {
  return gloam::mutate_structure(data, size, max_size, seed, gloam::mutate_toml);
}
