// The baseline of load_time.cc: what a program that links MuJoCo and nothing else needs until the
// model is there.
//
//   load MODEL.xml
//
// Prints the process's CPU time since its start and the wall clock at that moment, both in seconds.

#include <mujoco/mujoco.h>
#include <time.h>

#include <cstdio>

int main(int argc, char** argv) {
  char error[1000] = "";
  mjModel* model = argc == 2 ? mj_loadXML(argv[1], nullptr, error, sizeof(error)) : nullptr;
  if (model == nullptr) {
    std::fprintf(stderr, "%s\n", argc == 2 ? error : "usage: load MODEL.xml");
    return 1;
  }
  timespec cpu{}, wall{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  clock_gettime(CLOCK_MONOTONIC, &wall);
  std::printf("%.6f %.6f\n",
              static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec),
              static_cast<double>(wall.tv_sec) + 1e-9 * static_cast<double>(wall.tv_nsec));
  std::fflush(stdout);
  mj_deleteModel(model);
}
