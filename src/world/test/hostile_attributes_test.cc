// Every attribute of MJCF with values that nobody means well by: the model is refused or simulated,
// and the process lives on. MuJoCo takes some of them badly: each model is loaded in a process of its
// own.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>

#include "base/files.h"
#include "gloam/world.h"
#include "scene/mjcf/specimen.h"
#include "scene/mujoco_guard.h"
#include "scene/test/temp_folder.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr std::string_view kNasty[] = {"",     "zz",          "0",          "1",     "-1",
                                       "1e308", "nan",        "-2147483648", "3000000000",
                                       "0 0 0", "1 1 1 1 1 1 1", "b",          "0 1 2 99999999"};

// Of the scene as a user would load it, and of two steps.
void load_and_step(const std::filesystem::path& file) {
  Scene scene;
  scene.bare_model = file;
  const Result<World> world = World::compile(scene);
  if (!world.ok()) {
    if (world.error().message.empty()) _exit(3);
    return;
  }
  const mjModel* model = world->compiled()->model.get();
  (void)guarded([&] {
    mjData* data = mj_makeData(model);
    mj_step(model, data);
    mj_step(model, data);
    mj_deleteData(data);
  }).ok();
}

// 0, or how the process ended that loaded the model.
int end_of_process(const std::filesystem::path& file) {
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stderr);
    std::freopen("/dev/null", "w", stdout);
    const rlimit core{0, 0};
    setrlimit(RLIMIT_CORE, &core);
    alarm(20);
    load_and_step(file);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(HostileAttributes, NoneEndsTheProcess) {
#ifdef GLOAM_SANITIZED
  GTEST_SKIP() << "processes of a sanitizer take too long to fork";
#endif
  const TempFolder folder;
  folder.write("m.xml", "<mujoco><option/></mujoco>");
  int models = 0;
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    for (const MjcfAttribute& attribute : element.attributes) {
      for (const std::string_view value : kNasty) {
        const mjcf::Specimen specimen = mjcf::make_specimen(element, attribute.name);
        mjcf::set_unchecked(specimen.element, attribute.name, value);
        const std::filesystem::path file = folder.write("model.xml", specimen.document.to_xml());
        ++models;
        const int status = end_of_process(file);
        EXPECT_EQ(status, 0) << "a model ends the process with "
                             << (WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "an exit")
                             << ": " << element.path << " " << attribute.name << "=\"" << value
                             << "\"";
      }
    }
  }
  std::printf("%d models\n", models);
}

}  // namespace
}  // namespace gloam
