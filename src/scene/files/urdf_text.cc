#include "scene/files/urdf_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <fstream>
#include <map>
#include <pugixml.hpp>
#include <sstream>

#include "base/files.h"
#include "base/path_readings.h"
#include "geometry/mesh/model_file.h"
#include "scene/files/model_path.h"
#include "scene/files/urdf_ignored.h"
#include "scene/files/xml_text.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

// MuJoCo's own format, which only its compiler reads.
bool is_msh(const fs::path& path) { return lower_extension(path) == ".msh"; }

// A text STL begins with "solid", and its length differs from the length that byte 80 of a binary
// STL gives.
bool is_stl_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::array<char, 84> head{};
  in.read(head.data(), head.size());
  if (in.gcount() < static_cast<std::streamsize>(head.size())) return true;
  if (!std::string_view(head.data(), 80).starts_with("solid")) return false;
  uint32_t triangles;
  std::memcpy(&triangles, head.data() + 80, sizeof(triangles));
  std::error_code code;
  return fs::file_size(path, code) != 84 + uint64_t{50} * triangles;
}

// OBJ, STL in its binary form, MSH: all that MuJoCo takes as a mesh.
bool mujoco_reads(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".stl") return !is_stl_text(path);
  return !is_model_file(path) || extension == ".obj";
}

constexpr int kDeepestLinks = 512;  // MuJoCo takes a quarter of a second for such a chain

class Preparer {
 public:
  Preparer(const std::string& text, const fs::path& file, const FileAccess& access,
           const std::function<bool(const fs::path&)>& exists)
      : text_(text), lines_(text), file_(file), access_(access), exists_(exists) {}

  Result<UrdfText> run() {
    pugi::xml_document document;
    GLOAM_TRY_STATUS(parse_xml(text_, file_.string(), pugi::parse_full, &document));
    const pugi::xml_node robot = document.child("robot");
    GLOAM_TRY_STATUS(check_tree(robot));
    read_compiler(robot);
    UrdfText out;
    list_pictures(robot, &out.unsupported);
    out.notes =
        list_ignored_elements(robot, [&](const pugi::xml_node& node) { return loc_of(node); });
    GLOAM_TRY(const bool is_stock, stock_finds_all(robot));
    GLOAM_TRY_STATUS(resolve_meshes(robot, "collision", nullptr));
    const bool has_visuals = robot.select_node("link/visual") && !stock_keeps_visuals_;
    if (!is_stock) {
      // Visuals that stock loading discards are not looked for.
      pugi::xml_document physics;
      physics.reset(document);
      if (stock_keeps_visuals_)
        GLOAM_TRY_STATUS(resolve_meshes(physics.child("robot"), "visual", nullptr));
      set_compiler(physics.child("robot"), {{"strippath", "false"}, {"meshdir", ""}});
      out.physics = to_text(physics);
    }
    if (has_visuals) {
      GLOAM_TRY_STATUS(resolve_meshes(robot, "visual", &out.unsupported));
      make_static(robot);
      set_compiler(robot, {{"strippath", "false"},
                           {"meshdir", ""},
                           {"discardvisual", "false"},
                           {"fusestatic", "false"}});
      if (robot.select_node("link/visual")) out.visual = to_text(document);
    }
    out.visual_meshes = std::move(visual_meshes_);
    out.copies = std::move(copies_);
    return out;
  }

