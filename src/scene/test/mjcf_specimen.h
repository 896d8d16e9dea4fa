#pragma once
// For each element of MJCF a document in which MuJoCo reads it, with one of them.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <map>
#include <memory>
#include <string>

#include "gloam/mjcf.h"
#include "scene/mjcf/schema.h"

namespace gloam::mjcf {

inline constexpr const char* kSpecimenWorld = R"(<mujoco>
<asset><texture name="t" builtin="flat" width="4" height="4" type="2d"/>
<mesh name="me" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/><material name="ma"/>
<hfield name="hf" nrow="2" ncol="2" size="1 1 1 1"/></asset>
<worldbody><camera name="c"/><light name="li"/><geom name="floor" type="plane" size="1 1 1"/>
<body name="b"><joint name="j" limited="true" range="0 1"/><geom name="g" size="1"/><site name="s"/></body>
<body name="b2"><joint name="jb" type="ball"/><geom name="g2" size="1"/><site name="s2"/></body>
</worldbody>
<deformable><flex name="fx" dim="2" body="b" vertex="0 0 0 1 0 0 0 1 0" element="0 1 2"/></deformable>
<tendon><fixed name="te"><joint joint="j" coef="1"/></fixed></tendon>
<actuator><motor name="ac" joint="j"/></actuator></mujoco>)";

/// Attributes beside which an element is read and compiled.
inline std::map<std::string, std::string> needed_by(std::string_view path) {
  static const std::map<std::string_view, std::string_view> kNeeded = {
      {"default/material/layer", "role=rgb texture=t"},
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
      {"body/flexcomp",
       "name=f type=grid count=3,3,3 spacing=.1,.1,.1 dim=3 mass=1 radius=.01"},
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
  if (const auto found = kNeeded.find(path); found != kNeeded.end()) {
    list = found->second;
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
  std::map<std::string, std::string> needed;
  for (const std::string_view pair : split_words(list)) {
    const size_t equals = pair.find('=');
    std::string value(pair.substr(equals + 1));
    std::replace(value.begin(), value.end(), ',', ' ');
    needed[std::string(pair.substr(0, equals))] = value;
  }
  return needed;
}

struct Specimen {
  Document document;
  Element element;
};

/// One element of this path; those above it, new ones too, have what they need.
inline Specimen make_specimen(const MjcfElement& element) {
  Document document = Document::from_xml(kSpecimenWorld).value();
  std::vector<const MjcfElement*> line;
  for (const MjcfElement* e = &element; e->parent != nullptr; e = e->parent) line.push_back(e);
  Element at = document.root();
  for (size_t i = line.size(); i-- > 0;) {
    const bool is_section = i + 1 == line.size();
    if (is_section && line[i]->path == "mujoco/body") {
      at = at.children("worldbody").front();
      if (i > 0 && line[0]->path != "mujoco/body/frame" && line[0]->path != "mujoco/body/replicate" && line[0]->path != "mujoco/body/attach" && line[0]->path.find("flexcomp") == std::string_view::npos) {
        at = at.add("body").value();  // the world has neither joints nor mass
        EXPECT_TRUE(at.set("name", "bn").ok());
        if (line[0]->name != "inertial") {
          Element inertial = at.add("inertial").value();
          for (const auto& [name, value] : needed_by("mujoco/body/inertial"))
            EXPECT_TRUE(inertial.set(name, value).ok());
        }
      } else if (i == 0) {
        at = at.add("body").value();
      }
    } else {
      at = at.add(line[i]->name).value();
    }
    if (i == 0 || line[i]->path != "mujoco/body") {
      for (const auto& [name, value] : needed_by(line[i]->path))
        EXPECT_TRUE(at.set(name, value).ok()) << line[i]->path << " " << name;
    }
  }
  if (element.path == "mujoco/tendon/spatial") {
    for (const char* site : {"s", "s2"}) {
      Element wrap = at.add("site").value();
      EXPECT_TRUE(wrap.set("site", site).ok());
    }
  }
  if (element.path == "mujoco/tendon/fixed") {
    Element wrap = at.add("joint").value();
    EXPECT_TRUE(wrap.set("joint", "j").ok() && wrap.set("coef", "1").ok());
  }
  return {document, at};
}

struct SpecDeleter {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
using Spec = std::unique_ptr<mjSpec, SpecDeleter>;

/// Null and why, if MuJoCo refuses it.
inline Spec parsed(const Document& document, std::string* why) {
  char error[1000] = "";
  Spec spec(mj_parseXMLString(document.to_xml().c_str(), nullptr, error, sizeof(error)));
  if (spec == nullptr) *why = error;
  return spec;
}

}  // namespace gloam::mjcf
