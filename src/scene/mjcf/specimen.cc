#include "scene/mjcf/specimen.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <map>

#include "base/check.h"
#include "scene/mjcf/spec_only.h"
#include "scene/mujoco_guard.h"
#include "scene/mujoco_plugins.h"

namespace gloam::mjcf {
namespace {

constexpr const char* kSpecimenWorld = R"(<mujoco>
<default><default class="cl"><mesh scale="2 2 2"/><texture random="0.5"/><material specular="0.25"/>
<joint armature="0.25"/><geom margin="0.25"/><site group="4"/><camera ipd="0.25"/><light cutoff="25"/>
<pair margin="0.25"/><equality solref="0.25 1"/><tendon margin="0.25"/><general group="4"/></default></default>
<asset><texture name="t" builtin="flat" width="4" height="4" type="2d"/>
<mesh name="me" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/><material name="ma"/>
<hfield name="hf" nrow="2" ncol="2" size="1 1 1 1"/><model name="mo" file="m.xml"/></asset>
<worldbody><camera name="c"/><light name="li"/><geom name="floor" type="plane" size="1 1 1"/>
<body name="b"><joint name="j" limited="true" range="0 1"/><geom name="g" size="1"/><site name="s"/></body>
<body name="b2"><joint name="jb" type="ball"/><geom name="g2" size="1"/><site name="s2"/></body>
<frame name="fr"><site/></frame></worldbody>
<deformable><flex name="fx" dim="2" body="b" vertex="0 0 0 1 0 0 0 1 0" element="0 1 2"/></deformable>
<tendon><fixed name="te"><joint joint="j" coef="1"/></fixed></tendon>
<actuator><motor name="ac" joint="j"/></actuator></mujoco>)";

using Attributes = std::map<std::string, std::string>;

// "size=1,1,1 name=g" as attributes.
Attributes pairs_of(std::string_view list) {
  Attributes pairs;
  for (const std::string_view pair : split_words(list)) {
    const size_t equals = pair.find('=');
    std::string value(pair.substr(equals + 1));
    std::replace(value.begin(), value.end(), ',', ' ');
    pairs[std::string(pair.substr(0, equals))] = value;
  }
  return pairs;
}

// Beside which an element is read.
Attributes needed_by(std::string_view path) {
  static const std::map<std::string_view, std::string_view> kNeeded = {
      {"default/material/layer", "role=rgb texture=t"},
      {"extension/plugin", "plugin=mujoco.pid"},
      {"extension/plugin/instance", "name=pi"},
      {"asset/model", "name=m file=m.xml"},
      {"include", "file=m.xml"},
      {"default/dcmotor", "motorconst=1,1 resistance=1"},
      {"asset/mesh", "name=x vertex=0,0,0,1,0,0,0,1,0,0,0,1"},
      {"asset/hfield", "name=h nrow=2 ncol=2 size=1,1,1,1"},
      {"asset/skin", "name=sk vertex=0,0,0,1,0,0,0,1,0 face=0,1,2"},
      {"deformable/skin", "name=sk vertex=0,0,0,1,0,0,0,1,0 face=0,1,2"},
      {"asset/skin/bone", "body=b bindpos=0,0,0 bindquat=1,0,0,0 vertid=0,1,2 vertweight=1,1,1"},
      {"deformable/skin/bone",
       "body=b bindpos=0,0,0 bindquat=1,0,0,0 vertid=0,1,2 vertweight=1,1,1"},
      {"asset/texture", "name=t2 builtin=flat width=4 height=4 type=2d"},
      {"asset/material", "name=m2"},
      {"asset/material/layer", "role=rgb texture=t"},
      {"body", "name=bb"},
      {"body/inertial", "mass=1 pos=0,0,0 diaginertia=1,1,1"},
      {"body/geom", "size=1,1,1"},
      {"body/attach", "prefix=p body=b2"},
      {"body/replicate", "count=2"},
      {"body/flexcomp", "name=f type=grid count=3,3,3 spacing=.1,.1,.1 dim=3 mass=1 radius=.01"},
      {"body/flexcomp/pin", "id=0"},
      {"deformable/flex", "name=fl dim=2 body=b vertex=0,0,0,1,0,0,0,1,0 element=0,1,2"},
      {"contact/pair", "geom1=g geom2=g2"},
      {"contact/exclude", "body1=b body2=b2"},
      {"tendon/spatial/site", "site=s"},
      {"tendon/spatial/geom", "geom=g"},
      {"tendon/spatial/pulley", "divisor=2"},
      {"tendon/fixed/joint", "joint=j coef=1"},
      {"equality/connect", "body1=b anchor=0,0,0"},
      {"equality/weld", "body1=b"},
      {"equality/joint", "joint1=j"},
      {"equality/tendon", "tendon1=te"},
      {"equality/flex", "flex=fx"},
      {"equality/flexstrain", "flex=fx"},
      {"actuator/adhesion", "body=b ctrlrange=0,1"},
      {"actuator/damper", "joint=j ctrlrange=0,1"},
      {"actuator/dcmotor", "joint=j motorconst=1,1 resistance=1"},
      {"actuator/orientation", "joint=jb"},
      {"custom/numeric", "name=n size=1"},
      {"custom/text", "name=x data=d"},
      {"custom/tuple", "name=tu"},
      {"custom/tuple/element", "objtype=body objname=b"},
      {"sensor/camprojection", "site=s camera=c"},
      {"sensor/insidesite", "site=s objtype=body objname=b"},
      {"sensor/rangefinder", "site=s"},
      {"sensor/user", "dim=1"},
      {"sensor/contact", "geom1=g"},
      {"sensor/tactile", "geom=g mesh=me"},
      {"sensor/distance", "geom1=g geom2=g2"},
      {"sensor/normal", "geom1=g geom2=g2"},
      {"sensor/fromto", "geom1=g geom2=g2"},
  };
  path.remove_prefix(std::min<size_t>(path.size(), std::string_view("mujoco/").size()));
  std::string_view list;
  const std::string_view last = path.substr(path.rfind('/') + 1);
  if (const auto found = kNeeded.find(path); found != kNeeded.end()) {
    list = found->second;
  } else if (last == "config") {
    list = "key=kp value=1";
  } else if (last == "plugin" && path != "actuator/plugin" && path != "sensor/plugin") {
    list = "plugin=mujoco.pid";
  } else if (path.starts_with("actuator/")) {
    list = "joint=j";
  } else if (path.starts_with("sensor/")) {
    const std::string_view name = path.substr(7);
    list = name.starts_with("joint")      ? "joint=j"
           : name.starts_with("ball")     ? "joint=jb"
           : name.starts_with("tendon")   ? "tendon=te"
           : name.starts_with("actuator") ? "actuator=ac"
           : name.starts_with("subtree")  ? "body=b"
           : name.starts_with("frame")    ? "objtype=body objname=b"
           : name.starts_with("e_") || name == "clock" || name == "plugin" ? ""
                                                                           : "site=s";
  }
  return pairs_of(list);
}

// What <include> and <model> name in their specimens.
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

// Attributes that may not stand beside what their element usually has: what stands there instead.
std::optional<std::string_view> instead_for(const MjcfElement& element,
                                            std::string_view attribute) {
  struct Instead {
    std::string_view section, attributes, values;
  };
  static constexpr Instead kInstead[] = {
      {"mujoco/asset/mesh", "builtin", "name=x builtin=sphere params=1"},
      {"mujoco/body/attach", "frame", "prefix=p frame=fr"},
      {"mujoco/body/attach", "model", "prefix=p model=mo"},
      {"mujoco/body/flexcomp", "mesh", "name=f type=mesh mesh=me dim=2 mass=1 radius=.01"},
      {"mujoco/body/flexcomp", "point texcoord",
       "name=f type=direct dim=1 mass=1 radius=.01 point=0,0,0,1,0,0 element=0,1"},
      {"mujoco/actuator/dcmotor", "cranksite slidersite cranklength",
       "motorconst=1,1 resistance=1 cranksite=s slidersite=s2 cranklength=1"},
      {"mujoco/actuator/dcmotor", "refsite", "motorconst=1,1 resistance=1 site=s"},
      {"mujoco/sensor/contact", "site", "site=s"},
      {"mujoco/sensor/user", "objtype objname", "dim=1 objtype=body objname=b"},
      {"mujoco/actuator", "cranksite slidersite cranklength",
       "cranksite=s slidersite=s2 cranklength=1"},
      {"mujoco/actuator", "refsite", "site=s"},
      {"mujoco/equality", "site1 site2", "site1=s site2=s2"},
      {"mujoco/sensor", "body1 body2", "body1=b body2=b2"},
      {"mujoco/sensor", "subtree1", "subtree1=b"},
      {"mujoco/sensor", "subtree2", "subtree1=b subtree2=b2"},
      {"mujoco/sensor/rangefinder", "camera", "camera=c"},
      {"mujoco/sensor/plugin", "objtype objname", "objtype=body objname=b"},
      {"mujoco/sensor", "refname reftype", "objtype=body objname=b reftype=body refname=b2"},
  };
  for (const Instead& row : kInstead) {
    const std::string_view above = element.parent == nullptr ? "" : element.parent->path;
    if (above != row.section && element.path != row.section) continue;
    for (const std::string_view name : split_words(row.attributes)) {
      if (name == attribute) return row.values;
    }
  }
  return {};
}

void set_all(Element element, const Attributes& values) {
  for (const auto& [name, value] : values) {
    const Status status = element.set(name, value);
    GLOAM_CHECK(status.ok(), "a specimen's attribute is not what its element takes");
  }
}

Element add(Element above, std::string_view tag) {
  Result<Element> added = above.add(tag);
  GLOAM_CHECK(added.ok(), "a specimen's element may not stand where it is wanted");
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
  const std::optional<std::string_view> instead = instead_for(element, attribute);
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
    set_all(at, below == &element && instead ? pairs_of(*instead) : needed_by(below->path));
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
  // Names of what is there, and what only some texts are: layers' roles, sizes, heights.
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
  std::string why(message);
  why = why.substr(0, why.find('\n'));
  if (why.starts_with("XML Error: ")) why.erase(0, 11);
  return Error{ErrorKind::kInput, why};
}

}  // namespace gloam::mjcf
