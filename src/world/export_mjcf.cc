#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <mutex>

#include "base/files.h"
#include "base/hash.h"
#include "base/log.h"
#include "scene/mujoco_guard.h"
#include "world/level.h"
#include "world/model_compare.h"

// Exported by MuJoCo 4.0.1 but declared in none of its headers: digits of the numbers in saved XML.
extern "C" {
int _mjPRIVATE__get_xml_precision(void);
void _mjPRIVATE__set_xml_precision(int precision);
}

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr int kExactDigits = 17;  // enough to write any double so that it is read back bit by bit
constexpr const char* kAssetFolder = "assets";

// The precision is one setting for the whole process.
class ExactNumbers {
 public:
  ExactNumbers() : lock_(mutex()), before_(_mjPRIVATE__get_xml_precision()) {
    _mjPRIVATE__set_xml_precision(kExactDigits);
  }
  ~ExactNumbers() { _mjPRIVATE__set_xml_precision(before_); }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;
  int before_;
};

// Copies the files of the level's assets and lets the spec name the copies.
class AssetWriter {
 public:
  AssetWriter(ModelFiles* files, const fs::path& folder) : files_(files), folder_(folder) {}

  Status write_all(mjSpec* spec, const mjModel* m) {
    GLOAM_TRY_STATUS(each(spec, mjOBJ_MESH, [&](mjsElement* e) -> Status {
      return write_one(e, mjs_asMesh(e)->file, m, m->mesh_pathadr);
    }));
    GLOAM_TRY_STATUS(each(spec, mjOBJ_HFIELD, [&](mjsElement* e) -> Status {
      return write_one(e, mjs_asHField(e)->file, m, m->hfield_pathadr);
    }));
    GLOAM_TRY_STATUS(each(spec, mjOBJ_SKIN, [&](mjsElement* e) -> Status {
      return write_one(e, mjs_asSkin(e)->file, m, m->skin_pathadr);
    }));
    GLOAM_TRY_STATUS(each(spec, mjOBJ_TEXTURE, [&](mjsElement* e) -> Status {
      mjsTexture* texture = mjs_asTexture(e);
      GLOAM_TRY_STATUS(write_one(e, texture->file, m, m->tex_pathadr));
      return write_faces(e, texture);
    }));
    mjs_setString(spec->compiler.meshdir, "");
    mjs_setString(spec->compiler.texturedir, "");
    spec->strippath = 0;
    return {};
  }

 private:
  template <class F>
  static Status each(mjSpec* spec, mjtObj type, F&& f) {
    for (mjsElement* e = mjs_firstElement(spec, type); e != nullptr; e = mjs_nextElement(spec, e))
      GLOAM_TRY_STATUS(f(e));
    return {};
  }

  Status write_one(mjsElement* element, mjString* file, const mjModel* m, const int* pathadr) {
    const std::string name = mjs_getString(file);
    const int id = mjs_getId(element);
    if (name.empty() || id < 0 || pathadr[id] < 0) return {};
    GLOAM_TRY(const std::string copy, copy_asset(m->paths + pathadr[id]));
    mjs_setString(file, copy.c_str());
    return {};
  }

  // The model keeps no paths of a cube's six files: they are found as MuJoCo finds them.
  Status write_faces(mjsElement* element, mjsTexture* texture) {
    constexpr int kFaces = 6;
    const mjSpec* origin = mjs_getOriginSpec(element);
    const fs::path folder = absolute_path(
        mjs_getString(mjs_getCompiler(element)->texturedir),
        origin != nullptr ? fs::path(mjs_getString(origin->modelfiledir)) : fs::path());
    for (int face = 0; face < kFaces; ++face) {
      const char* name = mjs_getInStringVec(texture->cubefiles, face);
      if (name == nullptr || *name == 0) continue;
      GLOAM_TRY(const std::string copy, copy_asset(absolute_path(name, folder)));
      mjs_setInStringVec(texture->cubefiles, face, copy.c_str());
    }
    return {};
  }

