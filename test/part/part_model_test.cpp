#include "bin_scenes/part/part_model.hpp"
#include "part/closed_forms.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

namespace bin_scenes::test {
namespace {

namespace fs = std::filesystem;

/// Each test has an empty cache of its own.
class PartModelTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("bin_scenes_part_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    unsetenv("BIN_SCENES_CACHE");
    before_ = PartModel::work();
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::size_t built() const { return PartModel::work().built - before_.built; }
  std::size_t read() const { return PartModel::work().read - before_.read; }

  std::vector<fs::path> files() const {
    std::vector<fs::path> all;
    if (!fs::exists(folder_ / "bin_scenes")) return all;
    for (const auto& entry : fs::directory_iterator(folder_ / "bin_scenes")) all.push_back(entry.path());
    return all;
  }

  fs::path folder_;
  PartWork before_;
};

FieldOptions coarse_field() {
  FieldOptions options;
  options.cell = 0.04;
  return options;
}
SampleOptions few_samples() {
  SampleOptions options;
  options.count = 100;
  return options;
}

TEST_F(PartModelTest, KnowsTheMeshItWasMadeFrom) {
  const auto part = PartModel::from_mesh(box_mesh(Vec3(0.06, 0.04, 0.02), Vec3(0.1, 0, 0)), "box");
  EXPECT_EQ(part->path(), "box");
  EXPECT_NEAR(part->diagonal(), Vec3(0.06, 0.04, 0.02).norm(), 1e-12);
  EXPECT_NEAR(part->radius(), 0.5 * part->diagonal(), 1e-12);
  EXPECT_NEAR(part->mass().volume, 0.06 * 0.04 * 0.02, 1e-12);
  EXPECT_LT((part->mass().center - Vec3(0.1, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(built(), 0u);  // nothing is made before it is asked for
  EXPECT_TRUE(files().empty());
}

TEST_F(PartModelTest, EveryProxyIsMadeOncePerOptions) {
  const auto part = PartModel::from_mesh(torus_mesh(0.04, 0.012, 24, 10), "torus");
  const DistanceField* field = &part->field(coarse_field());
  EXPECT_EQ(&part->field(coarse_field()), field);
  EXPECT_EQ(built(), 1u);
  FieldOptions other = coarse_field();
  other.cell = 0.05;
  EXPECT_NE(&part->field(other), field);
  EXPECT_EQ(built(), 2u);
  EXPECT_EQ(&part->field(coarse_field()), field);  // still in place
}

TEST_F(PartModelTest, SecondModelReadsTheSameBitsInsteadOfBuilding) {
  const Mesh mesh = torus_mesh(0.04, 0.012, 20, 8);
  HullOptions hull_options;
  hull_options.max_error = 0.05;
  VoxelOptions voxels;
  voxels.voxels = 8;
  const auto first = PartModel::from_mesh(mesh, "a"), second = PartModel::from_mesh(mesh, "b");
  const DistanceField& field = first->field(coarse_field());
  const SampleSet& samples = first->samples(few_samples());
  const SphereSet& spheres = first->spheres(voxels);
  const ConvexHulls& hulls = first->hulls(hull_options);
  EXPECT_EQ(built(), 4u);
  EXPECT_EQ(read(), 0u);

  EXPECT_EQ(second->field(coarse_field()).values, field.values);
  EXPECT_EQ(second->field(coarse_field()).origin, field.origin);
  EXPECT_EQ(second->field(coarse_field()).nodes, field.nodes);
  ASSERT_EQ(second->samples(few_samples()).samples.size(), samples.samples.size());
  for (std::size_t i = 0; i < samples.samples.size(); ++i) {
    EXPECT_EQ(second->samples(few_samples()).samples[i].point, samples.samples[i].point);
    EXPECT_EQ(second->samples(few_samples()).samples[i].normal, samples.samples[i].normal);
    EXPECT_EQ(second->samples(few_samples()).samples[i].spacing, samples.samples[i].spacing);
  }
  ASSERT_EQ(second->spheres(voxels).spheres.size(), spheres.spheres.size());
  EXPECT_EQ(second->spheres(voxels).interior_removed, spheres.interior_removed);
  for (std::size_t i = 0; i < spheres.spheres.size(); ++i) {
    EXPECT_EQ(second->spheres(voxels).spheres[i].center, spheres.spheres[i].center);
    EXPECT_EQ(second->spheres(voxels).spheres[i].normal, spheres.spheres[i].normal);
  }
  ASSERT_EQ(second->hulls(hull_options).hulls.size(), hulls.hulls.size());
  EXPECT_EQ(second->hulls(hull_options).surface_error, hulls.surface_error);
  EXPECT_EQ(second->hulls(hull_options).met, hulls.met);
  for (std::size_t i = 0; i < hulls.hulls.size(); ++i) {
    EXPECT_EQ(second->hulls(hull_options).hulls[i].vertices, hulls.hulls[i].vertices);
    EXPECT_EQ(second->hulls(hull_options).hulls[i].triangles, hulls.hulls[i].triangles);
  }
  EXPECT_EQ(built(), 4u);
  EXPECT_EQ(read(), 4u);
}

TEST_F(PartModelTest, AnotherMeshDoesNotGetTheCachedProxy) {
  PartModel::from_mesh(box_mesh(Vec3::Constant(0.05)), "part")->field(coarse_field());
  PartModel::from_mesh(box_mesh(Vec3::Constant(0.051)), "part")->field(coarse_field());
  EXPECT_EQ(built(), 2u);
}

TEST_F(PartModelTest, DamagedCacheFileIsRebuilt) {
  const Mesh mesh = box_mesh(Vec3::Constant(0.05));
  const std::vector<float> values = PartModel::from_mesh(mesh, "box")->field(coarse_field()).values;
  for (const bool shorten : {false, true}) {
    ASSERT_EQ(files().size(), 1u);
    const fs::path file = files()[0];
    if (shorten) {
      fs::resize_file(file, fs::file_size(file) / 2);
    } else {
      std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
      stream.seekp(static_cast<std::streamoff>(fs::file_size(file)) - 100);
      stream.put('\x55');
    }
    const std::size_t so_far = built();
    EXPECT_EQ(PartModel::from_mesh(mesh, "box")->field(coarse_field()).values, values);
    EXPECT_EQ(built(), so_far + 1);
  }
  EXPECT_EQ(PartModel::from_mesh(mesh, "box")->field(coarse_field()).values, values);
  EXPECT_EQ(read(), 1u);  // repaired
}

TEST_F(PartModelTest, ThreadsShareOneBuild) {
  const auto part = PartModel::from_mesh(torus_mesh(0.04, 0.012, 24, 10), "torus");
  std::vector<const DistanceField*> fields(4);
  std::vector<std::thread> threads;
  for (auto& field : fields) threads.emplace_back([&] { field = &part->field(coarse_field()); });
  for (std::thread& t : threads) t.join();
  for (const DistanceField* field : fields) EXPECT_EQ(field, fields[0]);
  EXPECT_EQ(built(), 1u);
}

TEST_F(PartModelTest, WorksWithoutACache) {
  setenv("BIN_SCENES_CACHE", "off", 1);
  const Mesh mesh = box_mesh(Vec3::Constant(0.05));
  PartModel::from_mesh(mesh, "box")->samples(few_samples());
  PartModel::from_mesh(mesh, "box")->samples(few_samples());
  EXPECT_EQ(built(), 2u);
  EXPECT_TRUE(files().empty());
}

TEST_F(PartModelTest, FileIsLoadedOnceAndThenReadFromTheCache) {
  const fs::path file = folder_ / "tetrahedron.off";
  fs::create_directories(folder_);
  std::ofstream(file) << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  LoadOptions options;
  options.unit = Unit::centimetre;
  {
    const auto part = PartModel::load(file, options);
    EXPECT_NEAR(part->mass().volume, 1e-6 / 6, 1e-15);
    EXPECT_EQ(PartModel::load(file, options), part);  // shared while someone holds it
    EXPECT_EQ(built(), 1u);
  }
  const auto again = PartModel::load(file, options);
  EXPECT_EQ(built(), 1u);
  EXPECT_EQ(read(), 1u);
  EXPECT_NEAR(again->mass().volume, 1e-6 / 6, 1e-15);
  EXPECT_TRUE(again->load_report().closed);
  EXPECT_EQ(again->load_report().unit, Unit::centimetre);
  options.unit = Unit::millimetre;
  EXPECT_NEAR(PartModel::load(file, options)->mass().volume, 1e-9 / 6, 1e-18);
  EXPECT_EQ(built(), 2u);
}

// The smallest error first: a field of a box is exact on faces and rounds edges by less than a third of a cell.
TEST_F(PartModelTest, FieldErrorOfABoxIsTheRoundingOfItsEdges) {
  const auto part = PartModel::from_mesh(box_mesh(Vec3(0.06, 0.05, 0.04)), "box");
  FieldOptions options;
  options.cell = 0.02;
  const ShapeError error = part->field_error(options);
  EXPECT_LT(error.to_mesh_max, 0.35 * 0.02);
  EXPECT_LT(error.from_mesh_max, 0.5 * 0.02);
  EXPECT_GT(error.from_mesh_max, 0.05 * 0.02);
  EXPECT_LT(error.to_mesh_mean, 0.1 * 0.02);
  EXPECT_NEAR(error.volume, 0.0, 0.01);
}

TEST_F(PartModelTest, HullErrorOfAConvexPartIsZero) {
  const ShapeError error = PartModel::from_mesh(prism_mesh(0.02, 0.05, 24), "prism")->hull_error({});
  EXPECT_LT(error.to_mesh_max, 1e-4);
  EXPECT_LT(error.from_mesh_max, 1e-4);
  EXPECT_NEAR(error.volume, 0.0, 1e-6);
}

// Each vertex of a hull is come to from several faces, each time rounded another way.
TEST_F(PartModelTest, HullErrorIsFiniteFarFromTheOrigin) {
  Random random(1, 0, Stream::probe);
  for (int i = 0; i < 50; ++i) {
    const Quat turn = random.orientation();
    Mesh bar = box_mesh(Vec3(1, 0.005, 0.005));
    for (Vec3& v : bar.vertices) v = turn * v + Vec3(50, 30, 7);
    ConvexHulls hulls;
    hulls.hulls = {bar};
    EXPECT_LT(shape_error(hulls, MeshQuery(bar)).to_mesh_max, 1e-12) << i;
  }
}

// One sphere in a cube of side a: its surface is at most a (sqrt(3) - 1) / 2 from the corners, and touches the faces.
TEST_F(PartModelTest, SphereErrorOfOneVoxelInACube) {
  const double a = 0.05, diagonal = a * std::sqrt(3.0);
  VoxelOptions options;
  options.voxels = 1;
  const ShapeError error = PartModel::from_mesh(box_mesh(Vec3::Constant(a)), "cube")->sphere_error(options);
  EXPECT_NEAR(error.from_mesh_max, a * (std::sqrt(3.0) - 1) / 2 / diagonal, 1e-6);
  EXPECT_NEAR(error.volume, M_PI / 6 - 1, 0.005);
  EXPECT_NEAR(error.to_mesh_max, (0.5 - 0.5 / std::sqrt(3.0)) * a / diagonal, 0.003);
}

TEST_F(PartModelTest, MoreVoxelsAreNearerToTheMesh) {
  const auto part = PartModel::from_mesh(sphere_mesh(0.05, 4), "sphere");
  VoxelOptions options;
  options.voxels = 6;
  const ShapeError coarse = part->sphere_error(options);
  options.voxels = 18;
  const ShapeError fine = part->sphere_error(options);
  EXPECT_LT(fine.to_mesh_mean, 0.6 * coarse.to_mesh_mean);
  EXPECT_LT(fine.from_mesh_max, 0.6 * coarse.from_mesh_max);
}

}  // namespace
}  // namespace bin_scenes::test
