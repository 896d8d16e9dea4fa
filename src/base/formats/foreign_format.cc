#include "base/formats/foreign_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <vector>

#include "base/files.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

using std::string_view_literals::operator""sv;

/// First bytes of a format. In a hint {0} is the file, {1} its name without the last ending.
struct Signature {
  std::string_view bytes, what, hint;
  size_t offset = 0;
};

constexpr std::string_view kConvertBag =
    "convert it: rosbags-convert --src {0} --dst {1}_mcap --dst-storage mcap (pip install "
    "rosbags), then give the .mcap file in {1}_mcap";
constexpr std::string_view kConvertFolder =
    "convert the folder of the bag: rosbags-convert --src FOLDER --dst {1}_mcap --dst-storage mcap "
    "(pip install rosbags), then give the .mcap file in {1}_mcap";
constexpr std::string_view kNoConverter =
    "Gloam reads logs in MCAP (docs/logs.md), trajectories as TUM, KITTI or EuRoC files, models in "
    "MJCF or URDF and scenes in TOML";

constexpr std::array kSignatures = {
    Signature{"SQLite format 3\0"sv, "is an SQLite database, such as that of a ROS 2 bag (.db3)",
              kConvertFolder},
    Signature{"#ROSBAG V"sv, "is a ROS 1 bag", kConvertBag},
    Signature{"#ROSRECORD V"sv, "is a ROS 1 bag in an early format",
              "rewrite it with rosbag fix {0} {1}_fixed.bag, then convert it to MCAP with "
              "rosbags-convert"},
    Signature{"\x28\xb5\x2f\xfd"sv, "is compressed with zstd", "decompress it: zstd -d {0}"},
    Signature{"\x1f\x8b"sv, "is compressed with gzip", "decompress it: gunzip {0}"},
    Signature{"BZh"sv, "is compressed with bzip2", "decompress it: bunzip2 {0}"},
    Signature{"\xfd\x37zXZ\0"sv, "is compressed with xz", "decompress it: unxz {0}"},
    Signature{"\x04\x22\x4d\x18"sv, "is compressed with LZ4", "decompress it: lz4 -d {0}"},
    Signature{"PK\x03\x04"sv, "is a ZIP archive", "unpack it: unzip {0}"},
    Signature{"PK\x05\x06"sv, "is an empty ZIP archive", "use another archive"},
    Signature{"7z\xbc\xaf\x27\x1c"sv, "is a 7-Zip archive", "unpack it: 7z x {0}"},
    Signature{"ustar"sv, "is a tar archive", "unpack it: tar -xf {0}", 257},
    Signature{"\x89HDF\r\n\x1a\n"sv, "is an HDF5 file",
              "write its poses to a TUM file or its messages to an MCAP log with h5py and mcap "
              "(pip install h5py mcap)"},
    Signature{"ULog\x01\x12\x35"sv, "is a PX4 log (ULog)",
              "convert it to a ROS 1 bag with ulog2rosbag from pyulog, then to MCAP with "
              "rosbags-convert"},
    Signature{"RRF"sv, "is a Rerun recording", kNoConverter},
    Signature{"PAR1"sv, "is a Parquet table", kNoConverter},
    Signature{"\x93NUMPY"sv, "is a NumPy array", kNoConverter},
    Signature{"\x7f"
              "ELF"sv,
              "is a program", kNoConverter},
    Signature{"\x89PNG\r\n"sv, "is a PNG image", kNoConverter},
    Signature{"\xff\xd8\xff"sv, "is a JPEG image", kNoConverter},
    Signature{"%PDF-"sv, "is a PDF document", kNoConverter},
};
constexpr size_t kSniffedBytes = 512;  // bytes of a file that are looked at
constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n"sv;

ForeignFormat of_file(const Signature& signature, const fs::path& path) {
  const std::string file = path.string(), stem = (path.parent_path() / path.stem()).string();
  // rosbag2 compresses the parts of a bag, which converters read by their folder.
  const bool is_bag = path.stem().extension() == ".db3";
  const std::string_view hint = is_bag ? kConvertFolder : signature.hint;
  return {std::string(signature.what), fmt::format(fmt::runtime(hint), file, stem)};
}

// A folder that rosbag2 has written: its metadata.yaml tells the storage.
std::optional<ForeignFormat> of_folder(const fs::path& folder) {
  const auto metadata = read_text_file(folder / "metadata.yaml", 16 << 20);
  if (!metadata.ok() || metadata->find("rosbag2_bagfile_information") == std::string::npos)
    return {};
  std::vector<std::string> parts;
  std::error_code code;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code))
    if (it->path().extension() == ".mcap") parts.push_back(it->path().string());
  std::ranges::sort(parts);
  if (!parts.empty())
    return ForeignFormat{"is the folder of a ROS 2 bag",
                         fmt::format("give its log: {}", fmt::join(parts, ", "))};
  const std::string name = (folder / "").parent_path().string();
  return ForeignFormat{"is the folder of a ROS 2 bag that is not in MCAP",
                       fmt::format(fmt::runtime(kConvertBag), name, name)};
}

}  // namespace

std::optional<ForeignFormat> foreign_format(const fs::path& path) {
  std::error_code code;
  if (fs::is_directory(path, code)) return of_folder(path);
  if (!fs::is_regular_file(path, code)) return {};
  std::ifstream stream(path, std::ios::binary);
  std::array<char, kSniffedBytes> buffer{};
  stream.read(buffer.data(), buffer.size());
  const std::string_view head(buffer.data(), static_cast<size_t>(stream.gcount()));
  if (stream.bad() || !stream.is_open()) return {};
  if (head.empty()) return ForeignFormat{"is empty", "it has 0 bytes: was it copied completely?"};
  if (head.size() < kMcapMagic.size() && kMcapMagic.starts_with(head))
    return ForeignFormat{
        fmt::format("is an MCAP log that is truncated after {} bytes", head.size()),
        "nothing can be recovered from it"};
  for (const Signature& signature : kSignatures)
    if (head.size() >= signature.offset &&
        head.substr(signature.offset).starts_with(signature.bytes))
      return of_file(signature, path);
  if (head.find("rosbag2_bagfile_information") != std::string_view::npos)
    return ForeignFormat{"describes a ROS 2 bag",
                         "give the .mcap file beside it; convert other storage formats with "
                         "rosbags-convert --dst-storage mcap"};
  return {};
}

Status refuse_foreign_format(const fs::path& path, const SourceLoc& loc) {
  const std::optional<ForeignFormat> format = foreign_format(path);
  if (!format) return {};
  const SourceLoc at = loc.file.empty() ? SourceLoc{path.string(), 0, 0} : loc;
  const std::string subject =
      loc.file.empty() ? std::string() : fmt::format("'{}' ", path.filename().string());
  return Error{ErrorKind::kUnsupported, subject + format->what, at, format->hint};
}

}  // namespace gloam
