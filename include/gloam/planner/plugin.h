#pragma once
// Planners in C++17 for shared libraries: a class derived from PlannerPlugin, and GLOAM_PLANNER. It
// needs nothing but gloam/planner/abi.h. Example: examples/planner_library/steer.cc.

#include <cstdio>
#include <exception>
#include <type_traits>

#include "gloam/planner/abi.h"

namespace gloam {

/// Base class of planners. A derived class has a default constructor and a constant
/// `static constexpr GloamPlannerInfo kInfo`.
class PlannerPlugin {
 public:
  virtual ~PlannerPlugin() = default;
  /// Begins an episode. An exception rejects the task.
  virtual void reset(const GloamPlannerTask& task) = 0;
  /// Fills in an answer, which is zero before. An exception makes it invalid.
  virtual void plan(const GloamPlannerObservation& observation, GloamPlannerAnswer* answer) = 0;
};

/// Calls a function and writes its exception to an error buffer of the interface.
template <class Function>
void call_planner(char* error, Function function) noexcept {
  const auto write = [error](const char* text) {
    std::snprintf(error, GLOAM_PLANNER_ERROR_SIZE, "%s", *text ? text : "exception without a text");
  };
  try {
    function();
  } catch (const std::exception& thrown) {
    write(thrown.what());
  } catch (...) {
    write("exception of an unknown type");
  }
}

/// The functions of a class of planners. They are returned by value: g++ merges static variables of
/// a template across all libraries of a process, which may have classes of the same name.
template <class Planner>
GloamPlannerApi planner_api() {
  static_assert(std::is_base_of<PlannerPlugin, Planner>::value, "derive from PlannerPlugin");
  return {
      GLOAM_PLANNER_ABI,
      Planner::kInfo,
      [](char* error) -> void* {
        PlannerPlugin* planner = nullptr;
        call_planner(error, [&] { planner = new Planner; });
        return planner;
      },
      [](void* planner, const GloamPlannerTask* task, char* error) {
        call_planner(error, [&] { static_cast<PlannerPlugin*>(planner)->reset(*task); });
      },
      [](void* planner, const GloamPlannerObservation* observation, GloamPlannerAnswer* answer) {
        call_planner(answer->error,
                     [&] { static_cast<PlannerPlugin*>(planner)->plan(*observation, answer); });
      },
      [](void* planner) { delete static_cast<PlannerPlugin*>(planner); },
  };
}

}  // namespace gloam

/// Exports a class as the planner of the library. Used once, outside of namespaces.
#define GLOAM_PLANNER(Class)                                        \
  GLOAM_PLANNER_EXPORT const GloamPlannerApi* gloam_planner(void) { \
    static const GloamPlannerApi api = gloam::planner_api<Class>(); \
    return &api;                                                    \
  }
