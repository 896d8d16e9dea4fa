#include "geometry/mesh/mtl_reader.h"
#include "geometry/mesh/text_lines.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  gloam::ModelFileOptions options;
  gloam::ModelFile model;
  gloam::MemoryBudget budget(64 << 20);
  (void)gloam::parse_mtl({"fuzz.obj", {}, nullptr, &options}, gloam::as_text({data, size}),
                         "fuzz.mtl", &budget, &model)
      .ok();
  return 0;
}
