// Tables of a report: runs, results, groups, success.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "report/bootstrap.h"
#include "report/metric_names.h"
#include "report/page.h"
#include "report/svg_chart.h"

namespace gloam {
namespace {

std::string value_cell(double value, bool is_best) {
  return fmt::format("<td class=\"n{}\">{}</td>", is_best ? " best" : "",
                     std::isnan(value) ? "–" : short_number(value));
}

// "vx error rms [%]" under its robot.
std::string name_cell(const MetricName& name) {
  return fmt::format(
      "<td>{}{}</td>", html_text(name.text),
      name.unit.empty() ? "" : " <span class=\"soft\">[" + html_text(name.unit) + "]</span>");
}

std::string subject_row(const MetricName& name, size_t columns, std::string* last) {
  if (name.subject == *last) return {};
  *last = name.subject;
  return fmt::format("<tr class=\"head\"><td colspan=\"{}\">{}</td></tr>", columns + 1,
                     name.subject.empty() ? "all" : html_text(name.subject));
}

// The best of values that differ, where it is known what is better; NaN = none.
double best_of(const std::vector<double>& values, Better better) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values)
    if (!std::isnan(v)) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  if (better == Better::kUnknown || !(low < high)) return std::numeric_limits<double>::quiet_NaN();
  return better == Better::kLess ? low : high;
}

std::vector<double> values_of(const ReportContent& content, const RunGroup& group,
                              const std::string& name) {
  std::vector<double> values;
  for (const size_t i : group.runs)
    if (const double value = content.runs[i].result(name); !std::isnan(value))
      values.push_back(value);
  return values;
}

std::string interval_text(const MeanInterval& mean) {
  if (mean.count < 2) return short_number(mean.mean);
  return fmt::format("{} <span class=\"soft\">[{}, {}]</span>", short_number(mean.mean),
                     short_number(mean.low), short_number(mean.high));
}

std::string group_heads(const ReportContent& content) {
  std::string out;
  for (const RunGroup& group : content.groups)
    out +=
        fmt::format("<th class=\"n\">{}<br><span class=\"soft\">{} run{}</span></th>",
                    html_text(group.label), group.runs.size(), group.runs.size() == 1 ? "" : "s");
  return out;
}

bool has_repetitions(const ReportContent& content) {
  return std::any_of(content.groups.begin(), content.groups.end(),
                     [](const RunGroup& group) { return group.runs.size() > 1; });
}

// Groups in which some runs made one and the same motion are fewer samples than they seem.
std::string repetition_note(const ReportContent& content) {
  std::string out;
  for (const RunGroup& group : content.groups) {
    size_t different = group.runs.size();
    for (const RunGroup& motion : content.motions) {
      const auto inside = std::count_if(motion.runs.begin(), motion.runs.end(), [&](size_t i) {
        return std::find(group.runs.begin(), group.runs.end(), i) != group.runs.end();
      });
      different -= inside > 1 ? static_cast<size_t>(inside) - 1 : 0;
    }
    if (different < group.runs.size())
      out += fmt::format(
          "<p class=\"note\">{}: {} runs have {} different motion{}; repetitions of the same "
          "motion make an interval look narrower than it is.</p>",
          html_text(group.label), group.runs.size(), different, different == 1 ? "" : "s");
  }
  return out;
}

}  // namespace

std::string results_section(const ReportContent& content) {
  const std::vector<std::string> names = result_names(content.runs);
  if (names.empty()) return {};
  std::string out = "<h2>Results</h2><div class=\"scroll\"><table><tr><th></th>";
  for (const RunResults& run : content.runs)
    out += fmt::format("<th class=\"n\">{}</th>", run_tag(run));
  out += "</tr>";
  std::string last = "\n";
  bool any_best = false;
  const bool are_as_long =
      std::all_of(content.runs.begin(), content.runs.end(), [&](const RunResults& run) {
        return std::fabs(run.simulated - content.runs[0].simulated) <= 1e-3 * run.simulated;
      });
  for (const std::string& full_name : names) {
    const MetricName name = split_metric_name(full_name);
    std::vector<double> values;
    for (const RunResults& run : content.runs) values.push_back(run.result(full_name));
    const double best = best_of(values, are_as_long ? better_of(full_name) : Better::kUnknown);
    out += subject_row(name, content.runs.size(), &last) + "<tr>" + name_cell(name);
    for (const double value : values) out += value_cell(value, value == best);
    out += "</tr>";
    any_best = any_best || !std::isnan(best);
  }
  out += "</table></div>";
  if (!are_as_long)
    out += "<p class=\"note\">The runs have different durations: no best value is marked.</p>";
  if (any_best)
    out +=
        "<p class=\"soft\">Marked: the best value, if a smaller value (errors, falls, collisions) "
        "or a larger value (success) is known to be better.</p>";
  return out;
}

