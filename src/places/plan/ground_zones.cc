#include "places/plan/ground_zones.h"

#include <algorithm>
#include <array>
#include <functional>

#include "base/check.h"

namespace gloam {
namespace {

constexpr double kBase = 2;  // depth of solid ground under its lowest sample [m]

struct Corner {
  Vec3f p, n;
};
Corner between(const Corner& a, const Corner& b, float t) {
  return {lerp(a.p, b.p, t), normalize(lerp(a.n, b.n, t))};
}
using Polygon = std::vector<std::pair<Corner, std::vector<float>>>;  // with the zones' fields

// Splits the polygon by the sign of one field: the part above zero, and the rest.
std::pair<Polygon, Polygon> part(const Polygon& polygon, size_t field) {
  std::pair<Polygon, Polygon> parts;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const auto &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const float a = from.second[field], b = to.second[field];
    (a > 0 ? parts.first : parts.second).push_back(from);
    if ((a > 0) == (b > 0)) continue;
    const float t = a / (a - b);
    std::vector<float> values;
    for (size_t k = 0; k < from.second.size(); ++k)
      values.push_back(lerp(from.second[k], to.second[k], t));
    parts.first.emplace_back(between(from.first, to.first, t), values);
    parts.second.push_back(parts.first.back());
  }
  return parts;
}

// One zone's part of the ground. Corners of the grid are shared, those of cuts are not.
class ZoneMesh {
 public:
  explicit ZoneMesh(size_t samples) : known_(samples, -1) {}

  uint32_t add(const Corner& c) {
    mesh_.positions.push_back(c.p);
    mesh_.normals.push_back(c.n);
    return static_cast<uint32_t>(mesh_.positions.size()) - 1;
  }
  void add_triangle(const std::array<size_t, 3>& samples, const std::array<Corner, 3>& corners) {
    for (size_t k = 0; k < 3; ++k) {
      int64_t& index = known_[samples[k]];
      if (index < 0) index = add(corners[k]);
      mesh_.indices.push_back(static_cast<uint32_t>(index));
    }
  }
  void add_polygon(const Polygon& polygon) {
    if (polygon.size() < 3) return;
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    for (const auto& [corner, values] : polygon) add(corner);
    for (uint32_t k = 2; k < polygon.size(); ++k)
      mesh_.indices.insert(mesh_.indices.end(), {first, first + k - 1, first + k});
  }
  TriangleMesh mesh() && { return std::move(mesh_); }

