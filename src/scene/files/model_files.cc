#include "scene/files/model_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <regex>

#include "base/check.h"
#include "base/files.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/path_readings.h"
#include "base/plain_text.h"
#include "base/text.h"
#include "scene/files/foreign_model.h"
#include "scene/files/mujoco_guard.h"
#include "scene/files/mujoco_hints.h"
#include "scene/mjcf/spec_only.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kLargestAsset = uint64_t{1} << 30;
constexpr uint64_t kLargestTotal = uint64_t{8} << 30;
constexpr size_t kMostXmlFiles = 2000;
constexpr size_t kDeepestInclude = 64;

constexpr std::string_view kLfsPointer = "is a Git LFS pointer, not the file itself";

bool is_jpeg(std::string_view bytes) { return bytes.starts_with("\xFF\xD8\xFF"); }

bool leads_to_xml(const FileReference& reference) {
  return reference.element == "include" || reference.element == "model";
}

// Score for how well an attribute's value explains the opening of `path`: shared trailing
// components.
size_t shared_tail(const fs::path& path, const fs::path& value) {
  std::vector<fs::path> a(path.begin(), path.end()), b(value.begin(), value.end());
  size_t shared = 0;
  while (shared < a.size() && shared < b.size() &&
         a[a.size() - 1 - shared] == b[b.size() - 1 - shared])
    ++shared;
  return shared;
}

// The reading of the path under which there is a file, else the path itself.
fs::path find_reading(const fs::path& path) {
  std::error_code code;
  for (const std::string& reading : path_readings(path.string())) {
    const fs::path found = fs::path(reading).lexically_normal();
    if (fs::exists(found, code)) return found;
  }
  return path.lexically_normal();
}

void tell_if_slow(const Replicate& replicate, const fs::path& file) {
  constexpr double kSlowReplication = 2;  // [s]
  if (replicate.seconds < kSlowReplication) return;
  log_warning(
      "{}:{}: MuJoCo takes about {:.0f} s for a <replicate> of {} copies, and four times as long "
      "for twice as many: nest a <replicate> of {:.0f} in one of {:.0f} (docs/scenes.md)",
      file.string(), replicate.line, replicate.seconds, replicate.copies,
      std::ceil(std::sqrt(replicate.copies)), std::ceil(std::sqrt(replicate.copies)));
}

}  // namespace

ModelFiles::ModelFiles() {
  install_mujoco_handler();
  mj_defaultVFS(&vfs_);
  mjp_defaultProvider(&provider_);
  provider_.open = provider_open;
  provider_.read = provider_read;
  provider_.close = provider_close;
  provider_.data = this;
  // MuJoCo mounts folders but not "/": every folder at the top takes its place, so that no absolute
  // path escapes.
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator("/", code))
    mj_mountVFS(&vfs_, entry.path().c_str(), &provider_);
  // Too many "../" leave it with "/../etc", which the operating system takes for "/etc".
  mj_mountVFS(&vfs_, "/..", &provider_);
}

ModelFiles::~ModelFiles() { mj_deleteVFS(&vfs_); }

// MuJoCo is C to the caller of a provider: no exception may pass, on threads of its own least of
// all.
int ModelFiles::provider_open(mjResource* resource) {
  auto* files = static_cast<ModelFiles*>(resource->provider->data);
  try {
    return files->open_resource(resource);
  } catch (const std::exception&) {
    files->lacks_memory_ = true;
    return 0;
  }
}

int ModelFiles::open_resource(mjResource* resource) {
  std::string hash;
  Result<Content> content = open(find_reading(resource->name), &hash);
  if (!content.ok()) return 0;
  // MuJoCo keeps parsed meshes by name and timestamp; the content's hash never goes stale.
  std::snprintf(resource->timestamp, sizeof(resource->timestamp), "%s", hash.c_str());
  resource->data = new Content(std::move(content).value());
  return 1;
}

int ModelFiles::provider_read(mjResource* resource, const void** buffer) {
  const std::string& bytes = **static_cast<Content*>(resource->data);
  *buffer = bytes.data();
  return static_cast<int>(bytes.size());
}

void ModelFiles::provider_close(mjResource* resource) {
  delete static_cast<Content*>(resource->data);
  resource->data = nullptr;
}

