// Models made by hand, and documents that are read and written.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <filesystem>

#include "base/files.h"
#include "gloam/mjcf_elements.h"
#include "scene/files/model_files.h"
#include "scene/mjcf/schema.h"
#include "scene/test/temp_folder.h"

namespace gloam::mjcf {
namespace {

/// A value that the attribute takes.
std::string awkward_value_for(const MjcfAttribute& attribute) {
  switch (attribute.type) {
    case MjcfType::kString:
      return "some \"text\" & <more>";
    case MjcfType::kKeyword:
      return std::string(attribute.keywords.substr(attribute.keywords.rfind(' ') + 1));
    case MjcfType::kInt:
    case MjcfType::kReal:
      break;
  }
  const int count = attribute.most == MjcfAttribute::kAnyLength ? 5 : attribute.most;
  std::string text;
  for (int i = 0; i < count; ++i) {
    if (i > 0) text += ' ';
    text += attribute.type == MjcfType::kInt ? std::to_string(i - 2) : "-0.30000000000000004";
  }
  return text;
}

/// An element of this path in a fresh document.
Element placed(const Document& document, const MjcfElement& element) {
  std::vector<const MjcfElement*> line;
  for (const MjcfElement* e = &element; e->parent != nullptr; e = e->parent) line.push_back(e);
  Element at = document.root();
  for (auto it = line.rbegin(); it != line.rend(); ++it)
    at = at.add(MjcfSchema::tag(**it, *(*it)->parent)).value();
  return at;
}

TEST(MjcfDocument, EveryAttributeComesBackFromXmlAndFromToml) {
  int count = 0;
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    Document document = Document::make("m");
    Element at = placed(document, element);
    for (const MjcfAttribute& attribute : element.attributes) {
      const Status set = at.set(attribute.name, awkward_value_for(attribute));
      ASSERT_TRUE(set.ok()) << set.error().to_string();
    }
    const Result<Document> xml = Document::from_xml(document.to_xml(), "written.xml");
    ASSERT_TRUE(xml.ok()) << xml.error().to_string() << "\n" << document.to_xml();
    const Result<Document> toml = Document::from_toml(document.to_toml(), "written.toml");
    ASSERT_TRUE(toml.ok()) << toml.error().to_string() << "\n" << document.to_toml();
    for (const bool is_xml : {true, false}) {
      const Document& back = is_xml ? *xml : *toml;
      EXPECT_EQ(back.to_xml(), document.to_xml());
      Element same = back.root();
      while (!same.children().empty()) same = same.children()[0];
      ASSERT_EQ(same.path(), element.path);
      for (const MjcfAttribute& attribute : element.attributes) {
        const std::string wanted =
            is_xml && attribute.is_spec_only() ? "nothing" : awkward_value_for(attribute);
        EXPECT_EQ(same.get(attribute.name)->value_or("nothing"), wanted)
            << element.path << " " << attribute.name;
        count += attribute.is_spec_only() || is_xml ? 0 : 1;
      }
    }
  }
  EXPECT_EQ(count, MjcfSchema::get().attribute_count());
}

Document pendulum() {
  Document document = Document::make("pendulum");
  Mujoco model(document.root());
  model.option().set_timestep(0.001).set_gravity({0, 0, -9.81}).flag().set_energy(true);
  Body world = model.worldbody();
  world.add_geom().set_type(GeomType::kPlane).set_size({0, 0, 0.05});
  Body arm = world.add_body().set_name("arm").set_pos({0, 0, 1});
  arm.add_joint().set_name("hinge").set_axis({0, 1, 0}).set_damping({0.1});
  arm.add_geom()
      .set_name("rod")
      .set_type(GeomType::kCapsule)
      .set_fromto({0, 0, 0, 0.5, 0, 0})
      .set_size({0.02})
      .set_mass(1);
  arm.add_site().set_name("tip").set_pos({0.5, 0, 0});
  model.actuator().add_motor().set_name("drive").set_joint("hinge").set_ctrlrange({-1, 1});
  model.sensor().add_accelerometer().set_site("tip");
  return document;
}

std::unique_ptr<mjModel, decltype(&mj_deleteModel)> compiled(const std::string& xml) {
  char error[1000] = "";
  mjSpec* spec = mj_parseXMLString(xml.c_str(), nullptr, error, sizeof(error));
  EXPECT_NE(spec, nullptr) << error << "\n" << xml;
  if (spec == nullptr) return {nullptr, mj_deleteModel};
  std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model(mj_compile(spec, nullptr),
                                                            mj_deleteModel);
  EXPECT_NE(model, nullptr) << mjs_getError(spec);
  mj_deleteSpec(spec);
  return model;
}

TEST(MjcfDocument, ARobotMadeInCodeIsWhatStockMuJoCoLoads) {
  const auto model = compiled(pendulum().to_xml());
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->nu, 1);
  EXPECT_EQ(model->nsensordata, 3);
  EXPECT_EQ(model->opt.timestep, 0.001);
  EXPECT_EQ(model->dof_damping[0], 0.1);
  EXPECT_EQ(model->body_mass[1], 1);
  EXPECT_TRUE((model->opt.enableflags & mjENBL_ENERGY) != 0);
}

