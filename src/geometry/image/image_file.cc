#include "geometry/image/image_file.h"

#include "base/files.h"
#include "base/plain_text.h"
#include "geometry/image/image_exr.h"

namespace gloam {

Result<Image8> read_image(const std::filesystem::path& path) {
  GLOAM_TRY(const std::vector<uint8_t> bytes, read_file(path, uint64_t{256} << 20));
  if (bytes.size() >= 4 && bytes[0] == 0x89 && bytes[1] == 'P' && bytes[2] == 'N' &&
      bytes[3] == 'G')
    return decode_png(bytes, path.string());
  if (bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff)
    return decode_jpeg(bytes, path.string());
  if (is_lfs_pointer({reinterpret_cast<const char*>(bytes.data()), bytes.size()}))
    return lfs_pointer_error(path.string());
  return Error{ErrorKind::kInput,
               "is neither a PNG nor a JPEG image",
               {path.string(), 0, 0},
               "convert it to PNG"};
}

Result<ImageF> decode_float_image(std::span<const uint8_t> bytes, const std::string& name,
                                  uint64_t max_pixels) {
  // An HDR's head is text, and some editors put a byte-order mark before a text.
  const bool is_marked =
      bytes.size() >= 3 && bytes[0] == 0xEF && bytes[1] == 0xBB && bytes[2] == 0xBF;
  if (is_marked) bytes = bytes.subspan(3);
  if (bytes.size() >= 2 && bytes[0] == '#' && bytes[1] == '?')
    return decode_hdr(bytes, name, max_pixels);
  GLOAM_TRY(const ExrImage exr, decode_exr(bytes, name, 4 * max_pixels));
  std::vector<const std::vector<float>*> planes;
  for (const char* channel : {"R", "G", "B", "A"}) {
    if (const std::vector<float>* plane = exr.find(channel)) planes.push_back(plane);
  }
  if (exr.find("R") == nullptr || planes.size() < 3) {
    planes = {exr.find("Y") != nullptr ? exr.find("Y") : &exr.planes.front()};
    if (exr.find("Y") == nullptr && exr.planes.size() != 1)
      return Error{ErrorKind::kInput,
                   "has neither R, G and B channels nor a single grey channel",
                   {name, 0, 0}};
  }
  ImageF out{exr.width, exr.height, static_cast<int>(planes.size()), {}};
  out.texels.resize(planes.front()->size() * planes.size());
  for (size_t c = 0; c < planes.size(); ++c)
    for (size_t i = 0; i < planes[c]->size(); ++i)
      out.texels[i * planes.size() + c] = (*planes[c])[i];
  return out;
}

Result<ImageF> read_float_image(const std::filesystem::path& path, uint64_t max_pixels) {
  GLOAM_TRY(const std::vector<uint8_t> bytes, read_file(path, uint64_t{2} << 30));
  if (is_lfs_pointer({reinterpret_cast<const char*>(bytes.data()), bytes.size()}))
    return lfs_pointer_error(path.string());
  return decode_float_image(bytes, path.string(), max_pixels);
}

}  // namespace gloam
