/// Files and meshes that are no parts: each is refused, or flagged, with what is wrong and what to do.
#include "bin_scenes/mesh/mesh_loader.hpp"

#include "mesh_files.hpp"
#include "part/shapes.hpp"

#include <sys/stat.h>

namespace bin_scenes {
namespace {

using namespace test;

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
