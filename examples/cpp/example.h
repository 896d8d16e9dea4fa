#pragma once
// Helpers of the examples: the World of a file, and the end of a program that cannot go on.

#include <cstdio>
#include <cstdlib>

#include "gloam/simulation.h"

/// The value, or the end of the program with the error's message and exit code.
template <class T>
T take(gloam::Result<T> result) {
  if (result.ok()) return std::move(*result);
  std::fprintf(stderr, "%s\n", result.error().to_string().c_str());
  std::exit(result.error().exit_code());
}
inline void check(const gloam::Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "%s\n", status.error().to_string().c_str());
  std::exit(status.error().exit_code());
}

inline gloam::World world_of(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s SCENE_OR_MODEL\n", argv[0]);
    std::exit(2);
  }
  return take(gloam::World::compile(take(gloam::load_scene(argv[1]))));
}
