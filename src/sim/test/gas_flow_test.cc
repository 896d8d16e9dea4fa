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
        u[layout.face(0, x, y, z)] = speed * std::sin(k * float(x) * grid.voxel) *
                                     std::cos(k * (float(y) + 0.5f) * grid.voxel);
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

TEST(GasFlow, EddiesLastAndErrorsFallWithTheSquareOfTheVoxels) {
  double last_error = 0.16;
  for (const int n : {16, 32, 64}) {
    const auto [lost, error] = taylor_green_losses(n);
    printf("Taylor-Green, %d cells: %.4f of the energy lost, %.4f of the velocity wrong\n", n, lost,
           error);
    EXPECT_LT(error, 0.3 * last_error) << "of the velocity is wrong at " << n << " cells";
    EXPECT_GT(lost, -0.001) << "energy came from nowhere at " << n << " cells";
    EXPECT_LT(lost, 0.16 * std::pow(16.0 / n, 2)) << "of the energy is lost at " << n << " cells";
    last_error = error;
  }
}

TEST(GasFlow, WarmAirAboveColdRests) {
  const GasGrid grid{20, 16, 24, 0.1f, {}};
  GasProperties p = closed_box();
  p.cooling = 0;
  auto gas = make_gas(grid, p);
  GasWalls walls(grid);
  add_solid(&walls, {5, 5, 5}, {9, 9, 20});
  gas->set_walls(walls);
  GasSource layer;  // the upper half, as warm everywhere
  layer.box = true;
  layer.X_WS.p = {1, 0.8f, 1.8f};
  layer.half_size = {2, 2, 0.6f};
  layer.heat = 40e3f;
  for (int n = 0; n < 20; ++n) gas->step(0.1f, std::span(&layer, 1), {});
  float speed = 0;
  for (int n = 0; n < 100; ++n) speed = gas->step(0.1f, {}, {}).max_speed;
  std::vector<float> soot, kelvin;
  gas->read(&soot, &kelvin);
  const float above = kelvin[walls.cell(15, 10, 20)], below = kelvin[walls.cell(15, 10, 3)];
  printf("%.1f K above %.1f K moves at %.2g m/s after 10 s\n", above, below, speed);
  EXPECT_GT(above, below + 10) << "K: the layers are gone";
  EXPECT_LT(speed, 0.02) << "m/s: what is warm above should rest";
}

/// Means over time, in the plane at some height.
struct Plume {
  double flow = 0;   ///< upwards [m³/s]
  double speed = 0;  ///< where the mean is greatest [m/s]
  double rise = 0;   ///< of temperature, where the mean is greatest [K]
};

/// Height from which plumes of a source of 0.5 m seem to come [m] (Heskestad 1983). Q: [kW].
double virtual_origin(double q) { return 0.083 * std::pow(q, 0.4) - 1.02 * 0.5; }

/// Heskestad's laws (SFPE Handbook, "Fire plumes"), which are those of Morton, Taylor and Turner
/// (1956) with measured constants. Q: [kW].
Plume heskestad(double q, double height) {
  const double z = height - virtual_origin(q);
  // Mass flow 0.071 Q^(1/3) z^(5/3) [kg/s] (Zukoski; far from the source).
  return {0.071 / 1.204 * std::cbrt(q) * std::pow(z, 5.0 / 3.0),
          1.03 * std::cbrt(q) * std::pow(z, -1.0 / 3.0),
          25.0 * std::pow(q, 2.0 / 3.0) * std::pow(z, -5.0 / 3.0)};
}

constexpr double kPlumePower = 20;  ///< [kW]

GasSource plume_source() {
  GasSource source = ball({0, 0, 0.2f}, 0.25f);
  source.heat = float(kPlumePower) * 1e3f;
  return source;
}

