// gloam evaluate: errors of a trajectory against a reference, as evo measures them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "command.h"
#include "gloam/report.h"
#include "json_text.h"
#include "print.h"
#include "trajectory_source.h"

namespace gloam::cli {
namespace {

using Json = nlohmann::ordered_json;

struct EvaluateCommand {
  std::string estimate, reference, align = "se3", unit = "m", plot;
  std::optional<double> delta;
  double tolerance = 0.1;
  AssociationOptions association;
  bool all_pairs = false;
};

const std::map<std::string, Alignment> kAlignments = {{"se3", Alignment::kSe3},
                                                      {"sim3", Alignment::kSim3},
                                                      {"scale", Alignment::kScale},
                                                      {"origin", Alignment::kOrigin},
                                                      {"none", Alignment::kNone}};

constexpr double kDegrees = 180 / std::numbers::pi;

/// One kind of error in its three parts.
struct ErrorParts {
  PoseErrors translation, angle, full;
};

struct Evaluation {
  size_t reference_poses = 0, estimate_poses = 0;
  TrajectoryPair pair;
  Similarity alignment;
  ErrorParts absolute;
  std::optional<ErrorParts> relative;
  std::string no_relative;  // why there are none
  std::vector<std::string> notes;
};

RelativeOptions relative_options(const EvaluateCommand& command) {
  RelativeOptions options;
  options.delta = command.delta.value_or(1);
  options.all_pairs = command.all_pairs;
  options.tolerance = command.tolerance;
  if (command.unit == "m") options.unit = DeltaUnit::kMeters;
  if (command.unit == "s") options.unit = DeltaUnit::kSeconds;
  if (command.unit == "rad" || command.unit == "deg") options.unit = DeltaUnit::kRadians;
  if (command.unit == "deg") options.delta /= kDegrees;
  return options;
}

Result<ErrorParts> relative_parts(const TrajectoryPair& pair, const RelativeOptions& options) {
  ErrorParts parts;
  GLOAM_TRY(parts.translation, relative_errors(pair, ErrorPart::kTranslation, options));
  GLOAM_TRY(parts.angle, relative_errors(pair, ErrorPart::kAngle, options));
  GLOAM_TRY(parts.full, relative_errors(pair, ErrorPart::kFull, options));
  return parts;
}

Result<Evaluation> evaluate(const EvaluateCommand& command) {
  Evaluation out;
  GLOAM_TRY(const Trajectory reference, load_trajectory(command.reference));
  GLOAM_TRY(const Trajectory estimate, load_trajectory(command.estimate));
  for (const Trajectory* side : {&reference, &estimate})
    out.notes.insert(out.notes.end(), side->notes.begin(), side->notes.end());
  out.reference_poses = reference.size();
  out.estimate_poses = estimate.size();
  GLOAM_TRY(out.pair, associate(reference, estimate, command.association));
  GLOAM_TRY(out.alignment, align(kAlignments.at(command.align), &out.pair));
  GLOAM_TRY(out.absolute.translation, absolute_errors(out.pair, ErrorPart::kTranslation));
  GLOAM_TRY(out.absolute.angle, absolute_errors(out.pair, ErrorPart::kAngle));
  GLOAM_TRY(out.absolute.full, absolute_errors(out.pair, ErrorPart::kFull));
  auto relative = relative_parts(out.pair, relative_options(command));
  // A delta that was asked for must be there; the usual one may be longer than the way.
  if (!relative.ok() && command.delta) return relative.error();
  if (relative.ok())
    out.relative = std::move(*relative);
  else
    out.no_relative = relative.error().to_string();
  return out;
}

Json statistics_json(const PoseErrors& errors) {
  const ErrorStatistics& s = errors.statistics;
  return {{"count", errors.values.size()},
          {"rmse", s.rmse},
          {"mean", s.mean},
          {"median", s.median},
          {"std", s.std},
          {"min", s.min},
          {"max", s.max},
          {"sse", s.sse}};
}

Json parts_json(const ErrorParts& parts) {
  return {{"translation_m", statistics_json(parts.translation)},
          {"angle_rad", statistics_json(parts.angle)},
          {"full", statistics_json(parts.full)}};
}

void print_json(const EvaluateCommand& command, const Evaluation& found) {
  const Similarity& X = found.alignment;
  Json json = {{"reference", command.reference},
               {"estimate", command.estimate},
               {"reference_poses", found.reference_poses},
               {"estimate_poses", found.estimate_poses},
               {"pairs", found.pair.reference.size()},
               {"reference_length_m", found.pair.reference.path_length()},
               {"estimate_length_m", found.pair.estimate.path_length()},
               {"align",
                {{"by", command.align},
                 {"rotation_rows", X.R_AB},
                 {"rotation_undetermined", X.is_turn_open},
                 {"translation_m", {X.p_AB.x, X.p_AB.y, X.p_AB.z}},
                 {"scale", X.scale}}},
               {"ate", parts_json(found.absolute)},
               {"rpe", found.relative ? parts_json(*found.relative) : Json()},
               {"notes", found.notes}};
  if (found.relative) {
    json["rpe"]["delta"] = command.delta.value_or(1);
    json["rpe"]["delta_unit"] = command.unit;
    json["rpe"]["all_pairs"] = command.all_pairs;
  }
  put_json(json);
}

void print_row(const std::string& name, const PoseErrors& errors, double factor) {
  const ErrorStatistics& s = errors.statistics;
  say("{:<30}", name);
  for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max})
    say(" {:>10.5g}", factor * value);
  say(" {:>7}\n", errors.values.size());
}

