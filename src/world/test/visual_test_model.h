#pragma once
// Small models for the tests of the render description.

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "world/render_description.h"
#include "world/world.h"

namespace gloam::visual_test {

/// Compiles inline MJCF as stock MuJoCo does.
inline CompiledWorld compile(const std::string& xml) {
  char error[1000] = "";
  CompiledWorld world;
  world.scene.render.look =
      RenderLook::kModel;  // the rules of MuJoCo's own light are what is tested
  const SpecPtr spec{mj_parseXMLString(xml.c_str(), nullptr, error, sizeof(error))};
  if (spec != nullptr) world.model.reset(mj_compile(spec.get(), nullptr));
  EXPECT_NE(world.model, nullptr) << error << (spec ? mjs_getError(spec.get()) : "");
  return world;
}

inline RenderDescription describe(const CompiledWorld& world) {
  auto result = describe_for_rendering(world);
  EXPECT_TRUE(result.ok());
  return std::move(result).value();
}
inline RenderDescription describe(const std::string& xml) { return describe(compile(xml)); }

/// Why a world cannot be described; "" where it can.
inline std::string refusal(const CompiledWorld& world) {
  const auto result = describe_for_rendering(world);
  return result.ok() ? "" : result.error().to_string();
}

inline void expect_near(Vec3f a, Vec3f b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

}  // namespace gloam::visual_test