TEST(MjcfDocument, PropertiesReadWhatIsWritten) {
  const Document document = pendulum();
  const std::vector<Joint> joints = all<Joint>(document.root());
  ASSERT_EQ(joints.size(), 1U);
  Joint joint = joints[0];
  EXPECT_EQ(joint.axis(), (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(joint.damping(), std::vector<double>{0.1});
  EXPECT_FALSE(joint.type().has_value());
  joint.set_type(JointType::kSlide);
  EXPECT_EQ(joint.type(), JointType::kSlide);
  EXPECT_EQ(*joint.get("type"), "slide");
  EXPECT_TRUE(joint.clear("type").ok());
  EXPECT_FALSE(joint.type().has_value());
  EXPECT_EQ(all<Geom>(document.root())[1].type(), GeomType::kCapsule);
  EXPECT_EQ(all<Geom>(document.root())[1].mass(), 1);
  Camera camera = Mujoco(document.root()).worldbody().add_camera();
  camera.set_output({Output::kRgb, Output::kDepth});
  EXPECT_EQ(*camera.get("output"), "rgb depth");
  EXPECT_EQ(camera.output(), (std::vector<Output>{Output::kRgb, Output::kDepth}));
  EXPECT_EQ(Mujoco(document.root()).option().flag().energy(), true);
}

TEST(MjcfDocument, TomlIsTheSameModel) {
  const char* const kToml = R"([mujoco]
model = "pendulum"
[mujoco.option]
timestep = 0.001
gravity = [0, 0, -9.81]
[mujoco.option.flag]
energy = true
[[mujoco.worldbody.geom]]
type = "plane"
size = [0, 0, 0.05]
[[mujoco.worldbody.body]]
name = "arm"
pos = [0, 0, 1]
[[mujoco.worldbody.body.joint]]
name = "hinge"
axis = [0, 1, 0]
damping = 0.1
[[mujoco.worldbody.body.geom]]
name = "rod"
type = "capsule"
fromto = [0, 0, 0, 0.5, 0, 0]
size = 0.02
mass = 1
[[mujoco.worldbody.body.site]]
name = "tip"
pos = [0.5, 0, 0]
[[mujoco.actuator.motor]]
name = "drive"
joint = "hinge"
ctrlrange = [-1, 1]
[[mujoco.sensor.accelerometer]]
site = "tip"
)";
  const Result<Document> document = Document::from_toml(kToml, "pendulum.toml");
  ASSERT_TRUE(document.ok()) << document.error().to_string();
  EXPECT_EQ(document->to_xml(), pendulum().to_xml());
}

TEST(MjcfDocument, ElementsOfSeveralKindsKeepTheirOrderInToml) {
  const std::string xml =
      "<mujoco>\n  <worldbody>\n    <body name=\"a\" />\n    <geom size=\"1\" />\n"
      "    <frame pos=\"1 0 0\">\n      <body name=\"b\" />\n    </frame>\n    <body name=\"c\" "
      "/>\n"
      "  </worldbody>\n</mujoco>\n";
  const Result<Document> document = Document::from_xml(xml);
  ASSERT_TRUE(document.ok()) << document.error().to_string();
  const Result<Document> back = Document::from_toml(document->to_toml(), "x.toml");
  ASSERT_TRUE(back.ok()) << back.error().to_string() << document->to_toml();
  EXPECT_EQ(back->to_xml(), xml);
}

TEST(MjcfDocument, CommentsAndTextStay) {
  const std::string xml =
      "<mujoco>\n  <!-- the world -->\n  <worldbody>\n    <!-- nothing yet -->\n  </worldbody>\n"
      "  <custom>\n    <text name=\"t\"><![CDATA[a < b]]></text>\n  </custom>\n</mujoco>\n";
  const Result<Document> document = Document::from_xml(xml);
  ASSERT_TRUE(document.ok()) << document.error().to_string();
  EXPECT_EQ(document->to_xml(), xml);
}

TEST(MjcfDocument, ErrorsNameLineAndWhatWasMeant) {
  const auto wrong = [](const std::string& body) {
    const Result<Document> document =
        Document::from_xml("<mujoco>\n<worldbody>\n" + body + "</worldbody></mujoco>", "m.xml");
    return document.ok() ? std::string("fine") : document.error().to_string();
  };
  EXPECT_EQ(wrong("<geom szie=\"1\"/>"),
            "m.xml:3: <geom> has no attribute 'szie' (did you mean 'size'?)");
  EXPECT_EQ(wrong("<gem size=\"1\"/>"),
            "m.xml:3: <gem> is not allowed in <body> (did you mean <geom>?)");
  EXPECT_EQ(wrong("<geom size=\"big\"/>"),
            "m.xml:3: <geom> size=\"big\" contains 'big', which is not a number; expected 1 to 3 "
            "numbers [m]");
  EXPECT_EQ(wrong("<motor/>"),
            "m.xml:3: <motor> is not allowed in <body> (it is allowed in <actuator>, <default>)");
  EXPECT_EQ(wrong("<body><inertial/><inertial/></body>"),
            "m.xml:3: <inertial> appears twice in <body>");
  EXPECT_EQ(Document::from_xml("<robot/>", "r.urdf").error().to_string(),
            "r.urdf:1: the root element is <robot>, but MJCF starts with <mujoco>");
  EXPECT_EQ(Document::from_toml("[mujoco]\n[[mujoco.worldbody.geom]]\nszie = 1\n", "m.toml")
                .error()
                .to_string(),
            "m.toml:3:8: <geom> has no attribute 'szie' (did you mean 'size'?)");
  EXPECT_EQ(
      Document::from_toml("[robot]\n[mujoco]\n", "m.toml").error().to_string(),
      "m.toml:1:1: 'robot' is outside of [mujoco] (a TOML model has only the table [mujoco])");
  Document lacking = Document::make("m");
  Mujoco(lacking.root()).sensor().add_touch().set_name("t");
  EXPECT_EQ(lacking.check().error().to_string(), "<touch> 't' is missing 'site': text");
  Mujoco(lacking.root()).sensor().children()[0].remove();
  EXPECT_TRUE(lacking.check().ok());
}

TEST(MjcfDocument, FilesAreWrittenWholeAndOnlyIfTheyCanBeRead) {
  const TempFolder folder;
  for (const char* name : {"pendulum.xml", "pendulum.toml"}) {
    ASSERT_TRUE(pendulum().save(folder.path() / name).ok());
    const Result<Document> back = Document::load(folder.path() / name);
    ASSERT_TRUE(back.ok()) << back.error().to_string();
    EXPECT_EQ(back->to_xml(), pendulum().to_xml());
  }
  Document lacking = pendulum();
  Mujoco(lacking.root()).sensor().add_touch();
  EXPECT_FALSE(lacking.save(folder.path() / "pendulum.xml").ok());
  EXPECT_TRUE(Document::load(folder.path() / "pendulum.xml").ok());
  EXPECT_FALSE(Document::load(folder.path() / "nothing.xml").ok());
  ASSERT_TRUE(pendulum().save(folder.path() / "UPPER.TOML").ok());
  EXPECT_EQ(read_text_file(folder.path() / "UPPER.TOML").value(), pendulum().to_toml());
}

}  // namespace
}  // namespace gloam::mjcf
