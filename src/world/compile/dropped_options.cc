#include "world/compile/dropped_options.h"

#include <fmt/format.h>
#include <mujoco/mjxmacro.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "base/text.h"

namespace gloam {
namespace {

// Keywords of MJCF, in the order of MuJoCo's enums (mjtIntegrator, mjtCone, mjtJacobian,
// mjtSolver).
std::string keyword(std::string_view field, int value) {
  static constexpr const char* kIntegrators[] = {"Euler", "RK4", "implicit", "implicitfast"};
  static constexpr const char* kCones[] = {"pyramidal", "elliptic"};
  static constexpr const char* kJacobians[] = {"dense", "sparse", "auto"};
  static constexpr const char* kSolvers[] = {"PGS", "CG", "Newton"};
  const auto pick = [&](auto& words) {
    const bool known = value >= 0 && value < static_cast<int>(std::size(words));
    return known ? std::string(words[value]) : fmt::format("{}", value);
  };
  if (field == "integrator") return pick(kIntegrators);
  if (field == "cone") return pick(kCones);
  if (field == "jacobian") return pick(kJacobians);
  if (field == "solver") return pick(kSolvers);
  return fmt::format("{}", value);
}

std::string text_of(std::string_view field, const int* values, int) {
  return keyword(field, *values);
}
std::string text_of(std::string_view, const mjtNum* values, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += fmt::format("{}{:.6g}", i == 0 ? "" : " ", values[i]);
  return text;
}

class SettingsComparison {
 public:
  SettingsComparison(const ModelSettings& own, const ModelSettings& level,
                     const std::set<std::string>& given)
      : own_(own), level_(level), given_(given) {
    mj_defaultOption(&usual_.option);
    mj_defaultVisual(&usual_.visual);
  }

  std::vector<DroppedSetting> run() {
#define X(type, name, count) \
  compare(#name, &own_.option.name, &level_.option.name, &usual_.option.name, count);
#define XVEC(type, name, count) \
  compare(#name, own_.option.name, level_.option.name, usual_.option.name, count);
    MJOPTION_FIELDS
#undef X
#undef XVEC
    compare_flags(own_.option.disableflags, level_.option.disableflags,
                  {mjDISABLESTRING, mjNDISABLE, "disable", "enable"});
    compare_flags(own_.option.enableflags, level_.option.enableflags,
                  {mjENABLESTRING, mjNENABLE, "enable", "disable"});
    compare_group("global", own_.visual.global, level_.visual.global, usual_.visual.global);
    compare_group("headlight", own_.visual.headlight, level_.visual.headlight,
                  usual_.visual.headlight);
    compare_group("map", own_.visual.map, level_.visual.map, usual_.visual.map);
    return std::move(dropped_);
  }

 private:
  struct FlagNames {
    const char** names;
    int count;
    const char *own, *level;
  };

  template <class T>
  void compare(std::string_view name, const T* own, const T* level, const T* usual, int count) {
    if (name.ends_with("flags")) return;  // bit by bit
    if (std::equal(own, own + count, level)) return;
    if (std::equal(own, own + count, usual) && !given_.contains(std::string(name))) return;
    dropped_.push_back({fmt::format("{} {}, but the scene has {}", name, text_of(name, own, count),
                                    text_of(name, level, count)),
                        "option", std::string(name)});
  }

  void compare_flags(int own, int level, const FlagNames& flags) {
    for (int i = 0; i < flags.count; ++i) {
      const int bit = 1 << i;
      if ((own & bit) == 0 || (level & bit) != 0) continue;
      const std::string name = lower_case(flags.names[i]);
      dropped_.push_back(
          {fmt::format("flag {} {}, but the scene has {}", name, flags.own, flags.level), "flag",
           name});
    }
  }

  template <class Group>
  void compare_group(const char* name, const Group& own, const Group& level, const Group& usual) {
    if (std::memcmp(&own, &level, sizeof(Group)) == 0) return;
    if (std::memcmp(&own, &usual, sizeof(Group)) == 0) return;
    dropped_.push_back({fmt::format("visual/{}, but the scene has other values", name), name, ""});
  }

  const ModelSettings &own_, &level_;
  ModelSettings usual_;
  const std::set<std::string>& given_;
  std::vector<DroppedSetting> dropped_;
};

}  // namespace

std::vector<DroppedSetting> dropped_settings(const ModelSettings& own, const ModelSettings& level,
                                             const std::set<std::string>& given) {
  return SettingsComparison(own, level, given).run();
}

}  // namespace gloam
