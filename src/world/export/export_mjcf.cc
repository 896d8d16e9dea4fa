#include "world/export/export_mjcf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>

#include "base/files.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/text.h"
#include "geometry/image/png_writer.h"
#include "places/generators.h"
#include "places/writer/spec_edit.h"
#include "scene/files/mujoco_compiles.h"
#include "scene/files/mujoco_guard.h"
#include "world/compile/level.h"
#include "world/compile/mesh_object.h"
#include "world/export/export_visuals.h"
#include "world/export/model_compare.h"
#include "world/export/xml_zeros.h"

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
      GLOAM_TRY_STATUS(write_one(e, mjs_asHField(e)->file, m, m->hfield_pathadr));
      return write_heights(e, mjs_asHField(e), m);
    }));
    GLOAM_TRY_STATUS(each(spec, mjOBJ_SKIN, [&](mjsElement* e) -> Status {
      return write_one(e, mjs_asSkin(e)->file, m, m->skin_pathadr);
    }));
    GLOAM_TRY_STATUS(each(spec, mjOBJ_TEXTURE, [&](mjsElement* e) -> Status {
      mjsTexture* texture = mjs_asTexture(e);
      GLOAM_TRY_STATUS(write_one(e, texture->file, m, m->tex_pathadr));
      GLOAM_TRY_STATUS(write_pixels(e, texture, m));
      return write_faces(e, texture);
    }));
    use_copies(&spec->compiler);
    spec->strippath = 0;
    return {};
  }

  // In compiled values MuJoCo names files as they were found when it last compiled: now it finds
  // the copies.
  Status compile_again(mjSpec* spec) {
    for (const mjtObj type : {mjOBJ_MESH, mjOBJ_HFIELD, mjOBJ_SKIN, mjOBJ_TEXTURE}) {
      GLOAM_TRY_STATUS(each(spec, type, [&](mjsElement* e) -> Status {
        use_copies(mjs_getCompiler(e));
        if (mjSpec* origin = mjs_getOriginSpec(e); origin != nullptr) {
          edit(mjs_setString, origin->modelfiledir, fs::absolute(folder_).c_str());
          origin->strippath = 0;
        }
        return {};
      }));
    }
    edit(mjs_setString, spec->modelfiledir, fs::absolute(folder_).c_str());
    mjModel* model = nullptr;
    const MujocoWarningCapture warnings;
    const MujocoCompiles threads;
    GLOAM_TRY_STATUS(guarded([&] { model = mj_compile(spec, nullptr); }));
    const ModelPtr compiled(model);
    if (compiled == nullptr) return Error{ErrorKind::kUnsupported, mjs_getError(spec)};
    return {};
  }

 private:
  static void use_copies(mjsCompiler* compiler) {
    edit(mjs_setString, compiler->meshdir, "");
    edit(mjs_setString, compiler->texturedir, "");
  }

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
    edit(mjs_setString, file, copy.c_str());
    return {};
  }

  // Pictures of generated things come from no file, and MJCF has no other place for them.
  Status write_pixels(mjsElement* element, mjsTexture* texture, const mjModel* m) {
    const int id = mjs_getId(element);
    const bool has_file = *mjs_getString(texture->file) != 0;
    if (id < 0 || has_file || texture->builtin != mjBUILTIN_NONE || texture->type != mjTEXTURE_2D)
      return {};
    const int width = m->tex_width[id], height = m->tex_height[id], channels = m->tex_nchannel[id];
    const auto size = static_cast<size_t>(width) * static_cast<size_t>(height * channels);
    const std::vector<uint8_t> png =
        encode_png8(width, height, channels, {m->tex_data + m->tex_adr[id], size});
    std::string name = mjs_getString(mjs_getName(element));
    std::replace(name.begin(), name.end(), '/', '_');
    GLOAM_TRY(const std::string copy, write_copy(name, ".png", png));
    edit(mjs_setString, texture->file, copy.c_str());
    edit(mjs_setBuffer, texture->data, nullptr, 0);
    return {};
  }

  // Heights that come from no file could stand in the XML, but a million of them do not belong
  // there: MuJoCo's own binary format has rows, columns (int32) and the elevations (float).
  Status write_heights(mjsElement* element, mjsHField* hfield, const mjModel* m) {
    const int id = mjs_getId(element);
    if (id < 0 || *mjs_getString(hfield->file) != 0) return {};
    const int32_t shape[2] = {m->hfield_nrow[id], m->hfield_ncol[id]};
    const std::span<const float> heights(
        m->hfield_data + m->hfield_adr[id],
        static_cast<size_t>(shape[0]) * static_cast<size_t>(shape[1]));
    if (std::all_of(heights.begin(), heights.end(), [](float h) { return h == 0; })) return {};
    std::vector<uint8_t> bytes(sizeof(shape) + heights.size_bytes());
    std::memcpy(bytes.data(), shape, sizeof(shape));
    std::memcpy(bytes.data() + sizeof(shape), heights.data(), heights.size_bytes());
    std::string name = mjs_getString(mjs_getName(element));
    std::replace(name.begin(), name.end(), '/', '_');
    GLOAM_TRY(const std::string copy, write_copy(name, ".hfield", bytes));
    edit(mjs_setString, hfield->file, copy.c_str());
    edit(mjs_setFloat, hfield->userdata, nullptr, 0);
    hfield->nrow = hfield->ncol = 0;
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
      edit(mjs_setInStringVec, texture->cubefiles, face, copy.c_str());
    }
    return {};
  }

  // Equal files are written once; different ones of one name get a number.
  Result<std::string> copy_asset(const fs::path& path) {
    auto content = files_->read(path);
    if (!content.ok()) return content.error();
    const std::string& bytes = **content;
    return write_copy(path.stem().string(), path.extension().string(),
                      {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
  }

  Result<std::string> write_copy(const std::string& stem, const std::string& extension,
                                 std::span<const uint8_t> bytes) {
    const uint64_t hash = hash_bytes(bytes.data(), bytes.size());
    std::string name = stem + extension;
    for (int number = 2;; ++number) {
      // File systems of Windows and macOS take "A" and "a" for one name.
      const auto [taken, is_new] = written_.emplace(lower_case(name), hash);
      if (is_new) break;
      if (taken->second == hash) return fmt::format("{}/{}", kAssetFolder, name);
      name = fmt::format("{}_{}{}", stem, number, extension);
    }
    GLOAM_TRY_STATUS(make_folder(folder_ / kAssetFolder));
    GLOAM_TRY_STATUS(write_file_atomic(folder_ / kAssetFolder / name, bytes));
    return fmt::format("{}/{}", kAssetFolder, name);
  }

  ModelFiles* files_;
  fs::path folder_;
  std::map<std::string, uint64_t> written_;
};

Status save_exact(mjSpec* spec, const fs::path& path) {
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
  return {};
}

// Loads the XML as any user of MuJoCo would.
Result<ExportedModel> load_and_compare(const mjModel* wanted, const fs::path& path) {
  GLOAM_TRY(const ModelPtr model, load_stock_model(path));
  ExportedModel exported;
  exported.differing = compare_models(wanted, model.get(), &exported.compared);
  return exported;
}

Result<ExportedModel> save_and_compare(mjSpec* spec, const mjModel* wanted, const fs::path& path) {
  GLOAM_TRY_STATUS(save_exact(spec, path));
  GLOAM_TRY(ExportedModel plain, load_and_compare(wanted, path));
  if (plain.differing.empty()) return plain;
  const NegativeZeros zeros(spec);
  if (!zeros.any()) return plain;
  GLOAM_TRY_STATUS(save_exact(spec, path));
  GLOAM_TRY_STATUS(NegativeZeros::write_signs(path));
  return load_and_compare(wanted, path);
}

// True if visual geoms have left the physics as it was.
bool is_same_physics(const mjModel& a, const mjModel& b) {
  const auto same = [](const mjtNum* x, const mjtNum* y, mjtSize count) {
    return std::equal(x, x + count, y);
  };
  return a.nq == b.nq && a.nv == b.nv && a.nu == b.nu && a.nbody == b.nbody &&
         a.nsensor == b.nsensor && same(a.body_mass, b.body_mass, a.nbody) &&
         same(a.body_inertia, b.body_inertia, 3 * a.nbody) &&
         same(a.body_ipos, b.body_ipos, 3 * a.nbody) && same(a.body_pos, b.body_pos, 3 * a.nbody) &&
         same(a.qpos0, b.qpos0, a.nq);
}

// Adds visuals to the exact export in `path`. If stock MuJoCo does not accept them, or would move
// differently, the file remains unchanged.
Status add_visuals(const CompiledWorld& world, const fs::path& path, mjSpec* spec,
                   AssetWriter* assets, std::vector<Error>* left_out) {
  const std::vector<Error> words = list_left_out(world.scene);
  left_out->insert(left_out->end(), words.begin(), words.end());
  spec->compiler.discardvisual = 0;
  GLOAM_TRY(const int count, add_visual_geoms(world, path.parent_path(), spec, left_out));
  if (count == 0) return {};
  GLOAM_TRY(const std::string exact, read_text_file(path, uint64_t{1} << 30));
  std::string why = "the robot would move differently";
  const Status ready = assets->compile_again(spec);
  const Result<ExportedModel> saved =
      ready.ok() ? save_and_compare(spec, world.model.get(), path) : ready.error();
  if (saved.ok()) {
    const Result<ModelPtr> model = load_stock_model(path);
    if (model.ok() && is_same_physics(*world.model, **model)) return {};
  } else {
    why = saved.error().message;
  }
  left_out->push_back({ErrorKind::kUnsupported,
                       fmt::format("{} visuals are not exported: {}", count, why),
                       {path.string(), 0, 0}});
  return write_file_atomic(path, {reinterpret_cast<const uint8_t*>(exact.data()), exact.size()});
}

}  // namespace

