// Files of results folders: a table, or the index of a video.

#include <cstdlib>
#include <string_view>

#include "report/metric_table.h"
#include "report/video_frames.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto table = gloam::parse_metric_table(
      std::string_view(reinterpret_cast<const char*>(data), size), "fuzz");
  if (table.ok())
    for (const auto& column : table->values)
      if (column.size() != table->rows()) std::abort();
  if (!table.ok() && table.error().to_string().find('\n') != std::string::npos) std::abort();
  const auto video = gloam::index_video({data, size}, "fuzz");
  if (video.ok())
    for (const auto& sample : video->samples)
      if (sample.offset + sample.size > size) std::abort();
  return 0;
}
