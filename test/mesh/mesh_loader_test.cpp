#include "bin_scenes/mesh/mesh_loader.hpp"

#include "bin_scenes/core/error.hpp"
#include "dae.hpp"
#include "part/shapes.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace bin_scenes {
namespace {

namespace fs = std::filesystem;
using namespace test;

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
  }
  return sum;
}

std::string stl_ascii(const Mesh& mesh) {
  std::ostringstream out;
  out << "solid part\n";
  for (const Triangle& t : mesh.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t) out << "vertex " << mesh.vertices[v].transpose() << "\n";
    out << "endloop\nendfacet\n";
  }
  out << "endsolid part\n";
  return out.str();
}

std::string stl_binary(const Mesh& mesh, const std::string& header = "made by a test") {
  std::string out = header;
  out.resize(80, ' ');
  const auto put = [&](const void* data, std::size_t size) { out.append(static_cast<const char*>(data), size); };
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  put(&count, 4);
  for (const Triangle& t : mesh.triangles) {
    float numbers[12] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) numbers[3 + 3 * k + i] = static_cast<float>(mesh.vertices[t[k]][i]);
    }
    put(numbers, sizeof numbers);
    put("\0\0", 2);
  }
  return out;
}

std::string obj(const Mesh& mesh) {
  std::ostringstream out;
  for (const Vec3& v : mesh.vertices) out << "v " << v.transpose() << "\n";
  for (const Triangle& t : mesh.triangles) out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  return out.str();
}