std::string groups_section(const ReportContent& content) {
  const std::vector<std::string> names = result_names(content.runs);
  if (!has_repetitions(content) || names.empty()) return {};
  std::string out = "<h2>Means over repetitions</h2><div class=\"scroll\"><table><tr><th></th>" +
                    group_heads(content) + "</tr>";
  std::string last = "\n";
  for (const std::string& full_name : names) {
    const MetricName name = split_metric_name(full_name);
    out += subject_row(name, content.groups.size(), &last) + "<tr>" + name_cell(name);
    for (const RunGroup& group : content.groups) {
      const std::vector<double> values = values_of(content, group, full_name);
      out += "<td class=\"n\">" +
             (values.empty() ? "–" : interval_text(bootstrap_mean(values, full_name))) + "</td>";
    }
    out += "</tr>";
  }
  return out +
         "</table></div><p class=\"soft\">Mean and its 95 % interval: percentile bootstrap over "
         "runs, 10,000 draws (Efron and Tibshirani 1993). With fewer than about five runs, the "
         "interval is only a rough estimate. Runs of one scene with the same settings are "
         "repetitions if the names of their folders differ only in the number at the end.</p>" +
         repetition_note(content);
}

std::string success_section(const ReportContent& content) {
  std::string rows;
  for (const std::string& full_name : result_names(content.runs)) {
    if (split_metric_name(full_name).text != "success") continue;
    rows += "<tr><td>" + html_text(split_metric_name(full_name).subject) + "</td>";
    for (const RunGroup& group : content.groups) {
      const std::vector<double> values = values_of(content, group, full_name);
      const auto reached =
          std::count_if(values.begin(), values.end(), [](double v) { return v >= 1; });
      rows += values.empty() ? "<td class=\"n\">–</td>"
                             : fmt::format("<td class=\"n\">{} of {}</td>", reached, values.size());
    }
    rows += "</tr>";
  }
  if (rows.empty()) return {};
  return "<h2>Goals reached</h2><div class=\"scroll\"><table><tr><th></th>" + group_heads(content) +
         "</tr>" + rows + "</table></div>";
}

std::string runs_section(const ReportContent& content) {
  std::string out =
      "<h2>Runs</h2><div class=\"scroll\"><table><tr><th>run</th><th>scene</th><th "
      "class=\"n\">seed</th><th class=\"n\">simulated [s]</th><th class=\"n\">steps</th><th>state "
      "hash at the end</th><th>ended</th><th>settings</th></tr>";
  for (const RunResults& run : content.runs) {
    std::string settings;
    for (const auto* texts : {&run.settings, &run.drawn})
      for (const auto& [name, value] : *texts)
        settings += (settings.empty() ? "" : ", ") + html_text(name + " " + value);
    const std::string ended = run.state == "finished"            ? run.exit_reason
                              : run.state.starts_with("stopped") ? run.state
                                                                 : "not finished";
    out += fmt::format(
        "<tr><td>{}</td><td>{}<br><code class=\"soft\">{}</code></td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td><td class=\"n\">{}</td><td><code>{}</code></td><td{}>{}</td><td "
        "class=\"soft\">{}</td></tr>",
        run_tag(run), html_text(run.scene_file), html_text(run.scene_hash), html_text(run.seed),
        short_number(run.simulated), run.steps, html_text(run.final_hash),
        run.is_finished() ? "" : " class=\"bad\"", html_text(ended), settings);
  }
  out += "</table></div>";
  std::set<std::string> configurations;
  for (const RunResults& run : content.runs)
    for (const auto& [name, value] : run.versions)
      if (name == "configuration") configurations.insert(value);
  for (const std::string& configuration : configurations)
    out += "<p class=\"soft\">" + html_text(configuration) + "</p>";
  return out;
}

}  // namespace gloam
