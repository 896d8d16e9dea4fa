#include "run_options.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "gloam/output_names.h"
#include "gloam/program.h"

namespace gloam::cli {

Result<std::pair<std::string, std::string>> split_setting(const std::string& setting) {
  const size_t split = setting.find('=');
  if (split != std::string::npos)
    return std::pair(setting.substr(0, split), setting.substr(split + 1));
  return Error{ErrorKind::kUsage,
               "--set " + setting + ": expected KEY=VALUE",
               {},
               "for example sim.duration=5"};
}

void SceneOptions::add_to(CLI::App& command) {
  command.add_option("--seed", seed, "Seed of all random numbers; default: the scene's");
  command.add_option("--set", settings,
                     "Change a setting of the scene, such as sim.duration=5 (repeatable)");
  add_access_options(command, access, packages);
}

void SceneOptions::add_keyframe_to(CLI::App& command) {
  command.add_option(
      "--keyframe", keyframe,
      "Initial keyframe of a model, by name or number; in a scene, set it in the [[robot]]");
}

namespace {

/// Adds an option whose values are the names of an enum.
template <NamedEnum Enum>
void add_named_option(CLI::App& command, const char* name, std::optional<Enum>* value,
                      const char* description) {
  command
      .add_option_function<std::string>(
          name, [value](const std::string& text) { *value = find_enum<Enum>(text); }, description)
      ->check(CLI::IsMember(enum_names<Enum>()));
}

// A log that is resumed has its own World: options that would change it are rejected by name,
// except the `kept` ones, which affect only the new run.
void refuse_beside_log(const CLI::App& command, const std::vector<const CLI::Option*>& options) {
  constexpr std::string_view kAllowedOptions[] = {"--camera", "--resolution", "--threads"};
  const CLI::Option* at = command.get_option_no_throw("--at");
  if (at == nullptr || at->count() == 0) return;
  for (const CLI::Option* option : options) {
    const std::string name = option->get_name();
    if (option->count() > 0 &&
        std::ranges::find(kAllowedOptions, name) == std::end(kAllowedOptions))
      throw CLI::ParseError(
          fmt::format(
              "{} cannot be combined with --at, which resumes a log unchanged; to run a changed "
              "scene with the log's Commands, use gloam replay LOG --restep --set …",
              name),
          CLI::ExitCodes::InvalidError);
  }
}

}  // namespace

void RenderFlags::add_to(CLI::App& command) {
  command
      .add_option("--spp", spp,
                  "Samples per pixel, or the maximum if --error is given; default: the scene's, or "
                  "4; with --error: 4096")
      ->check(CLI::Range(1, 65536));
  command
      .add_option("--error", error,
                  "Sample each pixel until its standard error is this fraction of its value, such "
                  "as 0.02; path tier")
      ->check(CLI::Range(1e-4, 1.0));
  command
      .add_option("--max-depth", max_depth,
                  "Maximum length of light paths, in vertices; default: the scene's, or 5, or 24 "
                  "with media and in the interactive tier")
      ->check(CLI::Range(1, 64));
  add_named_option(
      command, "--tier", &tier,
      "Rendering tier. path: unbiased light; interactive: real time, filtered; direct: one "
      "ambient light");
  add_named_option(command, "--device", &device,
                   "Rendering device; auto: an NVIDIA GPU if available, otherwise the CPU");
  command.add_option("--ev", ev100, "Exposure value at ISO 100; default: set by the scene's light");
  add_named_option(
      command, "--look", &look,
      "Lighting of models without lights. studio: soft light and a floor; model: as in "
      "MuJoCo's viewer; default: the scene's, or studio if nothing emits light");
  command
      .add_option("--groups", groups,
                  "Groups of geoms, tendons and sites to render, such as 0,1,2,3; default: 0,1,2")
      ->delimiter(',')
      ->check(CLI::Range(0, 5));
  command.add_flag("--sites", sites, "Render sites too");
  command.add_flag("--no-denoise", no_denoise, "Do not denoise the images");
  command.add_option("--threads", threads, "Number of rendering threads; 0: one per processor")
      ->check(CLI::Range(0, 1024));
}

void RenderFlags::apply_to(RenderOptions* render) const {
  if (error) {
    render->error = error;
    render->spp.reset();  // the scene's is a number for every pixel
  }
  if (spp) render->spp = *spp;
  if (max_depth) render->max_depth = *max_depth;
  if (tier) render->tier = tier;
  if (device) render->device = *device;
  if (look) render->look = *look;
  if (ev100) render->ev100 = *ev100;
  if (!groups.empty()) render->groups = groups;
  if (sites) render->sites = true;
  if (no_denoise) render->denoise = false;
}

std::vector<std::pair<std::string, std::string>> RenderFlags::as_settings() const {
  constexpr int kMostAdaptive = 4096;  // as RenderOptions::samples() with an error bound
  std::vector<std::pair<std::string, std::string>> list;
  const auto add = [&list](const char* option, const auto& value) {
    list.emplace_back(fmt::format("render.{}", option), fmt::format("{}", value));
  };
  if (error) add("error", *error);
  if (error || spp) add("spp", spp.value_or(kMostAdaptive));
  if (max_depth) add("max_depth", *max_depth);
  if (tier) add("tier", to_string(*tier));
  if (device) add("device", to_string(*device));
  if (look) add("look", to_string(*look));
  if (ev100) add("ev100", *ev100);
  if (!groups.empty()) add("groups", fmt::format("[{}]", fmt::join(groups, ", ")));
  if (sites) add("sites", true);
  if (no_denoise) add("denoise", false);
  return list;
}

void RunOptions::add_to(CLI::App& command) {
  const std::vector<CLI::Option*> others = command.get_options();
  command.add_option("--timestep", timestep, "Physics time step in seconds; default: the model's")
      ->check(positive_number());
  command.add_option("--camera", cameras,
                     "Name of a camera to use (repeatable); default: all cameras");
  command.add_option("--resolution", resolution,
                     "Image size of every camera in pixels, as WIDTHxHEIGHT");
  RenderFlags::add_to(command);
  command
      .add_option("--output", outputs,
                  fmt::format("Outputs to record: {}", fmt::join(kOutputNames, " ")))
      ->delimiter(',');
  add_keyframe_to(command);
  SceneOptions::add_to(command);
  std::vector<const CLI::Option*> own;
  for (const CLI::Option* option : command.get_options())
    if (std::ranges::find(others, option) == others.end()) own.push_back(option);
  // With --at no scene is loaded, where the number of threads would be set.
  command.parse_complete_callback([this, &command, own = std::move(own)] {
    refuse_beside_log(command, own);
    set_thread_count(threads);
  });
}

Result<Scene> SceneOptions::load(const std::string& file) {
  GLOAM_TRY_STATUS(apply_packages(access, packages));
  GLOAM_TRY(Scene scene, load_scene(file, access));
  for (const std::string& setting : settings) {
    GLOAM_TRY(const auto split, split_setting(setting));
    GLOAM_TRY_STATUS(set_option(scene, split.first, split.second));
  }
  if (seed) scene.sim.seed = *seed;
  return scene;
}

Result<World> SceneOptions::compile(const std::string& file, const Globals& globals) {
  GLOAM_TRY(const Scene scene, load(file));
  return cli::compile(scene, globals, keyframe);
}

Result<Scene> RunOptions::load(const std::string& file) {
  GLOAM_TRY(Scene scene, SceneOptions::load(file));
  if (duration) scene.sim.duration = *duration;
  if (timestep) scene.sim.timestep = *timestep;
  RenderFlags::apply_to(&scene.render);
  set_thread_count(threads);
  return scene;
}

}  // namespace gloam::cli