  // Equal files are written once; different ones of one name get a number.
  Result<std::string> copy_asset(const fs::path& path) {
    auto content = files_->read(path);
    if (!content.ok()) return content.error();
    const std::string& bytes = **content;
    const uint64_t hash = hash_bytes(bytes.data(), bytes.size());
    std::string name = path.filename().string();
    for (int number = 2;; ++number) {
      const auto [taken, is_new] = written_.emplace(name, hash);
      if (is_new) break;
      if (taken->second == hash) return fmt::format("{}/{}", kAssetFolder, name);
      name = fmt::format("{}_{}{}", path.stem().string(), number, path.extension().string());
    }
    GLOAM_TRY_STATUS(make_folder(folder_ / kAssetFolder));
    GLOAM_TRY_STATUS(
        write_file_atomic(folder_ / kAssetFolder / name,
                          {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}));
    return fmt::format("{}/{}", kAssetFolder, name);
  }

  ModelFiles* files_;
  fs::path folder_;
  std::map<std::string, uint64_t> written_;
};

// Writes the XML and loads it as any user of MuJoCo would. Empty = the same model came back.
Result<std::vector<std::string>> save_and_compare(mjSpec* spec, const mjModel* wanted,
                                                  const fs::path& path) {
  const std::string name = path.string();
  char message[2048] = "";
  int code = 0;
  {
    const ExactNumbers exact;
    const Status saved =
        guarded([&] { code = mj_saveXML(spec, name.c_str(), message, sizeof(message)); });
    if (!saved.ok()) return saved.error();
  }
  if (code != 0) return Error{ErrorKind::kUnsupported, message, {name, 0, 0}};
  mjModel* loaded = nullptr;
  const MujocoWarningCapture warnings;
  const Status status =
      guarded([&] { loaded = mj_loadXML(name.c_str(), nullptr, message, sizeof(message)); });
  const ModelPtr model(loaded);
  mj_freeLastXML();
  if (!status.ok()) return status.error();
  if (model == nullptr) return Error{ErrorKind::kUnsupported, message, {name, 0, 0}};
  return compare_models(wanted, model.get());
}

}  // namespace

Status World::export_mjcf(const fs::path& folder) const {
  // The spec is made anew: a World keeps what simulation needs, and a cached one never had it.
  const CompiledWorld& world = *compiled_;
  ModelFiles files;
  GLOAM_TRY_STATUS(add_scene_files(world.scene, &files));
  GLOAM_TRY(Level level, build_level(world.scene, &files));
  if (!compare_models(world.model.get(), level.model.get()).empty()) {
    return Error{ErrorKind::kInput,
                 "the model's files have changed since it was loaded",
                 {},
                 "load the scene again, then export"};
  }
  GLOAM_TRY_STATUS(make_folder(folder));
  mjSpec* spec = level.spec.get();
  AssetWriter assets(&files, folder);
  GLOAM_TRY_STATUS(assets.write_all(spec, level.model.get()));
  const fs::path path = folder / "scene.xml";
  // As written keeps every number exact. Where MJCF cannot say a level as written (robots with
  // different compiler settings), the compiled values can.
  std::string why;
  for (const bool compiled_values : {false, true}) {
    spec->compiler.savecompiled = compiled_values;
    const Result<std::vector<std::string>> differing =
        save_and_compare(spec, world.model.get(), path);
    if (differing.ok() && differing->empty()) return {};
    const std::string reason = differing.ok()
                                   ? fmt::format("differs in {}", fmt::join(*differing, ", "))
                                   : differing.error().message;
    log_debug("export {}: {}", compiled_values ? "of compiled values" : "as written", reason);
    if (!why.empty()) why += "; ";
    why += fmt::format("{}: {}", compiled_values ? "compiled values" : "as written", reason);
  }
  return Error{ErrorKind::kUnsupported,
               fmt::format("MJCF cannot say this level exactly: {:.500}", why),
               {path.string(), 0, 0},
               "the file was written and is close, but not equal in every array"};
}

}  // namespace gloam
