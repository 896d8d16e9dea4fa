#include "policy/scratch_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>

namespace gloam {
namespace fs = std::filesystem;

Result<ScratchFolder> ScratchFolder::create() {
  std::error_code code;
  std::string name = (fs::temp_directory_path(code) / "gloam_network_XXXXXX").string();
  if (code || ::mkdtemp(name.data()) == nullptr)
    return Error{ErrorKind::kIo,
                 fmt::format("cannot create a temporary folder: {}", std::strerror(errno)),
                 {},
                 "set TMPDIR to a folder in which you may write"};
  ScratchFolder folder;
  folder.path_ = name;
  return folder;
}

ScratchFolder::~ScratchFolder() {
  std::error_code code;
  if (!path_.empty()) fs::remove_all(path_, code);
}

}  // namespace gloam