 private:
  // Checks for faults that MuJoCo rejects without a name or a line.
  Status check_tree(const pugi::xml_node& robot) const {
    std::map<std::string, pugi::xml_node> links, joint_above;  // nodes by the link's name
    for (const pugi::xml_node& link : robot.children("link")) {
      const auto [first, is_new] = links.emplace(link.attribute("name").value(), link);
      if (is_new) continue;
      return Error{ErrorKind::kInput,
                   fmt::format("the link '{:.80}' is defined twice, first on line {}", first->first,
                               loc_of(first->second).line),
                   loc_of(link)};
    }
    for (const pugi::xml_node& joint : robot.children("joint")) {
      const std::string child = joint.child("child").attribute("link").value();
      const auto [first, is_new] = joint_above.emplace(child, joint);
      if (is_new) continue;
      return Error{
          ErrorKind::kInput,
          fmt::format("the link '{:.80}' is the child of two joints, '{:.80}' and '{:.80}'", child,
                      first->second.attribute("name").value(), joint.attribute("name").value()),
          loc_of(joint)};
    }
    const bool has_root = links.empty() || std::ranges::any_of(links, [&](const auto& link) {
                            return !joint_above.contains(link.first);
                          });
    if (has_root) return check_depth(robot, joint_above);
    return Error{ErrorKind::kInput, "every link is the child of a joint: the joints form a loop",
                 loc_of(robot.child("joint")),
                 "one link must be the root; close loops with <equality> in MJCF"};
  }

  // Lengths of chains of links. MuJoCo's time grows with the square of the longest.
  Status check_depth(const pugi::xml_node& robot,
                     const std::map<std::string, pugi::xml_node>& joint_above) const {
    std::map<std::string, int> depths;
    for (const pugi::xml_node& link : robot.children("link")) {
      std::vector<std::string> unknown;  // from the link up
      std::string name = link.attribute("name").value();
      while (!depths.contains(name) && unknown.size() <= kDeepestLinks) {
        unknown.push_back(name);
        const auto joint = joint_above.find(name);
        if (joint == joint_above.end()) break;
        name = joint->second.child("parent").attribute("link").value();
      }
      int depth = depths.contains(name) ? depths[name] : 0;
      for (; !unknown.empty(); unknown.pop_back()) depths[unknown.back()] = ++depth;
      if (depth > kDeepestLinks)
        return Error{ErrorKind::kInput,
                     fmt::format("the chain of links is more than {} deep", kDeepestLinks),
                     loc_of(link), "model a rope or a cable as a <flexcomp> in MJCF"};
    }
    return {};
  }

  // MuJoCo reads the colours of materials, not their pictures.
  void list_pictures(const pugi::xml_node& robot, std::vector<Error>* unsupported) const {
    for (const pugi::xpath_node& found : robot.select_nodes(".//material/texture")) {
      const pugi::xml_node texture = found.node();
      unsupported->push_back({ErrorKind::kUnsupported,
                              fmt::format("the image '{:.200}' of material '{:.80}' is not drawn",
                                          texture.attribute("filename").value(),
                                          texture.parent().attribute("name").value()),
                              loc_of(texture), "use an MJCF of the robot, or add a [[visual]]"});
    }
  }

  void read_compiler(const pugi::xml_node& robot) {
    for (const pugi::xml_node& mujoco : robot.children("mujoco")) {
      for (const pugi::xml_node& compiler : mujoco.children("compiler")) {
        for (const char* name : {"assetdir", "meshdir"}) {
          if (compiler.attribute(name)) meshdir_ = compiler.attribute(name).value();
        }
        if (compiler.attribute("strippath"))
          strippath_ = std::string_view(compiler.attribute("strippath").value()) != "false";
        if (std::string_view(compiler.attribute("discardvisual").value()) == "false")
          stock_keeps_visuals_ = true;
      }
    }
  }

  // As MuJoCo reads it, to which '\\' divides folders, too.
  fs::path stock_path(const std::string& name) const {
    const fs::path path = with_slashes(name);
    const fs::path written = strippath_ ? path.filename() : path;
    return absolute_path(fs::path(meshdir_) / written, file_.parent_path());
  }

  template <class F>
  static void each_mesh(const pugi::xml_node& robot, const char* kind, F&& f) {
    for (const pugi::xml_node& link : robot.children("link")) {
      std::vector<pugi::xml_node> parts;
      for (const pugi::xml_node& part : link.children(kind)) parts.push_back(part);
      for (const pugi::xml_node& part : parts) {
        pugi::xml_node mesh = part.child("geometry").child("mesh");
        if (mesh) f(link, part, mesh);
      }
    }
  }