Result<ModelFiles::Content> ModelFiles::open(const fs::path& path, std::string* hash_text,
                                             bool is_scanned) {
  const std::lock_guard lock(mutex_);
  const auto fail = [&](ErrorKind kind, std::string reason) -> Error {
    failures_.push_back({path, reason, kind});
    return {kind, std::move(reason), {path.string(), 0, 0}};
  };
  if (const auto overlay = overlays_.find(path); overlay != overlays_.end()) {
    *hash_text = hash_to_hex(hash_bytes(overlay->second->data(), overlay->second->size()));
    return overlay->second;
  }
  const std::string refusal = why_not_readable(path, roots_);
  if (!refusal.empty()) return fail(ErrorKind::kInput, refusal);
  if (is_container(path))
    return fail(ErrorKind::kUnsupported, "is an archive or binary model, which is not supported");
  const bool is_new = depended_.insert(path).second;
  std::error_code code;
  if (!fs::exists(path, code)) {
    if (is_new) dependencies_.push_back({path, false, 0});
    return fail(ErrorKind::kInput, "does not exist");
  }
  if (const auto known = contents_.find(path); known != contents_.end()) {
    *hash_text = hash_to_hex(hash_bytes(known->second->data(), known->second->size()));
    return known->second;
  }
  Result<std::string> bytes = read_text_file(path, kLargestAsset);
  if (!bytes.ok()) return fail(bytes.error().kind, bytes.error().message);
  if (is_lfs_pointer(*bytes)) return fail(ErrorKind::kInput, std::string(kLfsPointer));
  total_size_ += bytes->size();
  if (total_size_ > kLargestTotal)
    return fail(ErrorKind::kInput, "brings the total size of the model's files above 8 GiB");
  // XML that MuJoCo finds by a path that the scan did not follow is scanned now, before its parser
  // sees it.
  const std::string extension = lower_extension(path);
  if (extension == ".xml" || extension == ".urdf" || extension == ".toml" || extension == ".obj") {
    Result<std::optional<std::string>> plain = plain_text(*bytes, path.string());
    if (!plain.ok()) return fail(plain.error().kind, plain.error().message);
    if (*plain) *bytes = std::move(**plain);
  }
  if (!is_scanned && (extension == ".xml" || extension == ".urdf")) {
    if (const Result<XmlScan> scan = scan_model_xml(*bytes, path.string()); !scan.ok())
      return fail(scan.error().kind, scan.error().message);
  }
  if (extension == ".toml") {
    Result<ModelText> model = translate_model(*bytes, path.string());
    if (!model.ok()) {
      failures_.push_back({path, model.error().message, model.error().kind});
      return model.error();
    }
    *bytes = model->xml;
    toml_models_.emplace(path, std::move(model).value());
  }
  const uint64_t hash = hash_bytes(bytes->data(), bytes->size());
  *hash_text = hash_to_hex(hash);
  if (is_new) dependencies_.push_back({path, true, hash});
  auto content = std::make_shared<const std::string>(std::move(bytes).value());
  contents_.emplace(path, content);
  return content;
}

