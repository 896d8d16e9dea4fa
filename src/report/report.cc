// gloam report: from results folders to one file.

#include <fmt/format.h>

#include <set>

#include "base/files.h"
#include "gloam/report.h"
#include "report/page.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostRuns = 200;

std::string title_of(const std::vector<RunResults>& runs) {
  std::set<std::string> titles;
  for (const RunResults& run : runs) titles.insert(run.title.empty() ? run.label : run.title);
  std::string out;
  for (const std::string& title : titles) out += (out.empty() ? "" : ", ") + title;
  return out.size() > 120 ? fmt::format("{} scenes", titles.size()) : out;
}

}  // namespace

Result<ReportOutcome> write_report(const ReportRequest& request) {
  std::error_code code;
  if (fs::exists(request.out, code) && !request.overwrite)
    return Error{ErrorKind::kUsage,
                 "already exists",
                 {request.out.string(), 0, 0},
                 "choose another file with -o, or replace it with --overwrite"};
  if (request.runs.size() > kMostRuns)
    return Error{ErrorKind::kUsage, fmt::format("more than {} runs in one report", kMostRuns)};
  ReportContent content;
  for (const fs::path& folder : request.runs) {
    auto run = read_run_results(folder, &content.left_out);
    if (run.ok())
      content.runs.push_back(std::move(*run));
    else
      content.left_out.push_back(run.error());
  }
  if (content.runs.empty())
    return content.left_out.empty() ? Error{ErrorKind::kUsage, "no runs given"}
                                    : content.left_out.front();
  label_runs(&content.runs);
  content.title = request.title.empty() ? title_of(content.runs) : request.title;
  content.groups = group_runs(content.runs);
  content.motions = same_motions(content.runs);
  content.strips = make_strips(content.runs, request, &content.left_out);
  const std::string page = report_page(content);
  GLOAM_TRY_STATUS(write_text_file_atomic(request.out, page));
  ReportOutcome outcome;
  outcome.runs = content.runs.size();
  outcome.bytes = page.size();
  outcome.left_out = std::move(content.left_out);
  for (const PictureStrip& strip : content.strips)
    for (const PictureStrip::Row& row : strip.rows)
      for (const StripPicture& picture : row.pictures)
        outcome.pictures += picture.data_uri.empty() ? 0 : 1;
  return outcome;
}

}  // namespace gloam
