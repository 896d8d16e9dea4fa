#pragma once
// Strips of pictures: each camera at the same instants in all runs.

#include <span>
#include <string>
#include <vector>

#include "gloam/report.h"
#include "report/run_results.h"

namespace gloam {

struct StripPicture {
  std::string data_uri;  ///< JPEG; empty = there is none of that instant
  int width = 0, height = 0;
  double time = 0;  ///< of the picture [s]
};
struct PictureStrip {
  std::string camera;
  std::vector<double> instants;  ///< of the first row's pictures [s]
  struct Row {
    size_t run = 0;
    std::vector<StripPicture> pictures;  ///< (instants)
  };
  std::vector<Row> rows;
};

/// Strips of all cameras that have videos or PNG pictures. `left_out`: videos that cannot be read,
/// and pictures beyond the limit of bytes.
std::vector<PictureStrip> make_strips(const std::vector<RunResults>& runs,
                                      const ReportRequest& request, std::vector<Error>* left_out);

std::string base64(std::span<const uint8_t> bytes);

}  // namespace gloam