Status ModelFiles::scan(const fs::path& file, const fs::path& model, const SourceLoc& named_at,
                        std::vector<fs::path>& stack) {
  if (std::find(stack.begin(), stack.end(), file) != stack.end()) {
    return Error{ErrorKind::kInput, fmt::format("'{}' includes itself", file.filename().string()),
                 named_at, "break the cycle of <include> or <model> elements"};
  }
  if (stack.size() >= kDeepestInclude || scans_.size() >= kMostXmlFiles) {
    return Error{
        ErrorKind::kInput,
        fmt::format(
            "there are more than {} included files, or includes are nested more than {} deep",
            kMostXmlFiles, kDeepestInclude),
        named_at};
  }
  if (scans_.contains(file)) return {};
  std::string hash;
  Result<Content> content = open(file, &hash, true);
  if (!content.ok()) {
    if (content.error().loc.line > 0) return content.error();  // it has its own location
    const bool is_named = !named_at.file.empty();  // else it comes from the command line
    Error error = content.error();
    error.message =
        fmt::format("'{}' {}", is_named ? file.filename().string() : file.string(), error.message);
    error.loc = named_at;
    error.hint = content.error().message == kLfsPointer ? "fetch it: git lfs pull"
                 : why_not_readable(file, roots_).empty()
                     ? "check the path"
                     : "use --root FOLDER to let the model read from a larger folder";
    return error;
  }
  const std::string& text = **content;
  if (text.size() > kLargestModelText)
    return Error{ErrorKind::kInput, "the XML is larger than 64 MiB", {file.string(), 0, 0}};
  if (std::optional<Error> foreign = find_foreign_text(text, file.string()))
    return std::move(*foreign);
  Result<XmlScan> scanning = scan_model_xml(text, file.string());
  if (!scanning.ok()) {
    Error error = scanning.error();
    error.loc = written_at(error.loc);
    return error;
  }
  XmlScan scanned = std::move(scanning).value();
  uses_plugins_ = uses_plugins_ || scanned.has_plugins;
  slowest_replicate_ = std::max(slowest_replicate_, scanned.slowest.seconds);
  tell_if_slow(scanned.slowest, file);
  const XmlScan& kept = scans_.emplace(file, std::move(scanned)).first->second;
  stack.push_back(file);
  for (const FileReference& reference : kept.references) {
    const SourceLoc loc = written_at({file.string(), reference.line, 0});
    // Those are looked for by urdf_text.h, which knows packages.
    if (kept.root == "robot" && (reference.element == "mesh" || reference.element == "texture"))
      continue;
    if (reference.element == "compiler" && reference.value.empty()) continue;
    const std::string refusal = why_not_a_path(reference.value);
    if (!refusal.empty()) {
      return Error{
          ErrorKind::kInput,
          fmt::format("the path '{:.80}' of <{}> {}", reference.value, reference.element, refusal),
          loc};
    }
    const std::string extension = lower_extension(reference.value);
    if (reference.element == "mesh" &&
        (extension == ".glb" || extension == ".gltf" || extension == ".dae")) {
      return Error{ErrorKind::kUnsupported,
                   fmt::format("the mesh '{:.80}' is in a format that MuJoCo does not support",
                               reference.value),
                   loc, "convert it to OBJ, or add it as a [[visual]] on the body"};
    }
    if (!leads_to_xml(reference)) continue;
    // MuJoCo looks beside the main file; beside the including one is where people expect it.
    fs::path target = find_reading(absolute_path(reference.value, model.parent_path()));
    std::error_code code;
    if (!fs::exists(target, code)) {
      const fs::path beside = find_reading(absolute_path(reference.value, file.parent_path()));
      if (fs::exists(beside, code)) target = beside;
    }
    GLOAM_TRY_STATUS(scan(target, reference.element == "model" ? target : model, loc, stack));
  }
  stack.pop_back();
  return {};
}

Status ModelFiles::admit(const fs::path& file, const FileAccess& access) {
  GLOAM_TRY(ModelRoot root, find_model_root(file, access));
  roots_.push_back(std::move(root));
  for (const auto& [name, folder] : access.packages) {
    std::error_code code;
    const fs::path package = absolute_path(folder, "");
    const fs::path canonical = fs::weakly_canonical(package, code);
    roots_.push_back({package, canonical, canonical});
  }
  return {};
}

Status ModelFiles::add_model(const fs::path& file, const FileAccess& access, const SourceLoc& loc) {
  const fs::path path = absolute_path(file, "");
  if (scans_.contains(path)) return {};
  if (is_container(path)) {
    return Error{
        ErrorKind::kUnsupported,
        fmt::format("'{}' is an archive or binary model, which is not supported", file.string()),
        loc, "use the MJCF (.xml) or URDF file"};
  }
  GLOAM_TRY_STATUS(refuse_mesh(path, file.string(), loc));
  GLOAM_TRY_STATUS(admit(path, access));
  std::vector<fs::path> stack;
  GLOAM_TRY_STATUS(scan(path, path, loc, stack));
  const std::string& top = scans_.at(path).root;
  if (top == "mujoco" || top == "robot") return {};
  return foreign_element_error(top, path.string());
}

const std::string& ModelFiles::root_element(const fs::path& file) const {
  return scans_.at(absolute_path(file, "")).root;
}

