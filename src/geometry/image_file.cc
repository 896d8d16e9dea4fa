#include "geometry/image_file.h"

#include "base/files.h"

namespace gloam {

Result<Image8> read_image(const std::filesystem::path& path) {
  GLOAM_TRY(const std::vector<uint8_t> bytes, read_file(path, uint64_t{256} << 20));
  if (bytes.size() >= 4 && bytes[0] == 0x89 && bytes[1] == 'P' && bytes[2] == 'N' &&
      bytes[3] == 'G')
    return decode_png(bytes, path.string());
  if (bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff)
    return decode_jpeg(bytes, path.string());
  return Error{ErrorKind::kInput,
               "is neither a PNG nor a JPEG picture",
               {path.string(), 0, 0},
               "convert it to PNG"};
}

}  // namespace gloam