void print_text(const EvaluateCommand& command, const Evaluation& found) {
  const TrajectoryPair& pair = found.pair;
  say("reference  {}: {} poses\nestimate   {}: {} poses\n", command.reference,
      found.reference_poses, command.estimate, found.estimate_poses);
  say("{} pairs of poses; path length {:.5g} m in the reference, {:.5g} m in the estimate\n",
      pair.reference.size(), pair.reference.path_length(), pair.estimate.path_length());
  const RotationRows& R = found.alignment.R_AB;
  const Vec3& p = found.alignment.p_AB;
  const double cosine = std::clamp((R[0] + R[4] + R[8] - 1) / 2, -1.0, 1.0);
  say("aligned by {}: rotated by {:.4g} deg, translated by {:.4g} {:.4g} {:.4g} m, scale "
      "{:.6g}\n\n",
      command.align, std::acos(cosine) * kDegrees, p.x, p.y, p.z, found.alignment.scale);
  say("{:<30}", "");
  for (const char* name : {"rmse", "mean", "median", "std", "min", "max"}) say(" {:>10}", name);
  say(" {:>7}\n", "count");
  print_row("ATE translation [m]", found.absolute.translation, 1);
  print_row("ATE rotation [deg]", found.absolute.angle, kDegrees);
  if (!found.relative) {
    tell("gloam: note: no relative errors: {}\n", found.no_relative);
    return;
  }
  const std::string per = fmt::format("per {:g} {}", command.delta.value_or(1),
                                      command.unit == "f" ? "frames" : command.unit);
  print_row("RPE translation [m] " + per, found.relative->translation, 1);
  print_row("RPE rotation [deg] " + per, found.relative->angle, kDegrees);
}

Status write_plot(const EvaluateCommand& command, const Evaluation& found) {
  std::error_code code;
  if (std::filesystem::exists(command.plot, code))
    return Error{
        ErrorKind::kUsage, "file '" + command.plot + "' already exists", {}, "choose another name"};
  std::ofstream out(command.plot, std::ios::binary);
  out << trajectory_plot(found.pair, found.absolute.translation);
  if (!out.flush())
    return Error{ErrorKind::kIo, "cannot write " + command.plot, {}, "is the disk full?"};
  return {};
}

int run_evaluation(const EvaluateCommand& command, const Globals& globals) {
  const auto found = evaluate(command);
  if (!found.ok()) return fail(found.error());
  if (!command.plot.empty())
    if (const Status written = write_plot(command, *found); !written.ok())
      return fail(written.error());
  for (const std::string& note : found->notes) tell("gloam: note: {}\n", note);
  if (globals.json)
    print_json(command, *found);
  else
    print_text(command, *found);
  return 0;
}

}  // namespace

void add_evaluate(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand(
      "evaluate", "Compute the errors of a trajectory against a reference: ATE and RPE");
  auto command = std::make_shared<EvaluateCommand>();
  sub->add_option("ESTIMATE", command->estimate,
                  "TUM, KITTI or EuRoC file, or a topic of a log, such as run.mcap:/odom")
      ->required();
  sub->add_option("--reference", command->reference,
                  "Reference trajectory (ground truth), in the same form")
      ->required();
  sub->add_option(
         "--align", command->align,
         "Alignment: se3 (default), sim3 (with scale), scale, origin (first poses) or none")
      ->check(CLI::IsMember({"se3", "sim3", "scale", "origin", "none"}));
  sub->add_option("--rpe-delta", command->delta,
                  "Distance between the poses that RPE compares; default: 1")
      ->check(positive_number());
  sub->add_option("--rpe-unit", command->unit,
                  "Unit of --rpe-delta: m along the path (default), f (frames), s, deg or rad")
      ->check(CLI::IsMember({"m", "f", "s", "deg", "rad"}));
  sub->add_flag("--all-pairs", command->all_pairs,
                "Start an RPE pair at every pose, not only where the previous pair ends");
  sub->add_option(
         "--rpe-tolerance", command->tolerance,
         "Tolerance of the distance as a fraction of --rpe-delta, with --all-pairs; default: 0.1")
      ->check(non_negative_number());
  sub->add_option("--max-difference", command->association.max_difference,
                  "Largest time difference between matching poses in seconds; default: 0.01")
      ->check(non_negative_number());
  sub->add_option("--offset", command->association.offset,
                  "Offset added to the times of the estimate, in seconds; default: 0");
  sub->add_option("--plot", command->plot,
                  "SVG file to write: both paths from above, and the errors over time");
  sub->footer(
      "Examples:\n  gloam evaluate odom.tum --reference truth.tum\n  gloam evaluate "
      "run.mcap:/go/slam --reference run.mcap:/tf:go/trunk --align none --plot go.svg");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return run_evaluation(*command, globals); };
  });
}

}  // namespace gloam::cli