Result<ModelPtr> load_stock_model(const fs::path& file) {
  const std::string name = file.string();
  char message[2048] = "";
  mjModel* loaded = nullptr;
  const MujocoWarningCapture warnings;
  const Status status =
      guarded([&] { loaded = mj_loadXML(name.c_str(), nullptr, message, sizeof(message)); });
  ModelPtr model(loaded);
  mj_freeLastXML();
  if (!status.ok()) return status.error();
  if (model == nullptr) return Error{ErrorKind::kUnsupported, message, {name, 0, 0}};
  return model;
}

Result<ExportedModel> write_mjcf(const CompiledWorld& world, const fs::path& folder,
                                 std::vector<Error>* left_out) {
  // The spec is built again: a World keeps only the model, and a cached World never had a spec.
  ModelFiles files;
  GLOAM_TRY_STATUS(add_scene_files(world.scene, &files));
  GLOAM_TRY(const std::optional<Place> place, make_place(world.scene));
  GLOAM_TRY(const MeshObjects objects, load_mesh_objects(world.scene));
  GLOAM_TRY(Level level, build_level(world.scene, place, objects, &files));
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
  // Values as written keep every number exact. If MJCF cannot represent a level as written (robots
  // with different compiler settings), compiled values can.
  ExportedModel last;
  std::string why;
  for (const bool compiled_values : {false, true}) {
    spec->compiler.savecompiled = compiled_values;
    const Status ready = compiled_values ? assets.compile_again(spec) : Status();
    Result<ExportedModel> exported =
        ready.ok() ? save_and_compare(spec, world.model.get(), path) : ready.error();
    if (exported.ok() && exported->differing.empty()) {
      if (left_out != nullptr) GLOAM_TRY_STATUS(add_visuals(world, path, spec, &assets, left_out));
      return exported;
    }
    const std::string reason =
        exported.ok() ? fmt::format("differs in {}", fmt::join(exported->differing, ", "))
                      : exported.error().message;
    log_debug("export {}: {}", compiled_values ? "of compiled values" : "as written", reason);
    if (!why.empty()) why += "; ";
    why += fmt::format("{}: {}", compiled_values ? "compiled values" : "as written", reason);
    last = exported.ok() ? std::move(exported).value() : ExportedModel();
  }
  last.why = fmt::format("{:.500}", why);
  return last;
}

Status World::export_mjcf(const fs::path& folder, std::vector<Error>* left_out) const {
  GLOAM_TRY(const ExportedModel exported, write_mjcf(*compiled_, folder, left_out));
  if (exported.why.empty()) return {};
  return Error{ErrorKind::kUnsupported,
               "MJCF cannot represent this scene exactly: " + exported.why,
               {(folder / "scene.xml").string(), 0, 0},
               "the file was written and is close, but not identical in every array"};
}

}  // namespace gloam
