// gloam._core: bindings of include/gloam/. Users import the package in python/gloam/.

#include "core.h"
#include "gloam/program.h"

NB_MODULE(_core, m) {
  using namespace gloam::python;
  nb::set_leak_warnings(false);  // programs end with simulations in their global variables
  m.doc() = "Bindings of Gloam's C++ API; use the package gloam, which is built on them.";
  m.def("version", &gloam::version, "Version of the library, \"0.1.0\".");
  m.def("configuration", &gloam::configuration,
        "Compiler, instruction set, build type and libraries; results are identical for equal "
        "configurations.");
  m.def("home", [] { return take(gloam::gloam_home()); }, "Folder that holds assets/.");
  m.def("suggest_name", [](const std::string& word, const std::vector<std::string>& candidates) {
    return gloam::suggest_name(word, candidates);
  });
  m.def("destroy_deferred", &destroy_deferred);
  m.def("set_thread_count", &gloam::set_thread_count, nb::arg("n"),
        "Threads for rendering and loading; 0 = all processors. Results do not depend on it.");
  m.def("set_log_level", [](const std::string& level) {
    const std::vector<std::string> names = {"debug", "info", "warning", "error", "off"};
    for (size_t i = 0; i < names.size(); ++i)
      if (names[i] == level) return gloam::set_log_level(static_cast<gloam::LogLevel>(i));
    raise("UsageError", "there is no log level '" + level + "'", gloam::suggest_name(level, names));
  });
  bind_scene(m);
  bind_world(m);
  bind_frames(m);
  bind_streams(m);
  bind_snapshots(m);
  bind_simulation(m);
  bind_logs(m);
  bind_runs(m);
  bind_tools(m);
  bind_ik(m);
  bind_policy(m);
}
