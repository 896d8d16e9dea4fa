#include "scene/mjcf/specimen_parts.h"

#include <algorithm>

namespace gloam::mjcf {
namespace {

// "size=1,1,1 name=g"
Attributes attributes_of(std::string_view list) {
  Attributes pairs;
  for (const std::string_view pair : split_words(list)) {
    const size_t equals = pair.find('=');
    std::string value(pair.substr(equals + 1));
    std::replace(value.begin(), value.end(), ',', ' ');
    pairs[std::string(pair.substr(0, equals))] = value;
  }
  return pairs;
}

}  // namespace

const char* const kSpecimenWorld = R"(<mujoco>
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
  return attributes_of(list);
}

std::optional<Attributes> instead_for(const MjcfElement& element, std::string_view attribute) {
  struct Instead {
    std::string_view section, attributes, values;
  };
  static constexpr Instead kReplacements[] = {
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
  for (const Instead& row : kReplacements) {
    const std::string_view above = element.parent == nullptr ? "" : element.parent->path;
    if (above != row.section && element.path != row.section) continue;
    for (const std::string_view name : split_words(row.attributes)) {
      if (name == attribute) return attributes_of(row.values);
    }
  }
  return {};
}

}  // namespace gloam::mjcf