/// Within what the grid does not resolve.
void check_plume(float voxel) {
  const GasGrid grid = plume_grid(voxel, 4.4f);
  auto gas = make_plume(grid);
  const double q = kPlumePower;
  const GasSource source = plume_source();
  const double heights[] = {2, 2.8, 3.6};
  const size_t plane = size_t(grid.nx) * size_t(grid.ny);
  std::vector<double> speed[3], rise[3];
  for (int h = 0; h < 3; ++h) speed[h].assign(plane, 0), rise[h].assign(plane, 0);
  const int settle = 80, steps = 200;
  std::vector<float> soot, kelvin;
  for (int n = 0; n < settle + steps; ++n) {
    gas->step(0.1f, std::span(&source, 1), {});
    if (n < settle) continue;
    gas->read(&soot, &kelvin);
    for (int h = 0; h < 3; ++h) {
      const int k = int(heights[h] / double(voxel));
      for (size_t c = 0; c < plane; ++c) {
        const Vec3f at{float(c % size_t(grid.nx)) + .5f, float(c / size_t(grid.nx)) + .5f,
                       float(k) + .5f};
        const float w = gas->velocity_at(grid.low + at * voxel).z;
        const float t = kelvin[size_t(k) * plane + c] - 293;
        speed[h][c] += double(w) / steps;
        rise[h][c] += double(t) / steps;
      }
    }
  }
  for (int h = 0; h < 3; ++h) {
    const Plume law = heskestad(q, heights[h]);
    const double fastest = *std::max_element(speed[h].begin(), speed[h].end());
    const double warmest = *std::max_element(rise[h].begin(), rise[h].end());
    double flow = 0;  // of the plume: where it is warmer by more than a tenth of that
    for (size_t c = 0; c < plane; ++c) {
      if (rise[h][c] > 0.1 * warmest) flow += speed[h][c] * double(voxel * voxel);
    }
    printf(
        "voxels of %.2f m, %.1f m up: %.2f m3/s (law %.2f), %.2f m/s (%.2f), %.0f K warmer "
        "(%.0f)\n",
        double(voxel), heights[h], flow, law.flow, fastest, law.speed, warmest, law.rise);
    EXPECT_NEAR(flow, law.flow, 0.35 * law.flow) << "m3/s at " << heights[h] << " m";
    EXPECT_NEAR(fastest, law.speed, 0.2 * law.speed) << "m/s at " << heights[h] << " m";
    EXPECT_NEAR(warmest, law.rise, 0.45 * law.rise) << "K at " << heights[h] << " m";
  }
}

/// The front is where the plume is a quarter as much warmer as on the axis of a steady one.
double front_of_plume(const GasSolver& gas) {
  return front_of(gas, [](double z) { return 0.25 * heskestad(kPlumePower, z).rise; });
}

/// The cap of a plume that starts rises at 0.61 of the speed on the axis of a steady one (Turner
/// 1962, "The starting plume in neutral surroundings"; 0.6: Bhamidipati and Woods 2017, "On the
/// dynamics of starting plumes"), which makes z^(4/3) = 4/3 0.61 w z^(1/3) t above its origin.
void check_front(float voxel) {
  auto gas = make_plume(plume_grid(voxel, 8));
  const GasSource source = plume_source();
  const double origin = virtual_origin(kPlumePower);
  const double speed = 0.61 * heskestad(kPlumePower, 1 + origin).speed;
  const auto law = [=](double t) { return origin + std::pow(4.0 / 3 * speed * t, 0.75); };
  double first = 0, last = 0;
  constexpr int kFirst = 35, kLast = 60;  // [0.1 s]
  for (int n = 1; n <= kLast; ++n) {
    gas->step(0.1f, std::span(&source, 1), {});
    if (n != kFirst && n != kLast) continue;
    last = front_of_plume(*gas);
    if (n == kFirst) first = last;
    printf("voxels of %.2f m, %.1f s: front at %.2f m (law %.2f)\n", double(voxel), 0.1 * n, last,
           law(0.1 * n));
    EXPECT_NEAR(last, law(0.1 * n), 0.1 * law(0.1 * n)) << "m after " << 0.1 * n << " s";
  }
  const double expected = law(0.1 * kLast) - law(0.1 * kFirst);
  EXPECT_NEAR(last - first, expected, 0.2 * expected) << "m of its way: its speed";
}

TEST(GasFlow, PlumesObeyTheirLaw) { check_plume(0.16f); }
TEST(GasPlumes, PlumesObeyTheirLaw) { check_plume(0.1f); }
TEST(GasFlow, FrontsOfStartingPlumesObeyTheirLaw) { check_front(0.16f); }
TEST(GasPlumes, FrontsOfStartingPlumesObeyTheirLaw) { check_front(0.1f); }

}  // namespace
}  // namespace gloam