  // Two different meshes of one file name would be one to stock MuJoCo once it strips their paths.
  Result<bool> stock_finds_all(const pugi::xml_node& robot) {
    bool all = true;
    for (const char* kind : {"collision", "visual"}) {
      if (kind[0] == 'v' && !stock_keeps_visuals_) continue;
      each_mesh(robot, kind,
                [&](const pugi::xml_node&, const pugi::xml_node&, const pugi::xml_node& mesh) {
                  const fs::path path = stock_path(mesh.attribute("filename").value());
                  all = all && exists_(path) && mujoco_reads(path);
                });
    }
    return all;
  }

  SourceLoc loc_of(const pugi::xml_node& node) const {
    return {file_.string(), lines_.at(node.offset_debug()), 0};
  }

  // The first reading of the name under which there is a file; else where the name itself leads.
  Result<fs::path> find_mesh(const pugi::xml_node& mesh) const {
    const std::vector<std::string> readings = path_readings(mesh.attribute("filename").value());
    for (const std::string& reading : readings)
      if (Result<fs::path> path = find_mesh(mesh, reading); path.ok() && exists_(*path))
        return path;
    return find_mesh(mesh, readings[0]);
  }

  Result<fs::path> find_mesh(const pugi::xml_node& mesh, const std::string& name) const {
    const size_t scheme_end = name.find("://");
    if (scheme_end == std::string::npos) {
      const std::string refusal = why_not_a_path(name);
      if (!refusal.empty()) {
        return Error{ErrorKind::kInput, fmt::format("the mesh '{:.80}' {}", name, refusal),
                     loc_of(mesh)};
      }
      const fs::path beside = absolute_path(name, file_.parent_path());
      return exists_(beside) ? beside : stock_path(name);
    }
    const std::string scheme = name.substr(0, scheme_end), rest = name.substr(scheme_end + 3);
    if (scheme == "file") return absolute_path(rest, file_.parent_path());
    if (scheme != "package" && scheme != "model") {
      return Error{ErrorKind::kInput,
                   fmt::format("the mesh '{:.80}' is not a file: '{:.20}://' is not supported",
                               name, scheme),
                   loc_of(mesh), "use package:// or the path of a file"};
    }
    const size_t slash = std::min(rest.find('/'), rest.size());
    const std::string package = rest.substr(0, slash);
    const fs::path folder = find_package(package, file_, access_);
    const fs::path inside =
        folder.empty() ? fs::path()
                       : absolute_path(rest.substr(std::min(slash + 1, rest.size())), folder);
    if (exists_(stock_path(name)) && (inside.empty() || !exists_(inside))) return stock_path(name);
    if (!inside.empty()) return inside;
    return Error{ErrorKind::kInput,
                 fmt::format("the folder of package '{:.80}' is not known", package), loc_of(mesh),
                 fmt::format("specify it with --package {:.80}=FOLDER", package)};
  }

  // Writes the path of every mesh as it lies on disk. With `unsupported`, parts whose mesh cannot
  // be drawn are taken out and listed there instead of being an error.
  Status resolve_meshes(const pugi::xml_node& robot, const char* kind,
                        std::vector<Error>* unsupported) {
    Status status;
    each_mesh(
        robot, kind, [&](pugi::xml_node link, const pugi::xml_node& part, pugi::xml_node mesh) {
          if (!status.ok()) return;
          Result<fs::path> path = find_mesh(mesh);
          if (unsupported == nullptr) {
            if (!path.ok()) {
              status = path.error();
            } else {
              mesh.attribute("filename").set_value(readable_copy(*path, mesh).c_str());
            }
            return;
          }
          if (path.ok() && exists_(*path) && is_msh(*path)) {
            mesh.attribute("filename").set_value(path->c_str());
            return;
          }
          if (path.ok() && exists_(*path) && is_model_file(*path)) {
            put_stand_in(link, part, mesh, *path);
            return;
          }
          Error error = path.ok() ? Error{ErrorKind::kUnsupported,
                                          fmt::format("the visual mesh '{:.200}' is not drawn: {}",
                                                      mesh.attribute("filename").value(),
                                                      exists_(*path) ? "its format is not supported"
                                                                     : "the file does not exist"),
                                          loc_of(mesh), "convert it to GLB, COLLADA, OBJ or STL"}
                                  : path.error();
          unsupported->push_back(std::move(error));
          link.remove_child(part);
        });
    return status;
  }

