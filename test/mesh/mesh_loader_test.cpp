/// Models of every format: what becomes of them, and what is repaired.
#include "bin_scenes/mesh/mesh_loader.hpp"

#include "dae.hpp"
#include "mesh_files.hpp"
#include "part/shapes.hpp"

namespace bin_scenes {
namespace {

using namespace test;

// assimp 5.2.5 searches such a file for minutes.
TEST_F(MeshLoader, APlyCutBeforeTheEndOfItsHeaderIsRefusedAtOnce) {
  std::string cut = ply(box_mesh({1, 2, 3}));
  cut.resize(cut.find("end_header"));
  EXPECT_CONTAINS(load_error(file("cut.ply", cut)), "cut off or damaged");
  EXPECT_CONTAINS(load_error(file("long.ply", "ply\nformat ascii 1.0\n" + std::string(500'000, 'c'))), "cut off");
}

// Whoever writes to the file meanwhile: digest and mesh are of the same bytes.
TEST_F(MeshLoader, AFileThatIsReadIsReadOnce) {
  const std::string path = file("part.stl", stl_binary(box_mesh({1, 2, 3})));
  const ModelFile model = read_model_file(path);
  file("part.stl", stl_binary(box_mesh({7, 8, 9})));
  const LoadedMesh loaded = load_mesh(model);
  EXPECT_NEAR(loaded.mesh.bounds().size().x(), 1.0, 1e-6);
  EXPECT_EQ(loaded.report.content_sha256, model.sha256);
  EXPECT_NE(load_mesh(path).report.content_sha256, model.sha256);
}

TEST_F(MeshLoader, EveryFormatGivesTheSamePart) {
  const Mesh part = l_mesh(0.5);
  const std::pair<std::string, std::string> files[] = {{"a.stl", stl_ascii(part)},
                                                       {"b.STL", stl_binary(part)},
                                                       {"c.stl", stl_binary(part, "solid but binary")},
                                                       {"d.obj", obj(part)},
                                                       {"e.ply", ply(part)},
                                                       {"f.off", off(part)},
                                                       {"g.dae", dae(part, "<up_axis>Z_UP</up_axis>")}};
  const char* formats[] = {"STL", "STL", "STL", "OBJ", "PLY", "OFF", "DAE"};
  for (std::size_t i = 0; i < std::size(files); ++i) {
    SCOPED_TRACE(files[i].first);
    const LoadedMesh loaded = load_mesh(file(files[i].first, files[i].second));
    EXPECT_EQ(loaded.report.format, formats[i]);
    EXPECT_EQ(loaded.mesh.vertices.size(), 12u);
    EXPECT_EQ(loaded.mesh.triangles.size(), 20u);
    EXPECT_EQ(loaded.report.file_triangles, 20u);
    EXPECT_NEAR(volume(loaded.mesh), 1.5, 1e-7);
    EXPECT_LT((loaded.mesh.bounds().lower - Vec3(0, 0, 0)).norm(), 1e-7);
    EXPECT_LT((loaded.mesh.bounds().upper - Vec3(2, 2, 0.5)).norm(), 1e-7);
    EXPECT_TRUE(loaded.report.closed);
    EXPECT_EQ(loaded.report.shells, 1u);
    EXPECT_TRUE(loaded.report.flags.empty()) << loaded.report.flags.front().text;
  }
}

TEST_F(MeshLoader, UnitsAndScale) {
  const std::string path = file("part.stl", stl_binary(box_mesh({10, 20, 30})));
  LoadOptions options;
  EXPECT_NEAR(load_mesh(path, options).mesh.bounds().size().z(), 30.0, 1e-6);
  options.unit = Unit::millimetre;
  const LoadedMesh loaded = load_mesh(path, options);
  EXPECT_NEAR(loaded.mesh.bounds().size().z(), 0.030, 1e-9);
  EXPECT_EQ(loaded.report.unit, Unit::millimetre);
  options.unit = Unit::inch;
  options.scale = 0.5;
  EXPECT_NEAR(load_mesh(path, options).mesh.bounds().size().x(), 0.127, 1e-9);
}

TEST_F(MeshLoader, ADaeKeepsItsOwnUnitAndAxes) {
  const Mesh box = box_mesh({10, 20, 30});
  const std::string asset = "<unit name=\"millimeter\" meter=\"0.001\"/><up_axis>Z_UP</up_axis>";
  const std::string path = file("part.dae", dae(box, asset));
  const LoadedMesh loaded = load_mesh(path);
  EXPECT_LT((loaded.mesh.bounds().size() - Vec3(0.01, 0.02, 0.03)).norm(), 1e-9);
  EXPECT_EQ(loaded.report.unit, Unit::millimetre);
  EXPECT_EQ(loaded.report.file_metres_per_unit, 1e-3);

  LoadOptions options;
  options.unit = Unit::centimetre;
  const LoadedMesh overridden = load_mesh(path, options);
  EXPECT_NEAR(overridden.mesh.bounds().size().z(), 0.3, 1e-7);
  EXPECT_TRUE(has_flag(overridden.report, "unit_overridden"));

  const LoadedMesh y_up = load_mesh(file("y.dae", dae(box, "<unit meter=\"0,01\"/><up_axis>Y_UP</up_axis>")));
  EXPECT_LT((y_up.mesh.bounds().size() - Vec3(0.1, 0.2, 0.3)).norm(), 1e-7);  // decimal comma; axes as they are
  EXPECT_TRUE(has_flag(y_up.report, "up_axis"));

  EXPECT_CONTAINS(load_error(file("u.dae", dae(box, "<unit meter=\"none\"/>"))), "unit of \"none\" metres");
}

TEST_F(MeshLoader, NodeTransformsApplyAndMirrorsStayOutward) {
  const std::string path =
      file("two.dae", dae(box_mesh({1, 1, 1}), "<up_axis>Z_UP</up_axis>",
                          {"1 0 0 5  0 1 0 0  0 0 1 0  0 0 0 1", "-2 0 0 -5  0 1 0 0  0 0 1 0  0 0 0 1"}));
  const LoadedMesh loaded = load_mesh(path);
  EXPECT_NEAR(loaded.mesh.bounds().lower.x(), -6.0, 1e-6);
  EXPECT_NEAR(loaded.mesh.bounds().upper.x(), 5.5, 1e-6);
  EXPECT_NEAR(volume(loaded.mesh), 3.0, 1e-6);
  EXPECT_EQ(loaded.report.shells, 2u);
  EXPECT_FALSE(loaded.report.inverted);
}

TEST_F(MeshLoader, ADaeThatAssimpRefusesForItsImagesIsMended) {
  const std::string extra =
      "<library_images><image id=\"i\"/></library_images><library_effects><effect id=\"e\"><profile_COMMON><technique "
      "sid=\"c\"><phong><diffuse><texture texture=\"i\" texcoord=\"T\"/></diffuse></phong></technique></profile_COMMON>"
      "</effect></library_effects><library_materials><material id=\"mat\"><instance_effect url=\"#e\"/></material>"
      "</library_materials>";
  const std::string material =
      "<bind_material><technique_common><instance_material symbol=\"m\" target=\"#mat\"/></technique_common>"
      "</bind_material>";
  const LoadedMesh loaded =
      load_mesh(file("image.dae", dae(box_mesh({1, 2, 3}), "<up_axis>Z_UP</up_axis>", {""}, extra, material)));
  EXPECT_NEAR(volume(loaded.mesh), 6.0, 1e-6);
  EXPECT_TRUE(has_flag(loaded.report, "file_mended"));
}

TEST_F(MeshLoader, Utf16TextIsRead) {
  std::string wide = "\xff\xfe";
  for (const char c : obj(box_mesh({1, 1, 1}))) wide += {c, '\0'};
  const LoadedMesh loaded = load_mesh(file("wide.obj", wide));
  EXPECT_NEAR(volume(loaded.mesh), 1.0, 1e-7);
  EXPECT_TRUE(has_flag(loaded.report, "file_mended"));
}

TEST_F(MeshLoader, WindingIsPutRight) {
  const LoadedMesh inside_out = repair_mesh(inverted(box_mesh({1, 1, 1})), {}, "part");
  EXPECT_TRUE(inside_out.report.inverted);
  EXPECT_TRUE(has_flag(inside_out.report, "winding_inverted"));
  EXPECT_NEAR(volume(inside_out.mesh), 1.0, 1e-12);

  Mesh mixed = box_mesh({1, 1, 1});
  std::swap(mixed.triangles[3][0], mixed.triangles[3][1]);
  const LoadedMesh unified = repair_mesh(mixed, {}, "part");
  EXPECT_EQ(unified.report.turned, 1u);
  EXPECT_TRUE(has_flag(unified.report, "winding_unified"));
  EXPECT_NEAR(volume(unified.mesh), 1.0, 1e-12);
}

TEST_F(MeshLoader, SmallHolesAreClosedLargeOnesAreAnErrorOrAShell) {
  // A tiny triangle in the middle of a face is missing; six join its rim to the face's.
  Mesh small = box_mesh({1, 1, 1});
  const Triangle face = small.triangles.back();
  small.triangles.pop_back();
  const Vec3 middle = (small.vertices[face[0]] + small.vertices[face[1]] + small.vertices[face[2]]) / 3.0;
  for (const std::uint32_t v : face) small.vertices.push_back(middle + 5e-3 * (small.vertices[v] - middle));
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t next = (k + 1) % 3;
    small.triangles.push_back({face[k], face[next], 8 + next});
    small.triangles.push_back({face[k], 8 + next, 8 + k});
  }
  const LoadedMesh repaired = repair_mesh(small, {}, "part");
  EXPECT_EQ(repaired.report.holes_closed, 1u);
  ASSERT_TRUE(has_flag(repaired.report, "holes_closed"));
  EXPECT_EQ(repaired.report.flags.back().text, "1 hole closed, at most 2 % of the diagonal around (0.0346 m)");
  EXPECT_NEAR(volume(repaired.mesh), 1.0, 1e-12);

  Mesh tray = box_mesh({1, 1, 1});
  tray.triangles.erase(tray.triangles.begin() + 2, tray.triangles.begin() + 4);
  const std::string text = repair_error(tray);
  EXPECT_CONTAINS(text, "4 open edges around 1 hole, the largest 4 m");
  EXPECT_CONTAINS(text, "thickness");
  EXPECT_EQ(text.find("max_hole"), std::string::npos) << "no request can set it";

  LoadOptions options;
  options.max_hole = 1.0;
  EXPECT_NEAR(volume(repair_mesh(tray, options, "part").mesh), 1.0, 1e-12);
  options = {};
  options.thickness = 0.01;
  const LoadedMesh shell = repair_mesh(tray, options, "part");
  EXPECT_TRUE(shell.report.closed);
  EXPECT_TRUE(has_flag(shell.report, "shell_thickened"));
  EXPECT_NEAR(volume(shell.mesh), 0.05, 0.002);
  EXPECT_TRUE(has_flag(repair_mesh(box_mesh({1, 1, 1}), options, "part").report, "thickness_unused"));
  options.thickness = 2.0;
  EXPECT_CONTAINS(repair_error(tray, options), "the thickness of 2 m is more than the part is large");
  options = {};
  options.require_closed = false;
  const LoadedMesh open = repair_mesh(tray, options, "part");
  EXPECT_FALSE(open.report.closed);
  EXPECT_EQ(open.report.open_edges, 4u);
  EXPECT_TRUE(has_flag(open.report, "surface_open"));
}

TEST_F(MeshLoader, DefectsOfOneFileAreEachCountedAndFlagged) {
  Mesh mesh = box_mesh({1, 1, 1});
  mesh.triangles.push_back(mesh.triangles[4]);  // again
  mesh.triangles.push_back({0, 0, 3});          // no area
  mesh.vertices.push_back({0, -0.5, -0.5});     // T-junction on edge 0-1
  mesh.triangles[4] = {0, 8, 5};
  mesh.triangles.push_back({8, 1, 5});
  mesh.triangles.push_back({8, 1, 5});
  mesh.triangles.erase(mesh.triangles.begin() + 12);  // the repetition of the triangle that was split
  const LoadedMesh loaded = repair_mesh(mesh, {}, "part");
  EXPECT_EQ(loaded.report.degenerate_removed, 1u);
  EXPECT_EQ(loaded.report.duplicate_removed, 1u);
  EXPECT_EQ(loaded.report.t_junctions_split, 1u);
  for (const char* code : {"degenerate_removed", "duplicates_removed", "t_junctions_split"}) {
    EXPECT_TRUE(has_flag(loaded.report, code)) << code;
  }
  EXPECT_TRUE(loaded.report.closed);
  EXPECT_NEAR(volume(loaded.mesh), 1.0, 1e-12);
}

TEST_F(MeshLoader, OverlappingShellsAreUnitedCavitiesAndNeighboursAreNot) {
  Mesh crossed = box_mesh({3, 1, 1});
  append(crossed, box_mesh({1, 3, 1.5}));
  EXPECT_TRUE(has_flag(repair_mesh(crossed, {}, "part").report, "shells_united"));

  Mesh within = box_mesh({3, 3, 3});
  append(within, box_mesh({1, 1, 1}));
  EXPECT_TRUE(has_flag(repair_mesh(within, {}, "part").report, "shells_united"));

  Mesh hollow = box_mesh({3, 3, 3});
  append(hollow, inverted(box_mesh({1, 1, 1})));
  EXPECT_FALSE(has_flag(repair_mesh(hollow, {}, "part").report, "shells_united"));

  Mesh apart = box_mesh({1, 1, 1});
  append(apart, box_mesh({1, 1, 1}, {1.1, 0.2, 0.1}));
  EXPECT_FALSE(has_flag(repair_mesh(apart, {}, "part").report, "shells_united"));
}

TEST_F(MeshLoader, NothingOfTheFileIsLostOnTheWay) {
  const Mesh part = sphere_mesh(0.02, 4);
  const std::string bytes = stl_binary(part);
  const LoadedMesh loaded = load_mesh(file("ball.stl", bytes));
  EXPECT_EQ(loaded.report.file_triangles, part.triangles.size());
  EXPECT_EQ(loaded.mesh.triangles.size(), part.triangles.size());
  EXPECT_EQ(loaded.mesh.vertices.size(), part.vertices.size());
  EXPECT_EQ(loaded.report.content_sha256.size(), 64u);
  EXPECT_EQ(load_mesh(file("copy.stl", bytes)).report.content_sha256, loaded.report.content_sha256);
  EXPECT_NE(load_mesh(file("other.stl", stl_binary(part, "another header"))).report.content_sha256,
            loaded.report.content_sha256);
}

}  // namespace
}  // namespace bin_scenes