const std::string& ModelFiles::text(const fs::path& file) const {
  const std::lock_guard lock(mutex_);
  return *contents_.at(absolute_path(file, ""));
}

void ModelFiles::set_overlay(const fs::path& file, std::string text) {
  const std::lock_guard lock(mutex_);
  overlays_[absolute_path(file, "")] = std::make_shared<const std::string>(std::move(text));
}

void ModelFiles::clear_overlay(const fs::path& file) {
  const std::lock_guard lock(mutex_);
  overlays_.erase(absolute_path(file, ""));
}

Result<ModelFiles::Content> ModelFiles::read(const fs::path& path) {
  std::string hash;
  return open(absolute_path(path, ""), &hash);
}

bool ModelFiles::is_unchanged(const Dependency& dependency) {
  std::error_code code;
  if (!dependency.exists) return !fs::exists(dependency.path, code);
  std::string hash;
  return open(dependency.path, &hash).ok() && hash == hash_to_hex(dependency.hash);
}

bool ModelFiles::readable(const fs::path& path) {
  const fs::path absolute = absolute_path(path, "");
  std::error_code code;
  return why_not_readable(absolute, roots_).empty() && fs::is_regular_file(absolute, code);
}

SourceLoc ModelFiles::written_at(SourceLoc loc) const {
  const auto model = toml_models_.find(loc.file);
  if (model == toml_models_.end() || loc.line <= 0) return loc;
  const std::vector<int>& lines = model->second.lines;
  loc.line = lines[std::min(static_cast<size_t>(loc.line), lines.size() - 1)];
  return loc;
}

Status ModelFiles::set_spec_only(const fs::path& file, mjSpec* spec) const {
  const fs::path path = absolute_path(file, "");
  if (const auto model = toml_models_.find(path); model != toml_models_.end())
    GLOAM_TRY_STATUS(gloam::set_spec_only(model->second.document, spec));
  const auto scan = scans_.find(path);
  if (scan == scans_.end()) return {};
  for (const FileReference& reference : scan->second.references) {
    if (reference.element == "include")
      GLOAM_TRY_STATUS(set_spec_only(absolute_path(reference.value, path.parent_path()), spec));
  }
  return {};
}

SourceLoc ModelFiles::find_setting(const fs::path& model, const std::string& element,
                                   const std::string& attribute) const {
  const fs::path path = absolute_path(model, "");
  const auto scan = scans_.find(path);
  const auto content = contents_.find(path);
  if (scan == scans_.end() || content == contents_.end()) return {};
  const int line = attribute.empty() ? line_of_element(*content->second, element)
                                     : line_of_element_with(*content->second, element, {attribute});
  if (line > 0) return written_at({path.string(), line, 0});
  for (const FileReference& reference : scan->second.references) {
    if (reference.element != "include") continue;
    const SourceLoc found =
        find_setting(absolute_path(reference.value, path.parent_path()), element, attribute);
    if (found.line > 0) return found;
  }
  return {};
}

SourceLoc ModelFiles::find_reference(const fs::path& path) const {
  SourceLoc best;
  size_t best_tail = 0;
  for (const auto& [file, scan] : scans_) {
    for (const FileReference& reference : scan.references) {
      const size_t tail = shared_tail(path, fs::path(reference.value).lexically_normal());
      if (tail > best_tail) {
        best_tail = tail;
        best = {file.string(), reference.line, 0};
      }
    }
  }
  return written_at(best);
}

// MuJoCo does not report which included file it refers to, and included elements have lost their
// line.
void ModelFiles::find_place(const std::string& element, Error* error, const fs::path& model) const {
  std::vector<const std::pair<const fs::path, XmlScan>*> files;
  if (const auto main = scans_.find(model); main != scans_.end()) files.push_back(&*main);
  for (const auto& file : scans_) {
    if (file.first != model) files.push_back(&file);
  }
  std::vector<std::string> words;
  static const std::regex kQuoted("'([^']+)'");
  for (std::sregex_iterator it(error->message.begin(), error->message.end(), kQuoted), end;
       it != end; ++it)
    words.push_back((*it)[1]);
  for (const auto* file : files) {
    const auto content = contents_.find(file->first);
    if (content == contents_.end()) continue;
    int line = error->loc.line;
    if (line > 0 ? !has_element_at(*content->second, element, line)
                 : (line = line_of_element_with(*content->second, element, words)) == 0)
      continue;
    error->loc = written_at({file->first.string(), line, 0});
    return;
  }
}