 private:
  std::vector<int64_t> known_;
  TriangleMesh mesh_;
};

struct Zone {
  const char* label;
  std::string material;
  std::function<double(double x, double y, Vec3f n)> field;  ///< above 0 where it is
};

// Each point belongs to the first zone that claims it; the last zone gets the rest.
std::vector<Zone> zones_of(const Landscape& land, Workshop* shop) {
  const auto ragged = [&land](double x, double y) { return land.ragged(x, y); };
  std::vector<Zone> zones;
  if (land.has_road()) {
    zones.push_back({"road", shop->gravel(), [&land, ragged](double x, double y, Vec3f) {
                       return land.road_width() / 2 + 0.22 * ragged(x, y) - land.from_road(x, y);
                     }});
    zones.push_back({"verge", shop->soil({0.10, 0.078, 0.050}, {0.055, 0.055, 0.026}),
                     [&land, ragged](double x, double y, Vec3f) {
                       return land.road_width() / 2 + 0.45 + 0.55 * ragged(x + 40, y) -
                              land.from_road(x, y);
                     }});
  }
  if (land.pond()) {
    zones.push_back({"shore", shop->soil({0.085, 0.066, 0.044}, {0.045, 0.036, 0.025}, 0.7),
                     [&land, ragged](double x, double y, Vec3f) {
                       return 1.10 + 0.16 * ragged(x, y) - land.pond_share(x, y);
                     }});
  }
  zones.push_back({"rock", shop->bedrock(), [ragged](double x, double y, Vec3f n) {
                     return 0.885 + 0.03 * ragged(x, y) - double(n.z);
                   }});
  zones.push_back({"earth", shop->soil({0.115, 0.085, 0.054}, {0.06, 0.05, 0.028}),
                   [&land, ragged](double x, double y, Vec3f) {
                     double yard = 1e9;
                     for (const BuildingSite& s : land.sites())
                       yard = std::min(yard, s.distance(x, y));
                     const double bare = -0.42 - land.moisture(x, y) + 0.12 * ragged(x, y);
                     return std::max(bare, 0.9 + 0.6 * ragged(x, y) - yard);
                   }});
  zones.push_back({"meadow", shop->turf(), [](double, double, Vec3f) { return 1.0; }});
  return zones;
}

std::vector<Corner> corners_of(const HeightField& field, const Landscape& land) {
  const HeightGrid& g = field.grid;
  std::vector<Corner> corners;
  const auto z = [&](int c, int r) {
    if (c >= 0 && r >= 0 && c < g.columns && r < g.rows) return double(field.at(c, r));
    return land.height(g.low[0] + c * g.step[0], g.low[1] + r * g.step[1]);
  };
  for (int r = 0; r < g.rows; ++r)
    for (int c = 0; c < g.columns; ++c) {
      const Vec3f n{float((z(c - 1, r) - z(c + 1, r)) / (2 * g.step[0])),
                    float((z(c, r - 1) - z(c, r + 1)) / (2 * g.step[1])), 1};
      corners.push_back(
          {{float(g.low[0] + c * g.step[0]), float(g.low[1] + r * g.step[1]), field.at(c, r)},
           normalize(n)});
    }
  return corners;
}

void put(const char* label, const std::string& material, TriangleMesh mesh, Place* place) {
  if (mesh.indices.empty()) return;
  Prop prop;
  prop.label = label;
  prop.body().show("surface", material, Solid(std::move(mesh)));
  place->put(place->add(std::move(prop)), "", {});
}

}  // namespace

HeightField sample_landscape(const Landscape& land, const Rect& area, double step) {
  const Result<HeightGrid> grid = make_height_grid({area.x0, area.y0}, {area.x1, area.y1}, step, 1);
  GLOAM_CHECK(grid.ok(), "options must limit the number of samples");
  HeightField field;
  field.grid = *grid;
  field.base = kBase;
  for (int r = 0; r < grid->rows; ++r)
    for (int c = 0; c < grid->columns; ++c)
      field.z.push_back(static_cast<float>(
          land.height(grid->low[0] + c * grid->step[0], grid->low[1] + r * grid->step[1])));
  return field;
}

// As MuJoCo cuts its cells: from their low corner to their high one.
double ground_height(const HeightField& field, double x, double y) {
  const HeightGrid& g = field.grid;
  const double u = std::clamp((x - g.low[0]) / g.step[0], 0.0, g.columns - 1.001),
               v = std::clamp((y - g.low[1]) / g.step[1], 0.0, g.rows - 1.001);
  const int c = static_cast<int>(u), r = static_cast<int>(v);
  const double a = u - c, b = v - r;
  const double low = field.at(c, r), high = field.at(c + 1, r + 1);
  const double corner = a > b ? field.at(c + 1, r) : field.at(c, r + 1);
  return a > b ? low + a * (corner - low) + b * (high - corner)
               : low + b * (corner - low) + a * (high - corner);
}