std::string off(const Mesh& mesh) {
  std::ostringstream out;
  out << "OFF\n" << mesh.vertices.size() << " " << mesh.triangles.size() << " 0\n";
  for (const Vec3& v : mesh.vertices) out << v.transpose() << "\n";
  for (const Triangle& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
  return out.str();
}

std::string ply(const Mesh& mesh) {
  std::ostringstream out;
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices) out << v.transpose() << "\n";
  for (const Triangle& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
  return out.str();
}

class MeshLoader : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("bin_scenes_loader_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }

  /// The error a call gives; its where() is the path, its remedy is not empty.
  template <class Call>
  std::string error_of(Call&& call, const std::string& where) const {
    try {
      call();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_EQ(error.where(), where);
      EXPECT_FALSE(error.remedy().empty());
      return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
  }
  std::string load_error(const std::string& path, const LoadOptions& options = {}) const {
    return error_of([&] { load_mesh(path, options); }, path);
  }
  std::string repair_error(const Mesh& mesh, const LoadOptions& options = {}) const {
    return error_of([&] { repair_mesh(mesh, options, "part"); }, "part");
  }

  fs::path folder_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
#define EXPECT_CONTAINS(text, part) EXPECT_PRED2(contains, text, part)

bool has_flag(const LoadReport& report, const std::string& code) {
  for (const Flag& flag : report.flags) {
    if (flag.code == code) return !flag.text.empty() && !flag.remedy.empty();
  }
  return false;
}

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

TEST_F(MeshLoader, FilesThatAreNone) {
  EXPECT_CONTAINS(load_error((folder_ / "missing.stl").string()), "no such model file");
  EXPECT_CONTAINS(load_error(folder_.string()), "is a folder");
  EXPECT_CONTAINS(load_error(file("empty.stl", "")), "the file is empty");
  EXPECT_CONTAINS(load_error(file("part.sldprt", "a document")), "not a model format that is read here");
  EXPECT_CONTAINS(load_error(file("part.step", "ISO-10303-21;")),
                  reads_cad() ? "damaged or cut off" : "install libocct-data-exchange-dev");
  mkfifo((folder_ / "pipe.stl").c_str(), 0600);
  EXPECT_CONTAINS(load_error((folder_ / "pipe.stl").string()), "not a regular file");
  if (geteuid() != 0) {
    const std::string secret = file("secret.stl", stl_ascii(box_mesh({1, 1, 1})));
    chmod(secret.c_str(), 0);
    EXPECT_CONTAINS(load_error(secret), "cannot be read");
  }
}

TEST_F(MeshLoader, DamagedFilesSayWhatIsWrong) {
  const Mesh box = box_mesh({1, 1, 1});
  const std::string binary = stl_binary(box);
  EXPECT_CONTAINS(load_error(file("cut.stl", binary.substr(0, 400))), "promises 12 triangles, 684 bytes");
  EXPECT_CONTAINS(load_error(file("noise.stl", "not an STL")), "neither an ASCII STL");
  EXPECT_CONTAINS(load_error(file("wrong.obj", binary)), "named .OBJ, but its contents are STL");
  EXPECT_CONTAINS(load_error(file("huge.off", "OFF\n353535235358 6 0\n0 0 0\n")), "promises 353535235358");
  EXPECT_CONTAINS(load_error(file("cut.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n")), "4 vertices and 4 faces");
  EXPECT_CONTAINS(load_error(file("negative.off", "OFF\n-3 6 0\n0 0 0\n")), "negative count");
  EXPECT_CONTAINS(load_error(file("huge.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n")),
                  "promises 4000000000");
  EXPECT_CONTAINS(load_error(file("bad.ply", "ply\nformat ascii 1.0\nelement vertex many\nend_header\n")),
                  "bad element count");
  EXPECT_CONTAINS(load_error(file("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")), "cannot be read as OBJ");
  EXPECT_CONTAINS(load_error(file("xml.dae", "<COLLADA><asset>")), "not well-formed XML");
  EXPECT_CONTAINS(load_error(file("other.dae", "<html/>")), "not COLLADA");
  EXPECT_CONTAINS(load_error(file("points.ply",
                                  "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                                  "property float z\nend_header\n0 0 0\n")),
                  "no faces");
}

TEST_F(MeshLoader, MeshesThatAreNoParts) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Mesh broken = box_mesh({1, 1, 1});
  broken.vertices[3].y() = nan;
  EXPECT_CONTAINS(repair_error(broken), "not finite");
  broken.vertices[3].y() = std::numeric_limits<double>::infinity();
  EXPECT_CONTAINS(repair_error(broken), "not finite");
  EXPECT_CONTAINS(repair_error({}), "no triangles");
  Mesh index = box_mesh({1, 1, 1});
  index.triangles[0][0] = 99;
  EXPECT_CONTAINS(repair_error(index), "vertex 99 of 8");
  EXPECT_CONTAINS(repair_error(box_mesh({0, 0, 0})), "in one point");
  EXPECT_CONTAINS(repair_error(box_mesh({1e9, 1, 1})), "which no part is");
  EXPECT_CONTAINS(repair_error(box_mesh({1e-9, 1e-9, 1e-9})), "which no part is");
  EXPECT_CONTAINS(repair_error(box_mesh({1e-3, 1e-3, 1e-3}, {1e4, 0, 0})), "from the origin");

  Mesh double_faced = box_mesh({1, 1, 1});
  append(double_faced, inverted(double_faced));
  EXPECT_CONTAINS(repair_error(double_faced), "every face is there twice");
  Mesh other_diagonals = box_mesh({1, 1, 1});  // the back faces' quads are cut along the other diagonal
  const Mesh back = other_diagonals;
  for (std::size_t t = 0; t < 12; t += 2) {
    const Triangle first = back.triangles[t], second = back.triangles[t + 1];
    // A quad a b c, a c d becomes d c b, d b a.
    other_diagonals.triangles.push_back({second[2], first[2], first[1]});
    other_diagonals.triangles.push_back({second[2], first[1], first[0]});
  }
  EXPECT_CONTAINS(repair_error(other_diagonals), "encloses nothing");
  Mesh flat = box_mesh({1, 1, 1});
  for (Vec3& v : flat.vertices) v.z() *= 1e-9;
  LoadOptions fine;
  fine.weld = 1e-12;
  EXPECT_CONTAINS(repair_error(flat, fine), "encloses nothing");
}

TEST_F(MeshLoader, OptionsOutsideTheirRange) {
  const Mesh box = box_mesh({1, 1, 1});
  LoadOptions options;
  options.scale = 0.0;
  EXPECT_CONTAINS(repair_error(box, options), "scale is 0");
  options = {};
  options.weld = 1.0;
  EXPECT_CONTAINS(repair_error(box, options), "weld distance is 1");
  options = {};
  options.max_hole = -1.0;
  EXPECT_CONTAINS(repair_error(box, options), "max_hole is -1");
  options = {};
  options.thickness = -0.1;
  EXPECT_CONTAINS(repair_error(box, options), "thickness is -0.1");
}

TEST_F(MeshLoader, ImplausibleSizesNameTheLikelyUnit) {
  const Bin bin;  // 0.4 x 0.3 x 0.2 m
  const auto check = [&](double size, std::optional<Unit> given) {
    check_plausible_size(box_mesh({size, size, size}), bin, "part.stl", given);
  };
  EXPECT_NO_THROW(check(0.05, std::nullopt));
  const auto text = [&](double size, std::optional<Unit> given) {
    return error_of([&] { check(size, given); }, "part.stl");
  };
  EXPECT_CONTAINS(text(50.0, std::nullopt), "unit: mm");
  EXPECT_CONTAINS(text(5.0, std::nullopt), "unit: mm");  // 5 mm: small, but a part all the same
  EXPECT_CONTAINS(text(1.0, std::nullopt), "unit: cm");
  const std::string inches = text(3.9, std::nullopt);  // of a part of 99 mm, which could be one of 4 mm as well
  for (const char* choice : {"\"unit: mm\" makes it 0.00675", "\"unit: cm\" 0.0675", "\"unit: inch\" 0.172"})
    EXPECT_CONTAINS(inches, choice);
  EXPECT_FALSE(contains(inches, "probably"));
  EXPECT_CONTAINS(text(5e-5, std::nullopt), "too small");
  EXPECT_NO_THROW(check(5e-5, Unit::millimetre));
  const std::string large = text(1.0, Unit::metre);
  EXPECT_CONTAINS(large, "too large for the bin of 0.4 x 0.3 x 0.2 m");
  EXPECT_FALSE(contains(large, "probably"));

  const Bin small = [] {
    Bin bin;
    bin.inner_size = Vec3::Constant(0.01);
    return bin;
  }();
  const std::string cube = error_of(
      [&] {
        check_plausible_size(box_mesh({0.03, 0.03, 0.03}), small, "part.stl", {});
      },
      "part.stl");
  EXPECT_CONTAINS(cube, "too large for the bin of 0.01 x 0.01 x 0.01 m");
  EXPECT_FALSE(contains(cube, "probably")) << "no file holds a part of 0.05 mm in numbers of 0.03: " << cube;

  Bin floor;
  floor.kind = Bin::Kind::floor;
  EXPECT_NO_THROW(check_plausible_size(box_mesh({1, 1, 1}), floor, "part.stl", std::nullopt));
  EXPECT_THROW(check_plausible_size(box_mesh({50, 50, 50}), floor, "part.stl", std::nullopt), Error);
}

TEST_F(MeshLoader, PartsAreMeasuredAgainstABinThatIsAMesh) {
  Bin bin;
  bin.kind = Bin::Kind::mesh;
  bin.mesh = "mug.stl";
  bin.unit = Unit::millimetre;
  const Mesh mug = box_mesh({0.1, 0.08, 0.09}, {3, 0, 0});
  const auto text = [&](double size, std::optional<Unit> given) {
    const Mesh part = box_mesh({size, size, size});
    return error_of([&] { check_plausible_size(part, bin, "nut.stl", given, &mug); }, "nut.stl");
  };
  EXPECT_NO_THROW(check_plausible_size(box_mesh({0.02, 0.02, 0.02}), bin, "nut.stl", std::nullopt, &mug));
  const std::string metres = text(20.0, std::nullopt);
  EXPECT_CONTAINS(metres, "too large for the bin of 0.1 x 0.08 x 0.09 m");
  EXPECT_CONTAINS(metres, "unit: mm");
  EXPECT_CONTAINS(text(0.2, Unit::millimetre), "too large");
  EXPECT_CONTAINS(text(1e-5, std::nullopt), "too small");
}

TEST_F(MeshLoader, ABinOfImplausibleSizeIsRefusedWithTheLikelyUnit) {
  Bin bin;
  bin.kind = Bin::Kind::mesh;
  bin.mesh = "mug.stl";
  const Mesh mug = box_mesh({100, 80, 90});
  const auto text = [&](const Mesh& mesh, double part) {
    return error_of([&] { check_plausible_bin(mesh, bin, part); }, "mug.stl");
  };
  EXPECT_CONTAINS(text(mug, 0.0), "unit: mm") << "whatever the parts are";
  EXPECT_CONTAINS(text(mug, 0.02), "unit: mm");
  EXPECT_CONTAINS(text(box_mesh({4, 4, 4}), 0.001), "the bin is 4 x 4 x 4 m");
  EXPECT_NO_THROW(check_plausible_bin(box_mesh({4, 4, 4}), bin, 0.02));
  bin.unit = Unit::metre;
  EXPECT_NO_THROW(check_plausible_bin(mug, bin, 0.02)) << "who says so gets a bin of 100 m";
}

}  // namespace
}  // namespace bin_scenes
