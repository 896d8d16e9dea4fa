#include "world/effects/rotor_dust_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "geometry/mesh/single.h"
#include "world/compile/level.h"
#include "world/shapes/visual_pose.h"
#include "world/world.h"

namespace gloam {
namespace {

// A collider that is in the disc, but for this, is a blade, or the disc that stands for them.
constexpr float kBladeReach = 1.15f;      // reach over the radius, in the disc's plane
constexpr float kBladeThickness = 0.35f;  // distance from the plane, over the radius

Vec3f float3(const mjtNum* v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

Error rotor_error(const RotorOptions& rotor, const std::string& message, std::string hint = {}) {
  return {ErrorKind::kInput, fmt::format("rotor '{}': {}", rotor.name, message), rotor.loc,
          std::move(hint)};
}

/// Id of the element called `name`.
Result<int> find_object(const RotorOptions& rotor, const mjModel& m, mjtObj type, const char* kind,
                        const std::string& name) {
  const int id = mj_name2id(&m, type, name.c_str());
  if (id >= 0) return id;
  return rotor_error(rotor, fmt::format("there is no {} '{}'", kind, name),
                     suggest_name(name, object_names(&m, type)));
}

bool is_below(const mjModel& m, int body, int ancestor) {
  while (body > ancestor) body = m.body_parentid[body];
  return body == ancestor;
}

/// Colliders of the rotor's body, and of those that hang on it, that lie in the disc at qpos0.
std::vector<int> blades_of(const mjModel& m, const RotorDescription& rotor,
                           const std::vector<Affine3f>& X_WB) {
  const Affine3f& X = X_WB[static_cast<size_t>(rotor.body)];
  const Vec3f hub = transform_point(X, rotor.p_B), axis = transform_vector(X, rotor.axis_B);
  std::vector<int> blades;
  for (int g = 0; g < static_cast<int>(m.ngeom); ++g) {
    const int body = m.geom_bodyid[g], type = m.geom_type[g];
    if (type == mjGEOM_PLANE || type == mjGEOM_HFIELD || !is_below(m, body, rotor.body)) continue;
    const Affine3f X_WG =
        X_WB[static_cast<size_t>(body)] * rigid_pose(m.geom_pos + 3 * g, m.geom_quat + 4 * g);
    const Vec3f middle = float3(m.geom_aabb + 6 * g), half = float3(m.geom_aabb + 6 * g + 3);
    const Vec3f away = transform_point(X_WG, middle) - hub;
    const Vec3f edges[3] = {X_WG.x * half.x, X_WG.y * half.y, X_WG.z * half.z};
    const float along = dot(away, axis);
    const float off = length(away - axis * along);
    float thick = std::abs(along), wide = 0;
    for (const Vec3f& edge : edges) {
      const float part = dot(edge, axis);
      thick += std::abs(part);
      wide = max(wide, length(edge - axis * part));
    }
    if (off + wide <= kBladeReach * rotor.radius && thick <= kBladeThickness * rotor.radius)
      blades.push_back(g);
  }
  return blades;
}

}  // namespace

Result<std::vector<RotorDescription>> describe_rotors(const CompiledWorld& world) {
  const mjModel& m = *world.model;
  std::vector<RotorDescription> rotors;
  if (world.scene.rotors.empty()) return rotors;
  const std::vector<Affine3f> X_WB = body_poses_at_qpos0(m);
  for (const RotorOptions& options : world.scene.rotors) {
    RotorDescription rotor;
    rotor.name = options.name;
    rotor.radius = static_cast<float>(options.radius);
    int site = -1;
    Vec3f push{0, 0, 1};
    if (!options.actuator.empty()) {
      GLOAM_TRY(rotor.actuator,
                find_object(options, m, mjOBJ_ACTUATOR, "actuator", options.actuator));
      push = float3(m.actuator_gear + 6 * rotor.actuator);
      if (m.actuator_trntype[rotor.actuator] != mjTRN_SITE || !(length(push) > 0)) {
        return rotor_error(
            options,
            fmt::format("actuator '{}' does not push a site along an axis", options.actuator),
            "its force is the thrust if MJCF has site=\"…\" gear=\"0 0 1 …\"; otherwise specify "
            "'site' and 'thrust'");
      }
      site = m.actuator_trnid[2 * rotor.actuator];
      rotor.thrust = length(push);
    } else {
      GLOAM_TRY(site, find_object(options, m, mjOBJ_SITE, "site", options.site));
      rotor.thrust = static_cast<float>(*options.thrust);
    }
    const Affine3f X_BS = rigid_pose(m.site_pos + 3 * site, m.site_quat + 4 * site);
    rotor.body = m.site_bodyid[site];
    rotor.p_B = X_BS.p;
    rotor.axis_B = normalize(transform_vector(X_BS, push));
    rotor.blades = blades_of(m, rotor, X_WB);
    rotors.push_back(std::move(rotor));
  }
  return rotors;
}

std::vector<DustDescription> describe_dusts(const Scene& scene) {
  std::vector<DustDescription> dusts;
  for (const DustOptions& options : scene.dusts) {
    DustDescription dust;
    dust.name = options.name;
    constexpr float kInf = std::numeric_limits<float>::infinity();
    dust.low = {-kInf, -kInf, -kInf}, dust.high = {kInf, kInf, kInf};
    if (options.size) {
      const Vec3f middle = to_vec3f(*options.position), half = to_vec3f(*options.size) * 0.5f;
      dust.low = middle - half, dust.high = middle + half;
    }
    dust.silt = static_cast<float>(options.silt);
    dust.clay = static_cast<float>(options.clay);
    dust.threshold = static_cast<float>(options.threshold);
    dusts.push_back(std::move(dust));
  }
  return dusts;
}

Status check_stirrers(const Scene& scene, const std::vector<GasOptions>& gases) {
  if (gases.empty() && !scene.rotors.empty()) {
    const RotorOptions& rotor = scene.rotors.front();
    return Error{ErrorKind::kInput,
                 fmt::format("rotor '{}' has no air to drive: there is no gas", rotor.name),
                 rotor.loc,
                 "add a [[gas]], or a [[dust]], [[smoke]] or [[fire]], which create one"};
  }
  const bool carries =
      std::any_of(gases.begin(), gases.end(), [](const auto& gas) { return gas.medium == "dust"; });
  if (scene.dusts.empty() || carries) return {};
  const DustOptions& dust = scene.dusts.front();
  return Error{ErrorKind::kInput,
               fmt::format("dust '{}' has no gas that carries dust: '{}' carries {}", dust.name,
                           gases.front().name, gases.front().medium),
               dust.loc, "a gas carries one medium: set medium = \"dust\" in its [[gas]]"};
}

}  // namespace gloam
