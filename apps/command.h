#pragma once
// A command of the program: one file in commands/ and one line in the list of main.cc.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "gloam/result.h"
#include "gloam/run.h"
#include "gloam/scene.h"

namespace gloam::cli {

/// Set by main for every command.
struct Globals {
  bool json = false;
  bool quiet = false;
};

/// Action of a command after parsing; the value is the exit code.
using Action = std::function<int()>;

void add_demo(CLI::App& app, Globals& globals, Action& action);
void add_run(CLI::App& app, Globals& globals, Action& action);
void add_studio(CLI::App& app, Globals& globals, Action& action);
void add_record(CLI::App& app, Globals& globals, Action& action);
void add_replay(CLI::App& app, Globals& globals, Action& action);
void add_recover(CLI::App& app, Globals& globals, Action& action);
void add_render(CLI::App& app, Globals& globals, Action& action);
void add_info(CLI::App& app, Globals& globals, Action& action);
void add_export(CLI::App& app, Globals& globals, Action& action);
void add_evaluate(CLI::App& app, Globals& globals, Action& action);
void add_report(CLI::App& app, Globals& globals, Action& action);
void add_check(CLI::App& app, Globals& globals, Action& action);
void add_cache(CLI::App& app, Globals& globals, Action& action);
void add_props(CLI::App& app, Globals& globals, Action& action);
void add_robots(CLI::App& app, Globals& globals, Action& action);
void add_convert(CLI::App& app, Globals& globals, Action& action);
void add_schema(CLI::App& app, Globals& globals, Action& action);
void add_completion(CLI::App& app, Globals& globals, Action& action);

/// Prints "error: …" on stderr and returns the exit code.
int fail(const Error& error);

/// Checks of numbers on the command line. (CLI11's own messages print the largest double in full.)
CLI::Validator positive_number();
CLI::Validator non_negative_number();

/// Adds the options that limit the files which a model may read.
void add_access_options(CLI::App& command, FileAccess& access, std::vector<std::string>& packages);
/// Parses `packages` (NAME=FOLDER) into `access`.
Status apply_packages(FileAccess& access, const std::vector<std::string>& packages);
/// World::compile with progress on stderr; Ctrl-C ends the process meanwhile. Prints notes about
/// the scene and its unsupported elements on stderr. `keyframe`: as of World::compile_at, "" =
/// none.
Result<World> compile(const Scene& scene, const Globals& globals, const std::string& keyframe = "");
/// "640x480" -> width, height.
Status parse_resolution(const std::string& text, int& width, int& height);

/// A progress line on stderr: a bar with ETA on a terminal, a line now and then elsewhere.
std::function<void(const Progress&)> progress_line(const Globals& globals);
/// The same for a job that has files to finish: Ctrl-C stops the job. Before the first call, while
/// the job is prepared, Ctrl-C ends the process.
ProgressCallback progress_display(const Globals& globals);
/// Ends the progress line.
void finish_progress();

}  // namespace gloam::cli
