#include "policy/openvino_api.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "base/files.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr std::string_view kLibrary = "libopenvino_c.so";

/// Files of the library in a folder: their names end with the version.
void add_libraries(const fs::path& folder, std::vector<fs::path>* paths) {
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code))
    if (entry.path().filename().string().starts_with(kLibrary)) paths->push_back(entry.path());
}

/// The package, installed by pip for the interpreter of a virtual environment.
void add_environment(const fs::path& environment, std::vector<fs::path>* paths) {
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(environment / "lib", code))
    add_libraries(entry.path() / "site-packages" / "openvino" / "libs", paths);
}

std::vector<fs::path> candidates() {
  std::vector<fs::path> paths;
  if (const char* user = std::getenv("GLOAM_OPENVINO"); user != nullptr && *user != 0) {
    std::error_code code;
    if (!fs::is_directory(user, code)) return {fs::path(user)};
    for (const char* folder : {"", "libs", "runtime/lib/intel64"})
      add_libraries(fs::path(user) / folder, &paths);
    return paths;
  }
  if (const Result<fs::path> home = gloam_home(); home.ok()) {
    add_libraries(*home / ".venv" / "wheels" / "openvino" / "libs", &paths);
    add_environment(*home / ".venv" / "python", &paths);
    add_libraries(home->parent_path().parent_path() / "lib" / "gloam" / "openvino", &paths);
  }
  if (const char* active = std::getenv("VIRTUAL_ENV"); active != nullptr && *active != 0)
    add_environment(active, &paths);
  paths.emplace_back(kLibrary);  // the folders that the system searches
  return paths;
}

bool load_functions(void* library, OpenvinoApi* api) {
  bool complete = true;
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
    complete = complete && function != nullptr;
  };
  load(api->core_create, "ov_core_create");
  load(api->core_read_model, "ov_core_read_model");
  load(api->core_read_model_bytes, "ov_core_read_model_from_memory_buffer");
  load(api->core_compile_model, "ov_core_compile_model");
  load(api->last_error, "ov_get_last_err_msg");
  load(api->model_free, "ov_model_free");
  load(api->model_outputs_size, "ov_model_outputs_size");
  load(api->model_output, "ov_model_const_output_by_index");
  load(api->model_reshape_input, "ov_model_reshape_input_by_name");
  load(api->port_any_name, "ov_port_get_any_name");
  load(api->port_partial_shape, "ov_port_get_partial_shape");
  load(api->port_free, "ov_output_const_port_free");
  load(api->shape_create, "ov_partial_shape_create_static");
  load(api->shape_free, "ov_partial_shape_free");
  load(api->text_free, "ov_free");
  load(api->create_request, "ov_compiled_model_create_infer_request");
  load(api->compiled_free, "ov_compiled_model_free");
  load(api->request_tensor, "ov_infer_request_get_tensor");
  load(api->request_infer, "ov_infer_request_infer");
  load(api->request_free, "ov_infer_request_free");
  load(api->tensor_data, "ov_tensor_data");
  load(api->tensor_size, "ov_tensor_get_size");
  load(api->tensor_byte_size, "ov_tensor_get_byte_size");
  load(api->tensor_free, "ov_tensor_free");
  return complete;
}

Result<OpenvinoApi> load_library() {
  std::string reason;
  for (const fs::path& path : candidates()) {
    // Never unloaded: its threads may outlive the call.
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (library == nullptr) {
      reason = dlerror();
      continue;
    }
    OpenvinoApi api;
    if (load_functions(library, &api) && api.core_create(&api.core) == 0) return api;
    reason = path.string() + " has another interface";
  }
  return Error{ErrorKind::kUnsupported,
               "OpenVINO, which runs the networks of policies, is not installed",
               {},
               "run pip install openvino for a Python program, or pip install --no-deps --target "
               ".venv/wheels openvino==2026.4.1 in Gloam's folder, or set GLOAM_OPENVINO to the "
               "folder of its package" +
                   (reason.empty() ? "" : "; " + reason)};
}

}  // namespace

Result<const OpenvinoApi*> openvino() {
  static const Result<OpenvinoApi> api = load_library();
  if (!api.ok()) return api.error();
  return &*api;
}

}  // namespace gloam
