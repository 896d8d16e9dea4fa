#pragma once
// The binary interface of planners in shared libraries: `[planner] type = "library"`
// (docs/navigation.md). It is plain C and complete in itself, so that a library can be built by any
// compiler. gloam/planner/plugin.h is the same for C++ classes.
//
// The calls for one planner come one after another, possibly from several threads. Pointers that a
// function receives are valid until it returns. Texts are UTF-8.

#include <stdint.h>

/// Version of this interface. Gloam rejects libraries with another one.
#define GLOAM_PLANNER_ABI 1

/// Most waypoints of an answer.
#define GLOAM_PLANNER_MOST_WAYPOINTS 64

/// Size of the buffers for errors, including the final zero [bytes].
#define GLOAM_PLANNER_ERROR_SIZE 256

#ifdef __cplusplus
#define GLOAM_PLANNER_EXPORT extern "C" __attribute__((visibility("default")))
#endif
#ifndef GLOAM_PLANNER_EXPORT
#define GLOAM_PLANNER_EXPORT __attribute__((visibility("default")))
#endif

/// Inputs besides pose, velocity and goal.
enum GloamPlannerNeed {
  GLOAM_PLANNER_IMAGE = 1,
  GLOAM_PLANNER_DEPTH = 2,
  GLOAM_PLANNER_SCAN = 4,
  GLOAM_PLANNER_MAP = 8,
};

/// Constants of a planner. A scene can override the rate and the latency.
struct GloamPlannerInfo {
  double rate;           ///< calls per second of simulation time, above 0 [Hz]
  double latency;        ///< simulation time from an observation until its answer applies [s]
  uint32_t needs;        ///< sum of GloamPlannerNeed; all other inputs are null
  int32_t image_width;   ///< of image and depth [px]; 0 if neither is needed
  int32_t image_height;  ///< [px]
};

/// Pixels in sRGB, (height, width, 3), rows from the top.
struct GloamPlannerImage {
  const uint8_t* pixels;
  int32_t width;
  int32_t height;
};

/// Task of an episode.
struct GloamPlannerTask {
  const char* robot;   ///< its name
  uint64_t seed;       ///< of all random numbers of the planner
  double goal[2];      ///< (x, y) in the world [m]
  int32_t has_goal;    ///< 0: only the map leads to the goal
  int32_t map_size;    ///< number of images
  double goal_radius;  ///< distance at which the goal counts as reached [m]
  double top_speed;    ///< [m/s]
  /// Images along the path to the goal, which the last one shows, (map_size)
  const struct GloamPlannerImage* map;
};

/// Data of one instant.
struct GloamPlannerObservation {
  double time;                     ///< simulation time [s]
  double pose[3];                  ///< x, y, yaw in the world [m, m, rad]
  double velocity[3];              ///< vx, vy, yaw rate in the robot's frame [m/s, m/s, rad/s]
  struct GloamPlannerImage image;  ///< of the robot's camera
  const float* depth;              ///< along the camera's axis, inf = nothing [m], (height, width)
  int32_t depth_width;
  int32_t depth_height;
  const float* scan;  ///< LiDAR points; x in the robot's heading, z up [m], (scan_size, 3)
  int64_t scan_size;  ///< number of points
};

enum GloamPlannerAnswerKind {
  GLOAM_PLANNER_NONE = 0,  ///< counted as an invalid answer
  GLOAM_PLANNER_VELOCITY = 1,
  GLOAM_PLANNER_WAYPOINTS = 2,
  GLOAM_PLANNER_ARRIVED = 3,  ///< the robot stops
};

/// Answer to an observation. All its bytes are zero before the call.
struct GloamPlannerAnswer {
  int32_t kind;             ///< GloamPlannerAnswerKind
  int32_t waypoint_count;   ///< 1 … GLOAM_PLANNER_MOST_WAYPOINTS
  int32_t waypoint_values;  ///< per waypoint: 2 = x, y [m]; 4 = cosine and sine of the heading, too
  int32_t chosen;           ///< index of the waypoint to drive to
  double velocity[3];       ///< vx, vy, yaw rate in the robot's frame [m/s, m/s, rad/s]
  /// In the robot's frame at the time of the observation.
  double waypoints[GLOAM_PLANNER_MOST_WAYPOINTS][4];
  char error[GLOAM_PLANNER_ERROR_SIZE];  ///< a text makes the answer invalid
};

/// Functions of a planner. A function fails if it writes a text to `error`, which has
/// GLOAM_PLANNER_ERROR_SIZE bytes, all zero before the call. No C++ exception may leave a function.
struct GloamPlannerApi {
  uint32_t abi;  ///< GLOAM_PLANNER_ABI; the first member in every version
  struct GloamPlannerInfo info;
  void* (*create)(char* error);  ///< makes a planner
  void (*reset)(void* planner, const struct GloamPlannerTask* task, char* error);
  void (*plan)(void* planner, const struct GloamPlannerObservation* observation,
               struct GloamPlannerAnswer* answer);
  void (*destroy)(void* planner);
};

/// The function that a library defines. Its result stays valid while the library is loaded.
GLOAM_PLANNER_EXPORT const struct GloamPlannerApi* gloam_planner(void);