void show_ground(const Landscape& land, const HeightField& field, Workshop* shop, Place* place) {
  const std::vector<Zone> zones = zones_of(land, shop);
  const std::vector<Corner> corners = corners_of(field, land);
  std::vector<std::vector<float>> values;
  for (const Corner& c : corners) {
    std::vector<float>& v = values.emplace_back();
    for (const Zone& zone : zones) v.push_back(static_cast<float>(zone.field(c.p.x, c.p.y, c.n)));
  }
  std::vector<ZoneMesh> meshes(zones.size(), ZoneMesh(corners.size()));
  const auto add = [&](const std::array<size_t, 3>& samples) {
    Polygon polygon;
    for (const size_t i : samples) polygon.emplace_back(corners[i], values[i]);
    for (size_t zone = 0; zone < zones.size() && !polygon.empty(); ++zone) {
      int inside = 0;
      for (const auto& [corner, v] : polygon) inside += v[zone] > 0;
      if (inside == 0) continue;
      if (inside == 3 && polygon.size() == 3 && polygon[0].first.p == corners[samples[0]].p &&
          polygon[1].first.p == corners[samples[1]].p &&
          polygon[2].first.p == corners[samples[2]].p) {
        meshes[zone].add_triangle(samples,
                                  {corners[samples[0]], corners[samples[1]], corners[samples[2]]});
        return;
      }
      auto [mine, rest] = part(polygon, zone);
      meshes[zone].add_polygon(mine);
      polygon = std::move(rest);
    }
  };
  const auto columns = static_cast<size_t>(field.grid.columns);
  for (size_t r = 0; r + 1 < static_cast<size_t>(field.grid.rows); ++r)
    for (size_t c = 0; c + 1 < columns; ++c) {
      // As MuJoCo cuts its cells: from their low corner to their high one.
      const size_t i = r * columns + c;
      add({i, i + 1, i + columns + 1});
      add({i, i + columns + 1, i + columns});
    }
  for (size_t zone = 0; zone < zones.size(); ++zone)
    put(zones[zone].label, zones[zone].material, std::move(meshes[zone]).mesh(), place);
}

TriangleMesh sheet_facing_up(const Path& points, int columns) {
  TriangleMesh mesh = sheet(points, columns).mesh();
  mesh.uvs.clear();
  if (mesh.normals[0].z >= 0) return mesh;
  for (Vec3f& n : mesh.normals) n = -n;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  return mesh;
}

// Rings around the field, each further out than the last. The first lies a little inside and below.
void show_country(const Landscape& land, const HeightField& field, Workshop* shop, Place* place) {
  constexpr int kRings = 44, kPerSide = 160;
  constexpr float kUnder = 0.04f;  // [m]
  const HeightGrid& g = field.grid;
  const double half_x = g.step[0] * (g.columns - 1) / 2, half_y = g.step[1] * (g.rows - 1) / 2;
  Path points;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double out = ring == 0 ? -0.25 : 420 * std::pow(double(ring) / kRings, 2.6) + 0.0;
    for (int k = 0; k <= 4 * kPerSide; ++k) {
      const int side = k / kPerSide % 4;
      const double t = 2.0 * (k % kPerSide) / kPerSide - 1;
      const std::array<std::pair<double, double>, 4> edge = {
          {{t, -1.0}, {1.0, t}, {-t, 1.0}, {-1.0, -t}}};
      const auto [u, v] = edge[static_cast<size_t>(side)];
      const double x = u * (half_x + out), y = v * (half_y + out);
      points.push_back({float(x), float(y), float(land.height(x, y)) - (ring == 0 ? kUnder : 0)});
    }
  }
  put("meadow", shop->turf(), sheet_facing_up(points, 4 * kPerSide + 1), place);
}

void show_road_beyond(const Landscape& land, Workshop* shop, Place* place) {
  if (!land.has_road()) return;
  constexpr int kLong = 60;  // [m]
  for (const double end : {-1.0, 1.0}) {
    Path points;
    for (int i = 0; i <= kLong; ++i) {
      const double x = end * (land.area().x1 - 0.2 + i), y = land.road_y(x);
      for (const double side : {-0.5, -0.2, 0.2, 0.5}) {
        const double at = y + side * land.road_width();
        // The country is drawn the coarser the farther it is.
        points.push_back({float(x), float(at), float(land.height(x, at) + 0.015 + 0.004 * i)});
      }
    }
    put("road", shop->gravel(), sheet_facing_up(points, 4), place);
  }
}

}  // namespace gloam
