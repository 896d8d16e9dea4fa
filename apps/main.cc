// The command line: thin, sees include/gloam/ only.

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <system_error>

#include "command.h"
#include "gloam/program.h"
#include "interrupt.h"
#include "out_of_memory.h"
#include "words.h"

namespace gloam::cli {
namespace {

constexpr std::array kCommands = {add_demo,    add_run,    add_studio,    add_record, add_replay,
                                  add_recover, add_render, add_info,      add_export, add_evaluate,
                                  add_report,  add_check,  add_cache,     add_props,  add_robots,
                                  add_convert, add_schema, add_completion};

/// Checks variables of the environment.
Status check_environment() {
  const Result<uint64_t> limit = cache_limit();
  return limit.ok() ? Status() : Status(limit.error());
}

int run_program(int argc, char** argv) {
  CLI::App app{
      "Gloam: a robotics simulator with unmodified MuJoCo physics and path-traced sensors.\nAlso "
      "in the source tree: ./gloam setup | test | bench | navigate | map | slam | match | real | "
      "mitsuba | "
      "gallery | docs | pack | python | wheel | doctor"};
  app.name("gloam");
  app.require_subcommand(1);
  app.fallthrough();
  app.set_version_flag("--version",
                       [] { return std::string("gloam ") + version() + "\n" + configuration(); });
  app.footer(
      "Example: gloam run examples/demo.toml --out results/first\nExit codes: 0 success, 1 "
      "failure, 2 usage error, 3 partial result, 130 interrupted");

  Globals globals;
  bool verbose = false;
  app.add_flag("--json", globals.json, "Print results as JSON to stdout");
  app.add_flag("-q,--quiet", globals.quiet, "Print warnings and errors only, no progress");
  app.add_flag("-v,--verbose", verbose, "Print debug messages");

  Action action;
  for (const auto add : kCommands) add(app, globals, action);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error, std::cout, std::cerr);  // --help
    // The program's own options take no value: the first word is the command.
    const auto word = std::find_if(argv + 1, argv + argc, [](const char* w) { return *w != '-'; });
    return fail(explain(app, word != argv + argc ? *word : "", error));
  }
  if (verbose) set_log_level(LogLevel::kDebug);
  if (globals.quiet) set_log_level(LogLevel::kWarning);
  if (const Status status = check_environment(); !status.ok()) return fail(status.error());
  return action();
}

/// True if all output has arrived. A reader that has seen enough (`| head`) is no fault.
int finish_data() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  if (::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0) return 0;
  return fail({ErrorKind::kIo, "cannot write to standard output", {}, "is the disk full?"});
}

}  // namespace
}  // namespace gloam::cli

int main(int argc, char** argv) {
#ifdef __AVX512F__
  if (!__builtin_cpu_supports("avx512f")) {
    std::cerr << "gloam: error: built for CPUs with AVX-512, which this CPU lacks: build it on "
                 "this machine, or with -DGLOAM_MARCH=x86-64-v3\n";
    return 1;
  }
#endif
  gloam::cli::end_when_out_of_memory();
  gloam::cli::catch_interrupts();
  try {
    const int code = gloam::cli::run_program(argc, argv);
    return code != 0 ? code : gloam::cli::finish_data();
  } catch (const std::system_error& error) {
    if (gloam::cli::is_want_of_memory(error)) gloam::cli::end_out_of_memory();
    if (std::ferror(stdout) == 0) throw;
    return gloam::cli::finish_data();  // fmt::print throws where nobody reads any more
  } catch (const std::bad_alloc&) {
    gloam::cli::end_out_of_memory();
  }
}