  // The path under which MuJoCo finds a mesh of physics.
  fs::path readable_copy(const fs::path& path, const pugi::xml_node& mesh) {
    if (!exists_(path) || mujoco_reads(path)) return path;
    fs::path copy = path;
    copy += ".obj";
    const auto same = [&](const UrdfMeshCopy& known) { return known.copy == copy; };
    if (std::ranges::none_of(copies_, same)) copies_.push_back({path, copy, loc_of(mesh)});
    return copy;
  }

  void put_stand_in(const pugi::xml_node& link, pugi::xml_node part, pugi::xml_node mesh,
                    const fs::path& path) {
    UrdfVisualMesh out;
    out.stand_in = fmt::format("visual mesh {}", visual_meshes_.size());
    out.link = link.attribute("name").value();
    out.name = part.attribute("name").value();
    out.file = path;
    out.loc = loc_of(mesh);
    std::istringstream scale(mesh.attribute("scale").as_string("1 1 1"));
    scale.imbue(std::locale::classic());
    Vec3 s;
    if (scale >> s.x >> s.y >> s.z) out.scale = s;
    part.remove_attribute("name");
    part.prepend_attribute("name").set_value(out.stand_in.c_str());
    pugi::xml_node geometry = mesh.parent();
    geometry.remove_child(mesh);
    geometry.append_child("sphere").append_attribute("radius").set_value("0.001");
    visual_meshes_.push_back(std::move(out));
  }

  // Visuals keep their place in the tree and lose everything that physics would ask of them.
  static void make_static(const pugi::xml_node& robot) {
    for (pugi::xml_node link : robot.children("link")) {
      while (link.remove_child("collision")) {
      }
      while (link.remove_child("inertial")) {
      }
    }
    for (pugi::xml_node joint : robot.children("joint")) {
      joint.attribute("type").set_value("fixed");
      for (const char* part : {"limit", "dynamics", "mimic", "calibration", "safety_controller"})
        joint.remove_child(part);
    }
  }

  static void set_compiler(pugi::xml_node robot,
                           std::initializer_list<std::pair<const char*, const char*>> attributes) {
    pugi::xml_node mujoco = robot.child("mujoco");
    if (!mujoco) mujoco = robot.prepend_child("mujoco");
    pugi::xml_node compiler = mujoco.child("compiler");
    if (!compiler) compiler = mujoco.prepend_child("compiler");
    compiler.remove_attribute("assetdir");
    for (const auto& [name, value] : attributes) {
      compiler.remove_attribute(name);
      if (*value != 0) compiler.append_attribute(name).set_value(value);
    }
  }

  static std::string to_text(const pugi::xml_document& document) {
    std::ostringstream out;
    document.save(out, " ");
    return out.str();
  }

  const std::string& text_;
  const XmlLines lines_;
  const fs::path& file_;
  const FileAccess& access_;
  const std::function<bool(const fs::path&)>& exists_;
  std::vector<UrdfVisualMesh> visual_meshes_;
  std::vector<UrdfMeshCopy> copies_;
  std::string meshdir_;
  bool strippath_ = true;  // MuJoCo's default for URDF
  bool stock_keeps_visuals_ = false;
};

}  // namespace

Result<UrdfText> prepare_urdf(const std::string& text, const fs::path& file,
                              const FileAccess& access,
                              const std::function<bool(const fs::path&)>& exists) {
  return Preparer(text, file, access, exists).run();
}

}  // namespace gloam