// MuJoCo reports "unsupported content type" or an unreadable PNG, and names only the texture.
void ModelFiles::explain_picture(Error* error) const {
  const auto scan = scans_.find(error->loc.file);
  if (scan == scans_.end()) return;
  const bool is_unknown = error->message.find("content type") != std::string::npos;
  for (const FileReference& reference : scan->second.references) {
    if (reference.line != error->loc.line || reference.element != "texture") continue;
    const fs::path name = fs::path(reference.value).filename();
    const bool has_jpeg = std::ranges::any_of(contents_, [&](const auto& file) {
      return file.first.filename() == name && is_jpeg(*file.second);
    });
    const std::string extension = lower_extension(name);
    if (!has_jpeg && !is_unknown && extension != ".jpg" && extension != ".jpeg") continue;
    error->message = fmt::format(
        "the image '{:.200}' of a <texture> is {}; MuJoCo supports only PNG and KTX",
        reference.value,
        has_jpeg || extension == ".jpg" || extension == ".jpeg" ? "a JPEG" : "in another format");
    error->hint = fmt::format("convert it with magick {0}{1} {0}.png, and use that file",
                              name.stem().string(), name.extension().string());
    return;
  }
}

Error ModelFiles::explain(const std::string& message, const fs::path& model) const {
  const std::lock_guard lock(mutex_);
  if (lacks_memory_ || is_want_of_memory(message))
    return {ErrorKind::kInput,
            "out of memory: MuJoCo cannot compile the model",
            {model.string(), 0, 0},
            "give the process more memory, or use smaller meshes and images"};
  for (const Failure& failure : failures_) {
    if (message.find(failure.path.filename().string()) == std::string::npos) continue;
    Error error{failure.kind, fmt::format("'{}' {}", failure.path.string(), failure.reason),
                find_reference(failure.path)};
    if (error.loc.file.empty()) error.loc.file = model.string();
    if (failure.reason == kLfsPointer) {
      error.hint = "fetch it: git lfs pull";
    } else if (failure.reason == "does not exist") {
      error.hint = "check the path, meshdir and texturedir";
    } else if (!why_not_readable(failure.path, roots_).empty()) {
      error.hint = "use --root FOLDER to let the model read from a larger folder";
    }
    return error;
  }
  std::string text = plain_message(message);
  static const std::regex kUnnamed("[;,]? *Element name '', id -?\\d+");
  static const std::regex kNamed("[;,]? *Element name ('[^']*'), id -?\\d+");
  text = std::regex_replace(text, kUnnamed, "");
  text = std::regex_replace(text, kNamed, ", in $1");
  static const std::regex kKeyframe("^Keyframe ([^' ]+) has");  // names in quotes are looked for
  text = std::regex_replace(text, kKeyframe, "Keyframe '$1' has");
  Error error{ErrorKind::kInput, text, {model.string(), 0, 0}};
  std::string element;
  std::smatch match;
  static const std::regex kLine(
      "[;,]? *(?:Element '([^']*)', )?(?:at )?[Ll]ine[ =](\\d+)(?:, column \\d+)?\\.?");
  if (std::regex_search(text, match, kLine) && match[2].length() < 9) {
    element = match[1];
    error.loc.line = std::stoi(match[2]);
    error.message = std::string(match.prefix()) +
                    (element.empty() ? "" : fmt::format(" in <{}>", element)) +
                    std::string(match.suffix());
  }
  find_place(element, &error, absolute_path(model, ""));
  explain_picture(&error);
  if (error.hint.empty()) error.hint = mujoco_hint(error.message, element);
  if (error.message.empty()) error.message = "MuJoCo rejected the model without giving a reason";
  return error;
}

void ModelFiles::forget_failures() {
  const std::lock_guard lock(mutex_);
  failures_.clear();
  lacks_memory_ = false;
}

std::vector<Dependency> ModelFiles::dependencies() const {
  const std::lock_guard lock(mutex_);
  return dependencies_;
}

}  // namespace gloam
