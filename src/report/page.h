#pragma once
// Sections of a report's page, as HTML. All texts of runs are escaped.

#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "report/picture_strips.h"
#include "report/run_results.h"

namespace gloam {

/// All that a page shows.
struct ReportContent {
  std::string title;
  std::vector<RunResults> runs;
  std::vector<RunGroup> groups;   ///< group_runs()
  std::vector<RunGroup> motions;  ///< same_motions()
  std::vector<PictureStrip> strips;
  std::vector<Error> left_out;
};

std::string header_section(const ReportContent& content);
std::string runs_section(const ReportContent& content);
std::string pictures_section(const ReportContent& content);
std::string results_section(const ReportContent& content);
/// Means over runs of a group, with intervals; "" where no group has two.
std::string groups_section(const ReportContent& content);
/// How often goals were reached; "" where no run tells.
std::string success_section(const ReportContent& content);
std::string curves_section(const ReportContent& content);
std::string ground_section(const ReportContent& content);
std::string left_out_section(const ReportContent& content);

/// The whole file.
std::string report_page(const ReportContent& content);

/// A run's name behind a sample of its colour.
std::string run_tag(const RunResults& run);
/// Names of results in the order of the runs.
std::vector<std::string> result_names(const std::vector<RunResults>& runs);

}  // namespace gloam
