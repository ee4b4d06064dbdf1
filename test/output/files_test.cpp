#include "output/output_fixture.hpp"

#include <sys/resource.h>

#include <csignal>
#include <cstring>

namespace bin_scenes {
namespace {

using Files = OutputTest;

TEST_F(Files, AreReplacedWholeAndLeaveNothingBeside) {
  write_text(path("a.txt"), "old and long");
  write_text(path("a.txt"), "new");
  EXPECT_EQ(text("a.txt"), "new");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(Files, WhatCannotBeWrittenIsAnEnvironmentError) {
  EXPECT_EQ(kind_of_failure([&] { write_text(path("nowhere/a.txt"), "text"); }), ErrorKind::environment);
  std::filesystem::create_directory(dir / "taken");
  std::filesystem::create_directory(dir / "taken/inside");
  write_text(path("taken/inside/a.txt"), "kept");
  EXPECT_EQ(kind_of_failure([&] { write_text(path("taken/inside/a.txt/b.txt"), "text"); }), ErrorKind::environment);
  EXPECT_EQ(text("taken/inside/a.txt"), "kept");
}

TEST_F(Files, AFullDiskIsAnEnvironmentErrorAndLeavesNothing) {
  // A file that may not grow stands for a disk that is full; /dev/full cannot, because of the temporary name.
  const RangeImage image = small_image();
  rlimit old;
  getrlimit(RLIMIT_FSIZE, &old);
  const rlimit tiny = {16, old.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &tiny);
  const ErrorKind text_kind = kind_of_failure([&] { write_text(path("a.txt"), std::string(1000, 'x')); });
  const ErrorKind image_kind = kind_of_failure([&] { write_pngs(dir.string(), image); });
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(text_kind, ErrorKind::environment);
  EXPECT_EQ(image_kind, ErrorKind::environment);
  EXPECT_EQ(entries(), 0u);
}

TEST_F(Files, ADirectoryAppearsWholeAndReplacesTheOldOne) {
  std::filesystem::create_directory(dir / "scene");
  write_text(path("scene/old.txt"), "old");
  {
    Temporary whole(path("scene"));
    std::filesystem::create_directory(whole.path());
    write_text(whole.path() + "/new.txt", "new");
    EXPECT_EQ(text("scene/old.txt"), "old") << "nothing is touched before it is whole";
    whole.commit();
  }
  EXPECT_EQ(text("scene/new.txt"), "new");
  EXPECT_FALSE(std::filesystem::exists(dir / "scene/old.txt"));
  {
    Temporary given_up(path("other"));
    std::filesystem::create_directory(given_up.path());
  }
  EXPECT_EQ(entries(), 1u);
}

TEST_F(Files, PlyHoldsTheScaledMesh) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.001, 0, 0}, {0, 0.002, 0}};
  mesh.triangles = {{0, 1, 2}};
  write_ply(path("a.ply"), mesh, 1000.0);
  const std::string ply = text("a.ply");
  const std::string end = "end_header\n";
  const std::size_t body = ply.find(end) + end.size();
  ASSERT_EQ(ply.size(), body + 9 * 4 + 1 + 3 * 4);
  EXPECT_NE(ply.find("element vertex 3\n"), std::string::npos);
  float y;
  std::memcpy(&y, &ply[body + 7 * 4], 4);
  EXPECT_EQ(y, 2.0f);
}

}  // namespace
}  // namespace bin_scenes
