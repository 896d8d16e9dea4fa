// Scenes and their options.

#include "gloam/scene.h"

#include "core.h"
#include "gloam/options.h"

namespace gloam::python {
namespace {

FileAccess access_of(const std::string& root, bool strict) {
  FileAccess access;
  access.root = root;
  access.strict = strict;
  return access;
}

nb::dict option_dict(const OptionInfo& option) {
  nb::dict made;
  made["path"] = option.path;
  made["value"] = option.value;
  made["unit"] = option.unit;
  made["low"] = option.low;
  made["high"] = option.high;
  made["choices"] = option.choices;
  return made;
}

}  // namespace

void bind_scene(nb::module_& m) {
  nb::class_<Scene>(m, "Scene", "A scene as written: editable until it is compiled.")
      .def_static(
          "load",
          [](const std::filesystem::path& path, const std::string& root, bool strict) {
            return take(without_gil([&] { return load_scene(path, access_of(root, strict)); }));
          },
          nb::arg("path"), nb::arg("root") = "", nb::arg("strict") = false)
      .def_static(
          "parse",
          [](const std::string& text, const std::filesystem::path& folder, const std::string& root,
             bool strict) {
            return take(
                without_gil([&] { return parse_scene(text, folder, access_of(root, strict)); }));
          },
          nb::arg("text"), nb::arg("folder"), nb::arg("root") = "", nb::arg("strict") = false)
      .def("copy", [](const Scene& scene) { return Scene(scene); })
      .def("get", [](const Scene& scene,
                     const std::string& path) { return take(get_option(scene, path)); })
      .def("set", [](Scene& scene, const std::string& path,
                     const std::string& value) { check(set_option(scene, path, value)); })
      .def("options",
           [](const Scene& scene) {
             nb::list list;
             for (const OptionInfo& option : list_options(scene)) list.append(option_dict(option));
             return list;
           })
      .def("overlay_text",
           [](const Scene& scene, const std::string& text, const std::string& file) {
             return take(overlay_scene(scene, text, file));
           })
      .def("overlay_file",
           [](const Scene& scene, const std::filesystem::path& file) {
             return take(overlay_scene(scene, file));
           })
      .def("to_toml", [](const Scene& scene) { return to_toml(scene); })
      .def_prop_ro("access",
                   [](const Scene& scene) {
                     return nb::make_tuple(scene.access.root.string(), scene.access.strict);
                   })
      .def("set_origin",
           [](Scene& scene, const std::string& name, const std::filesystem::path& file) {
             scene.name = name;
             scene.file = file;
           })
      .def_prop_ro("name", [](const Scene& scene) { return scene.name; })
      .def_prop_ro("file", [](const Scene& scene) { return scene.file; })
      .def_prop_ro("bare_model", [](const Scene& scene) { return scene.bare_model; })
      .def_prop_ro("duration", [](const Scene& scene) { return scene.sim.duration; });
  m.def("scene_schema", &scene_schema, "JSON Schema (draft 7) of scene files.");
}

}  // namespace gloam::python
