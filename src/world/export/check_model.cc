#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "base/text.h"
#include "gloam/model_tools.h"
#include "scene/files/mujoco_guard.h"
#include "scene/files/mujoco_plugins.h"
#include "world/export/export_mjcf.h"
#include "world/export/model_compare.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

std::string one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c != '\n')
      line += c;
    else if (!line.ends_with("; "))
      line += "; ";
  }
  return line.ends_with("; ") ? line.substr(0, line.size() - 2) : line;
}

// "", or the reason why stock MuJoCo does not load the file. Uses a separate process: a file that
// Gloam rejects may crash MuJoCo or never finish loading.
std::string stock_refusal(const fs::path& file, unsigned longest) {
  int ends[2];
  if (::pipe(ends) != 0) return "its process could not be started";
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it ends with us
    ::alarm(longest);
    load_mujoco_plugins();
    const Result<ModelPtr> model = load_stock_model(file);
    const std::string refusal = model.ok() ? "" : one_line(model.error().message);
    const ssize_t written = ::write(ends[1], refusal.data(), refusal.size());
    ::_exit(written == static_cast<ssize_t>(refusal.size()) ? 0 : 1);
  }
  ::close(ends[1]);
  std::string text;
  char piece[512];
  for (ssize_t n = 0; (n = ::read(ends[0], piece, sizeof(piece))) > 0;)
    text.append(piece, static_cast<size_t>(n));
  ::close(ends[0]);
  int state = 0;
  if (child < 0 || ::waitpid(child, &state, 0) != child) return "its process could not be started";
  if (WIFSIGNALED(state)) {
    return WTERMSIG(state) == SIGALRM
               ? fmt::format("it takes more than {} s", longest)
               : std::string("it is terminated by signal: ") + ::strsignal(WTERMSIG(state));
  }
  return text;
}

uint64_t bytes_below(const fs::path& folder) {
  uint64_t bytes = 0;
  std::error_code code;
  for (fs::recursive_directory_iterator it(folder, code), end; !code && it != end;
       it.increment(code)) {
    if (it->is_regular_file(code)) bytes += it->file_size(code);
  }
  return bytes;
}

// Stock MuJoCo keeps the bytes of names of files in other encodings; here they are UTF-8.
bool names_are_utf8(const mjModel& model) {
  const std::string_view names(model.names, static_cast<size_t>(model.nnames));
  return as_utf8(names) == names;
}

bool is_of_names(const std::string& field) {
  return field == "names" || field == "nnames" || field == "names_map" ||
         field.starts_with("name_");
}

bool is_read_by_stock(const fs::path& file) { return file.extension() != ".toml"; }

}  // namespace

ModelCheck check_model(const fs::path& file, const FileAccess& access, const fs::path& folder,
                       unsigned longest_stock_load) {
  install_mujoco_handler();
  ModelCheck check;
  Result<World> world = World();
  if (const Result<Scene> scene = load_scene(file, access); scene.ok())
    world = World::compile(*scene);
  else
    world = scene.error();
  if (!world.ok()) {
    check.status = world.error();
    std::error_code code;
    if (is_read_by_stock(file) && fs::exists(file, code))
      check.stock_refusal = stock_refusal(file, longest_stock_load);
    return check;
  }
  const CompiledWorld& compiled = *world->compiled();
  check.bodies = static_cast<int>(compiled.model->nbody);
  check.joints = static_cast<int>(compiled.model->njnt);
  check.geoms = static_cast<int>(compiled.model->ngeom);
  if (is_read_by_stock(file)) {
    const Result<ModelPtr> stock = load_stock_model(file);
    check.stock_refusal = stock.ok() ? "" : one_line(stock.error().message);
    if (stock.ok()) {
      check.unlike_stock = compare_models(stock->get(), compiled.model.get());
      if (!names_are_utf8(**stock)) std::erase_if(check.unlike_stock, is_of_names);
    }
  }
  const Result<ExportedModel> exported = write_mjcf(compiled, folder);
  if (!exported.ok()) {
    check.status = exported.error();
    return check;
  }
  check.compared = exported->compared;
  check.unlike_export = exported->differing;
  check.export_reason = exported->why;
  check.export_bytes = bytes_below(folder);
  if (exported->compared == 0)  // MuJoCo does not load its own output
    check.status = Error{ErrorKind::kUnsupported, exported->why};
  return check;
}

}  // namespace gloam
