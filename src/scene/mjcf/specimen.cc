#include "scene/mjcf/specimen.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <map>

#include "base/check.h"
#include "scene/files/mujoco_guard.h"
#include "scene/files/mujoco_plugins.h"
#include "scene/mjcf/spec_only.h"
#include "scene/mjcf/specimen_parts.h"

namespace gloam::mjcf {
namespace {

// Files that <include> and <model> name in their specimens.
class SpecimenFiles {
 public:
  SpecimenFiles() {
    load_mujoco_plugins();
    mj_defaultVFS(&vfs_);
    constexpr std::string_view kModel = "<mujoco><option/></mujoco>";
    mj_addBufferVFS(&vfs_, "m.xml", kModel.data(), static_cast<int>(kModel.size()));
  }
  ~SpecimenFiles() { mj_deleteVFS(&vfs_); }
  SpecimenFiles(const SpecimenFiles&) = delete;
  SpecimenFiles& operator=(const SpecimenFiles&) = delete;
  const mjVFS* vfs() const { return &vfs_; }

 private:
  mjVFS vfs_;
};

void set_all(Element element, const Attributes& values) {
  for (const auto& [name, value] : values) {
    const Status status = element.set(name, value);
    GLOAM_CHECK(status.ok(), "an attribute of a specimen does not fit its element");
  }
}

Element add(Element above, std::string_view tag) {
  Result<Element> added = above.add(tag);
  GLOAM_CHECK(added.ok(), "an element of a specimen is not allowed at its place");
  return *added;
}

void name(Element element) {
  if (MjcfSchema::get().find(element.path())->find("name") != nullptr)
    set_all(element, {{"name", kSpecimenName}});
}

// Elements of bodies that the world has not, and those that want an empty body of their own.
bool wants_body(const MjcfElement& element) {
  return element.path.starts_with("mujoco/body/") && element.path != "mujoco/body/frame" &&
         element.path != "mujoco/body/replicate" && element.path != "mujoco/body/attach" &&
         !element.path.starts_with("mujoco/body/flexcomp");
}

}  // namespace

Specimen make_specimen(const MjcfElement& element, std::string_view attribute) {
  const std::optional<Attributes> instead = instead_for(element, attribute);
  Document document = Document::from_xml(kSpecimenWorld).value();
  std::vector<const MjcfElement*> line;  // from the top
  for (const MjcfElement* e = &element; e->parent != nullptr; e = e->parent)
    line.insert(line.begin(), e);
  Element at = document.root(), named = at;
  for (const MjcfElement* below : line) {
    if (below->path == "mujoco/body") {
      at = document.root().children("worldbody").front();
      if (&element == below || wants_body(element)) at = named = add(at, "body");
      if (&element != below && wants_body(element)) {
        name(at);
        if (element.name != "inertial")
          set_all(add(at, "inertial"), needed_by("mujoco/body/inertial"));
        continue;
      }
    } else {
      at = add(at, below->name);
    }
    if (at.path() == "mujoco/deformable/flex" && below != &element) {
      set_all(at, needed_by(below->path));
      name(named = at);
      continue;
    }
    if (at.path() == "mujoco/body" && below != &element) continue;
    set_all(at, below == &element && instead ? *instead : needed_by(below->path));
  }
  if (MjcfSchema::get().find(at.path())->find("name") != nullptr) {
    name(at);
    named = at;
    if (std::optional<Element> above = at.parent();
        above && above->tag() == "body" && at.tag() != "body")
      (void)above->clear("name").ok();
  }
  if (element.path == "mujoco/tendon/spatial") {
    for (const char* site : {"s", "s2"}) set_all(add(at, "site"), {{"site", site}});
  }
  if (element.path == "mujoco/tendon/fixed")
    set_all(add(at, "joint"), {{"joint", "j"}, {"coef", "1"}});
  return {document, at, named};
}

namespace {

void append_numbers(MjcfType type, int count, std::vector<std::string>* values) {
  for (const double first : {0.75, 2.0, 1.0, 0.0, 3.0, 8.0}) {
    if (first == (type == MjcfType::kInt ? 0.75 : 8.0)) continue;
    std::string equal, rising, swinging;
    for (int i = 0; i < count; ++i) {
      const char* const space = i > 0 ? " " : "";
      equal += fmt::format("{}{}", space, first);
      rising += fmt::format("{}{}", space, first + i);
      swinging += fmt::format("{}{}", space, i % 2 == 0 ? first : 0);
    }
    for (const std::string& value : {rising, equal, swinging}) values->push_back(value);
  }
}

}  // namespace

std::vector<std::string> values_to_try(const MjcfAttribute& attribute) {
  std::vector<std::string> values;
  if (attribute.type == MjcfType::kKeyword) {
    for (const std::string_view word : split_words(attribute.keywords)) values.emplace_back(word);
    return values;
  }
  // Names of existing elements, and texts with a restricted form: layers' roles, sizes, heights.
  if (attribute.type == MjcfType::kString)
    return {"b2",   "j",      "s2",  "cl",     "me", "mo",      "fr", "main",
            "geom", "sphere", "rgb", "normal", "1M", "0 1 2 3", "xyz"};
  if (attribute.most == MjcfAttribute::kAnyLength) {
    for (const int length : {4, 12}) append_numbers(attribute.type, length, &values);
  } else {
    append_numbers(attribute.type, attribute.most, &values);
  }
  return values;
}

void SpecDeleter::operator()(mjSpec_* spec) const { mj_deleteSpec(spec); }

Result<OwnedSpec> parse_document(const Document& document) {
  const std::string xml = document.to_xml();
  char message[1000] = "";
  mjSpec* spec = nullptr;
  static thread_local const SpecimenFiles files;
  const MujocoWarningCapture warnings;
  const Status status = guarded(
      [&] { spec = mj_parseXMLString(xml.c_str(), files.vfs(), message, sizeof(message)); });
  OwnedSpec owned(spec);
  if (!status.ok()) return status.error();
  if (owned != nullptr) {
    GLOAM_TRY_STATUS(set_spec_only(document, owned.get()));
    return owned;
  }
  const std::string_view said = message;  // below its first line: the place in the specimen
  return Error{ErrorKind::kInput, plain_message(said.substr(0, said.find('\n')))};
}

}  // namespace gloam::mjcf
