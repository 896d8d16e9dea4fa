// The gas as a fluid: vortices that should last, air that should rest, and published laws of how
// warm air rises.

#include <numeric>

#include "gas_room.h"

namespace gloam {
namespace {

/// Eddies of Taylor and Green between slippery walls: without viscosity they turn for ever. Returns
/// the shares of the kinetic energy that is lost, and of the velocity that is wrong (root of the
/// mean square), after a quarter of a turn of the box.
std::pair<double, double> taylor_green_losses(int n) {
  const float size = 1, speed = 1;
  const GasGrid grid{n, n, 4, size / float(n), {}};
  auto gas = make_gas(grid, closed_box());
  std::vector<float> u(grid.faces(0)), v(grid.faces(1));
  const GasWalls layout(grid);
  const float k = 2 * kPi / size;
  for (int z = 0; z < 4; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x <= n; ++x) {
        u[layout.face(0, x, y, z)] =
            speed * std::sin(k * float(x) * grid.voxel) * std::cos(k * (float(y) + 0.5f) * grid.voxel);
        v[layout.face(1, y, x, z)] = -speed * std::sin(k * float(x) * grid.voxel) *
                                     std::cos(k * (float(y) + 0.5f) * grid.voxel);
      }
    }
  }
  gas->set_velocity(0, u);
  gas->set_velocity(1, v);
  const float dt = 0.5f * grid.voxel / speed;
  const int steps = int(0.5f * size / speed / dt);
  for (int s = 0; s < steps; ++s) gas->step(dt, {}, {});
  double energy = 0, initial = 0, error = 0;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const Vec3f p{(float(x) + 0.5f) * grid.voxel, (float(y) + 0.5f) * grid.voxel, grid.voxel * 2};
      const Vec3f is = gas->velocity_at(p);
      const Vec3f was{speed * std::sin(k * p.x) * std::cos(k * p.y),
                      -speed * std::cos(k * p.x) * std::sin(k * p.y), 0};
      energy += double(length_squared(is));
      initial += double(length_squared(was));
      error += double(length_squared(is - was));
    }
  }
  return {1 - energy / initial, std::sqrt(error / initial)};
}

TEST(GasFlow, EddiesLastAndLastLongerOnFinerGrids) {
  double last_error = 1;
  for (const int n : {16, 32, 64}) {
    const auto [lost, error] = taylor_green_losses(n);
    printf("Taylor-Green, %d cells: %.4f of the energy lost, %.4f of the velocity wrong\n", n, lost,
           error);
    EXPECT_LT(error, 0.5 * last_error) << "at " << n << " cells";
    last_error = error;
  }
}

}  // namespace
}  // namespace gloam
