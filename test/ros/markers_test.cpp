#include "markers.hpp"

#include "box_mesh.hpp"
#include "dae.hpp"
#include "scene/palette.hpp"

#ifdef MARKERS_TEST_CAD
#include <BRepPrimAPI_MakeBox.hxx>
#include <STEPControl_Writer.hxx>
#endif
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace bin_scenes {
namespace {

namespace fs = std::filesystem;
const ros::Time stamp(12, 34);

/// A box of 20 units in a file of each kind, and how large RViz draws its unit: metres, or what COLLADA states.
class Markers : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("bin_scenes_markers_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "box.stl") << box_stl(20);
    std::ofstream(folder_ / "mm.dae") << dae(box_mesh(20), "<unit meter=\"0.001\"/><up_axis>Z_UP</up_axis>");
    std::ofstream(folder_ / "feet.dae") << dae(box_mesh(20), "<unit meter=\"0.3048\"/><up_axis>Z_UP</up_axis>");
    std::ofstream(folder_ / "none.dae") << dae(box_mesh(20), "<up_axis>Z_UP</up_axis>");
  }
  void TearDown() override { fs::remove_all(folder_); }

  struct Case {
    const char* file;
    std::optional<Unit> unit;
    double drawn;  ///< m a unit
  };
  const std::vector<Case> cases_ = {{"box.stl", Unit::millimetre, 1.0},     {"box.stl", std::nullopt, 1.0},
                                    {"mm.dae", std::nullopt, 1e-3},         {"mm.dae", Unit::millimetre, 1e-3},
                                    {"mm.dae", Unit::inch, 1e-3},           {"feet.dae", std::nullopt, 0.3048},
                                    {"feet.dae", Unit::centimetre, 0.3048}, {"none.dae", Unit::millimetre, 1.0}};

  std::string path(const Case& c) const { return (folder_ / c.file).string(); }
  PartModelPtr load(const Case& c, double scale) const {
    LoadOptions options;
    options.unit = c.unit;
    options.scale = scale;
    return PartModel::load(path(c), options);
  }

  fs::path folder_;
};

TEST_F(Markers, PartsAreDrawnAsLargeAsTheyAre) {
  for (const Case& c : cases_) {
    SCOPED_TRACE(c.file);
    Request request;
    request.parts.emplace_back();
    request.parts[0].model = request.parts[0].path = path(c);
    request.parts[0].scale = 2.0;
    const PartModelPtr model = load(c, 2.0);
    Scene scene;
    scene.parts.emplace_back();
    scene.parts[0].model = path(c);
    const auto markers = scene_markers(scene, {request, {model}}, Frames(), stamp).markers;
    const auto& part = markers.back();
    ASSERT_EQ(part.ns, "parts");
    EXPECT_EQ(part.mesh_resource, "file://" + path(c));
    const double size = model->mesh().bounds().size().x();
    EXPECT_NEAR(20 * c.drawn * part.scale.x, size, 1e-6 * size);
    EXPECT_EQ(part.scale.x, part.scale.y);
    EXPECT_EQ(part.scale.x, part.scale.z);
  }
}

#ifdef MARKERS_TEST_CAD
TEST_F(Markers, PartsOfCadFilesAreDrawnAsTriangles) {
  STEPControl_Writer writer;
  writer.Transfer(BRepPrimAPI_MakeBox(30.0, 20.0, 10.0).Shape(), STEPControl_AsIs);
  const std::string file = (folder_ / "box.step").string();
  ASSERT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
  Request request;
  request.parts.emplace_back();
  request.parts[0].scale = 2.0;
  LoadOptions options;
  options.scale = 2.0;
  Scene scene;
  scene.parts.emplace_back();
  const auto markers = scene_markers(scene, {request, {PartModel::load(file, options)}}, Frames(), stamp).markers;
  const auto& part = markers.back();
  EXPECT_EQ(part.type, visualization_msgs::Marker::TRIANGLE_LIST);
  EXPECT_TRUE(part.mesh_resource.empty());
  ASSERT_EQ(part.points.size(), 36u);
  double longest = 0.0;
  for (const auto& p : part.points) longest = std::max(longest, p.x);
  EXPECT_NEAR(longest * part.scale.x, 0.06, 1e-9);
}
#endif

TEST_F(Markers, ABinOfAMeshIsDrawnWhereAndAsLargeAsItIs) {
  for (const Case& c : cases_) {
    SCOPED_TRACE(c.file);
    Request request;
    request.bin.kind = Bin::Kind::mesh;
    request.bin.mesh = path(c);
    request.bin.pose.position = Vec3(0.1, 0.2, 0.3);
    const PartModelPtr model = load(c, 1.0);
    const auto markers = scene_markers(Scene(), {request, {}, model}, Frames(), stamp).markers;
    ASSERT_EQ(markers.size(), 2u);
    EXPECT_EQ(markers[1].ns, "bin");
    EXPECT_EQ(markers[1].pose.position.z, 0.3);
    const double size = model->mesh().bounds().size().x();
    EXPECT_NEAR(20 * c.drawn * markers[1].scale.x, size, 1e-6 * size);
  }
}

TEST_F(Markers, TheTableIsABoxWhoseUpperSideIsThatOfTheTable) {
  const auto markers_of = [](const Request& request) {
    std::vector<visualization_msgs::Marker> tables;
    for (const auto& m : scene_markers(Scene(), {request, {}}, Frames(), stamp).markers)
      if (m.ns == "table") tables.push_back(m);
    return tables;
  };
  Request request;
  EXPECT_TRUE(markers_of(request).empty());
  request.table.height = -0.05;
  const auto tables = markers_of(request);
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(tables[0].type, visualization_msgs::Marker::CUBE);
  EXPECT_EQ(tables[0].header.frame_id, Frames().bin);
  EXPECT_NEAR(tables[0].pose.position.z + 0.5 * tables[0].scale.z, -0.05, 1e-12);
  EXPECT_GT(tables[0].scale.x, request.bin.inner_size.x());
  EXPECT_EQ(tables[0].color.a, 1.0f);
}

TEST(PartColor, IsThatOfAllOutputs) {
  for (int id = 0; id < 50; ++id) {
    const Vec3 colour = part_colour(id);
    EXPECT_EQ(part_color(id).r, static_cast<float>(colour.x()));
    EXPECT_EQ(part_color(id).g, static_cast<float>(colour.y()));
    EXPECT_EQ(part_color(id).b, static_cast<float>(colour.z()));
  }
}

TEST(ResourceUri, KeepsPackagesAndEncodesPaths) {
  EXPECT_EQ(resource_uri("package://cell/a b.stl", "/opt/cell/a b.stl"), "package://cell/a b.stl");
  EXPECT_EQ(resource_uri("a b.stl", "/opt/a b#1.stl"), "file:///opt/a%20b%231.stl");
}

TEST_F(Markers, ContactsAreDrawnByTheWeightOfTheLightestPart) {
  LoadedRequest loaded;
  for (const double mass : {2.0, 0.5}) {
    loaded.request.parts.emplace_back();
    loaded.request.parts.back().mass = mass;
    loaded.parts.push_back(load(cases_[0], 1.0));
  }
  const double diagonal = loaded.parts[0]->diagonal(), weight = 0.5 * loaded.request.gravity.norm();
  const Vec3 point(0.1, 0.2, 0.3);
  const auto contact = [&](double weights) {
    SceneContact contact{0, 1, point, Vec3::UnitX(), weights * weight * Vec3::UnitZ()};
    if (weights > 1.0) contact.action = ContactAction::impact;
    return contact;
  };
  const auto array = contact_markers({contact(1.0), contact(1000.0), contact(0.0)}, loaded, {}, stamp).markers;
  ASSERT_EQ(array.size(), 3u);
  EXPECT_EQ(array[0].points.size(), 3u);
  const auto length = [&](const visualization_msgs::Marker& m, std::size_t i) {
    const auto &from = m.points.at(2 * i), &to = m.points.at(2 * i + 1);
    EXPECT_EQ(from.x, point.x());
    return Vec3(to.x - from.x, to.y - from.y, to.z - from.z);
  };
  EXPECT_NEAR((length(array[1], 0) - 0.15 * diagonal * Vec3::UnitX()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((length(array[2], 0) - 0.5 * diagonal * Vec3::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((length(array[2], 1) - 3.0 * diagonal * Vec3::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_EQ(length(array[2], 2), Vec3::Zero());
  EXPECT_EQ(array[2].colors.at(2).r, 1.0f) << "far above a hundred weights";
  EXPECT_EQ(array[2].colors.at(4).b, 1.0f) << "nothing presses";
  EXPECT_EQ(array[0].colors.at(1), action_color(ContactAction::impact));
  EXPECT_EQ(array[0].colors.at(2), action_color(ContactAction::resting));
  for (const auto& m : contact_markers({}, loaded, {}, stamp).markers)
    EXPECT_EQ(m.action, visualization_msgs::Marker::DELETE);
}

TEST_F(Markers, PartsOfATraceFollowTheirFrames) {
  LoadedRequest loaded;
  loaded.request.parts.emplace_back();
  loaded.request.parts.back().count = 3;
  loaded.request.parts.back().model = cases_[0].file;
  loaded.parts.push_back(load(cases_[0], 1.0));
  int parts = 0;
  for (const auto& m : following_markers(loaded, {}, stamp).markers) {
    if (m.ns != "parts") continue;
    EXPECT_EQ(m.header.frame_id, part_frame(parts++));
    EXPECT_TRUE(m.frame_locked);
    EXPECT_EQ(m.pose.position.x, 0.0);
    EXPECT_EQ(m.pose.orientation.w, 1.0);
  }
  EXPECT_EQ(parts, 3);
}

}  // namespace
}  // namespace bin_scenes
