// The numbers here were read out of pictures of MuJoCo 4.0.0's classic renderer, of a texture whose
// texel at column i and row j (from the top) is (i / 127, j / 127). Half a texel and 8 bits make
// them good to 0.02.

#include <gtest/gtest.h>

#include <cmath>

#include "world/materials/texture_coordinates.h"

namespace gloam {
namespace {

struct Case {
  ShapeType shape;
  Vec3f size, p, n;
  float s, t;  // as seen by the renderer, t down the image
  Vec2f repeat{1, 1};
  bool uniform = false;
};

constexpr float kTolerance = 0.02f;

float distance_modulo_one(float a, float b) {
  const float d = a - b - std::floor(a - b);
  return std::fmin(d, 1 - d);
}

void expect_case(const Case& c) {
  const Vec2f uv = texture_uv(c.shape, c.p, c.n, c.size, {}, false, c.repeat, c.uniform);
  EXPECT_LT(distance_modulo_one(uv.x, c.s), kTolerance)
      << "shape " << int(c.shape) << " at " << c.p.x << " " << c.p.y << " " << c.p.z << ": "
      << uv.x;
  EXPECT_LT(distance_modulo_one(1 - uv.y, c.t), kTolerance)
      << "shape " << int(c.shape) << " at " << c.p.x << " " << c.p.y << " " << c.p.z << ": "
      << uv.y;
}

float sphere_height(float x, float y, float r) { return std::sqrt(r * r - x * x - y * y); }

TEST(VisualTexture, PlaneMatchesMuJoCo) {
  const Vec3f size{.4f, .2f, 0}, up{0, 0, 1};
  const auto shape = ShapeType::kPlane;
  expect_case({shape, size, {.05f, .01f, 0}, up, .56f, .47f});
  expect_case({shape, size, {.01f, .05f, 0}, up, .51f, .37f});
  expect_case({shape, size, {.05f, .01f, 0}, up, .12f, .42f, {2, 3}});
  expect_case({shape, size, {.01f, .05f, 0}, up, .02f, .12f, {2, 3}});
  expect_case({shape, size, {.05f, .01f, 0}, up, .22f, .09f, {1, 1}, true});
  expect_case({shape, size, {.01f, .05f, 0}, up, .41f, .22f, {2, 3}, true});
}

TEST(VisualTexture, InfinitePlaneRepeatsOverTwoMetres) {
  for (const bool uniform : {false, true}) {
    expect_case({ShapeType::kPlane, {}, {.05f, .01f, 0}, {0, 0, 1}, .53f, .49f, {1, 1}, uniform});
    expect_case({ShapeType::kPlane, {}, {.3f, .3f, 0}, {0, 0, 1}, .8f, .05f, {2, 3}, uniform});
    expect_case({ShapeType::kPlane, {}, {.3f, .3f, 0}, {0, 0, 1}, .58f, .39f, {.5f, .7f}, uniform});
  }
}

TEST(VisualTexture, BoxMatchesMuJoCoOnEveryFace) {
  const Vec3f size{.4f, .2f, .1f};
  const auto box = ShapeType::kBox;
  expect_case({box, size, {.05f, .01f, .1f}, {0, 0, 1}, .56f, .47f});
  expect_case({box, size, {.01f, -.05f, -.1f}, {0, 0, -1}, .51f, .63f});
  expect_case({box, size, {.4f, .05f, .01f}, {1, 0, 0}, .63f, .45f});
  expect_case({box, size, {.4f, .01f, .05f}, {1, 0, 0}, .53f, .25f});
  expect_case({box, size, {-.4f, -.05f, .01f}, {-1, 0, 0}, .37f, .45f});
  expect_case({box, size, {-.05f, .2f, .01f}, {0, 1, 0}, .44f, .45f});
  expect_case({box, size, {.05f, -.2f, .01f}, {0, -1, 0}, .56f, .45f});
  expect_case({box, size, {.4f, .05f, .01f}, {1, 0, 0}, .25f, .09f, {1, 1}, true});
  expect_case({box, size, {.4f, .01f, .05f}, {1, 0, 0}, .42f, .15f, {2, 3}, true});
}

TEST(VisualTexture, RoundShapesMatchMuJoCo) {
  const Vec3f n{};
  const auto sphere = ShapeType::kSphere;
  expect_case({sphere, {.3f, 0, 0}, {.05f, .01f, sphere_height(.05f, .01f, .3f)}, n, .03f, .05f});
  expect_case({sphere, {.3f, 0, 0}, {.01f, -.05f, -sphere_height(.05f, .01f, .3f)}, n, .78f, .95f});
  expect_case({sphere, {.3f, 0, 0}, {sphere_height(.01f, .05f, .3f), .01f, .05f}, n, 0, .44f});
  const auto ellipsoid = ShapeType::kEllipsoid;
  const Vec3f axes{.4f, .2f, .1f};
  expect_case({ellipsoid, axes, {.4f * std::sqrt(1 - .0625f - .01f), .05f, .01f}, n, .04f, .47f});
  expect_case({ellipsoid,
               axes,
               {.01f, -.05f, -.1f * std::sqrt(1 - .000625f - .0625f)},
               n,
               .30f,
               .18f,
               {1, 1},
               true});
  const auto cylinder = ShapeType::kCylinder;
  const Vec3f tin{.2f, .3f, 0};
  expect_case({cylinder, tin, {.05f, .01f, .3f}, {0, 0, 1}, .63f, .53f});
  expect_case({cylinder, tin, {.01f, .05f, .3f}, {0, 0, 1}, .53f, .63f});
  expect_case({cylinder, tin, {.01f, -.05f, -.3f}, {0, 0, -1}, .53f, .37f});
  expect_case({cylinder, tin, {std::sqrt(.04f - .0025f), .05f, .01f}, {1, 0, 0}, .04f, .48f});
  const auto capsule = ShapeType::kCapsule;
  const Vec3f pill{.1f, .2f, 0};
  expect_case({capsule, pill, {.05f, .01f, .2f + sphere_height(.05f, .01f, .1f)}, n, .03f, .34f});
  expect_case({capsule, pill, {.01f, -.01f, -.2f - sphere_height(.01f, .01f, .1f)}, n, .88f, .91f});
  expect_case({capsule, pill, {sphere_height(.05f, 0, .1f), .05f, .01f}, n, .08f, .47f});
  expect_case({capsule, pill, {sphere_height(.01f, 0, .1f), .01f, .05f}, n, .03f, .12f, {2, 3}});
}

TEST(VisualTexture, MeshesMatchMuJoCo) {
  // With coordinates (u right, v up): a square of 0.4 m from the origin, seen at (0.08, 0.04).
  const auto of_uv = [](Vec2f uv, Vec2f repeat, bool uniform) {
    return texture_uv(ShapeType::kMesh, {}, {0, 0, 1}, {.05f, .2f, .2f}, uv, true, repeat, uniform);
  };
  const Vec2f plain = of_uv({.2f, .1f}, {1, 1}, false);
  EXPECT_NEAR(plain.x, .2f, 1e-6);
  EXPECT_NEAR(plain.y, .1f, 1e-6);
  const Vec2f repeated = of_uv({.2f, .1f}, {2, 3}, false);
  EXPECT_LT(distance_modulo_one(repeated.x, .4f), kTolerance);
  EXPECT_LT(distance_modulo_one(1 - repeated.y, .7f), kTolerance);
  const Vec2f uniform = of_uv({.2f, .1f}, {1, 1}, true);
  EXPECT_LT(distance_modulo_one(uniform.x, .01f), kTolerance);
  EXPECT_LT(distance_modulo_one(1 - uniform.y, .18f), kTolerance);
  // Without: projected along z.
  const Vec3f size{.05f, .1f, .2f};
  expect_case({ShapeType::kMesh, size, {.01f, -.01f, .2f}, {}, .6f, .55f});
  expect_case({ShapeType::kMesh, size, {.01f, -.05f, .2f}, {}, .7f, .24f, {2, 3}});
  expect_case({ShapeType::kMesh, size, {.01f, -.05f, .2f}, {}, .51f, .58f, {2, 3}, true});
  const Vec3f terrain{.4f, .2f, .1f};
  expect_case({ShapeType::kMesh, terrain, {.05f, -.02f, 0}, {}, .56f, .55f});
  expect_case({ShapeType::kMesh, terrain, {.01f, -.04f, 0}, {}, .53f, .8f, {2, 3}});
}

void expect_cube(ShapeType shape, Vec3f size, Vec3f p, bool uniform, int face, float s, float t) {
  const CubeTexel texel = cube_texel(texture_cube_direction(shape, p, size, uniform));
  EXPECT_EQ(texel.face, face);
  EXPECT_NEAR(texel.uv.x, s, kTolerance);
  EXPECT_NEAR(1 - texel.uv.y, t, kTolerance);
}

TEST(VisualTexture, CubeTexturesMatchMuJoCo) {
  const Vec3f size{.4f, .2f, .1f};
  const auto box = ShapeType::kBox;
  expect_cube(box, size, {.4f, .05f, .01f}, false, 0, .45f, .37f);
  expect_cube(box, size, {-.4f, -.01f, .05f}, false, 1, .75f, .53f);
  expect_cube(box, size, {-.05f, .2f, .01f}, false, 2, .44f, .55f);
  expect_cube(box, size, {.01f, -.2f, .05f}, false, 3, .51f, .25f);
  expect_cube(box, size, {.05f, .01f, .1f}, false, 4, .56f, .47f);
  expect_cube(box, size, {.01f, -.05f, -.1f}, false, 5, .49f, .63f);
  expect_cube(box, size, {.05f, .01f, .1f}, true, 4, .75f, .45f);
  expect_cube(box, size, {.4f, .05f, .01f}, true, 0, .49f, .44f);
  const float z = .2f + sphere_height(.05f, .01f, .1f);
  expect_cube(ShapeType::kCapsule, {.1f, .2f, 0}, {.05f, .01f, z}, false, 4, .64f, .47f);
  expect_cube(ShapeType::kCapsule, {.1f, .2f, 0}, {.05f, .01f, z}, true, 4, .57f, .49f);
  expect_cube(ShapeType::kCylinder, {.2f, .3f, 0}, {.05f, .01f, .3f}, false, 4, .63f, .47f);
  expect_cube(ShapeType::kCylinder, {.2f, .3f, 0}, {.05f, .01f, .3f}, true, 4, .58f, .48f);
  expect_cube(ShapeType::kMesh, {.05f, .1f, .2f}, {.05f, -.01f, .01f}, false, 0, .4f, .6f);
  expect_cube(ShapeType::kMesh, {.05f, .1f, .2f}, {.05f, -.01f, .01f}, true, 0, .12f, .7f);
}

TEST(VisualTexture, SkyStandsUprightAsInMuJoCo) {
  // Looking along an axis, 0.3 of the picture's height to the right, at 60 degrees of view.
  const float a = .3f * 2 * std::tan(kPi / 6);
  const auto expect_sky = [](Vec3f d, int face, float s, float t) {
    const CubeTexel texel = cube_texel(sky_cube_direction(d));
    EXPECT_EQ(texel.face, face);
    EXPECT_NEAR(texel.uv.x, s, kTolerance);
    EXPECT_NEAR(1 - texel.uv.y, t, kTolerance);
  };
  expect_sky({1, -a, 0}, 0, .33f, .49f);
  expect_sky({1, 0, a}, 0, .49f, .33f);
  expect_sky({-1, a, 0}, 1, .33f, .49f);
  expect_sky({a, 1, 0}, 5, .33f, .49f);
  expect_sky({-a, -1, 0}, 4, .33f, .49f);
  expect_sky({a, 0, 1}, 2, .67f, .51f);
  expect_sky({0, -a, 1}, 2, .51f, .67f);
  expect_sky({a, 0, -1}, 3, .67f, .51f);
}

}  // namespace
}  // namespace gloam
