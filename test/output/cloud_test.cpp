#include "output/output_fixture.hpp"

#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

namespace bin_scenes {
namespace {

using Clouds = OutputTest;

const char* const pcd_names[] = {"x",         "y",     "z",        "normal_x",       "normal_y",       "normal_z",
                                 "intensity", "label", "validity", "truth_normal_x", "truth_normal_y", "truth_normal_z",
                                 "snr"};

/// A noisy sensor's image: its normals are no longer the true ones.
RangeImage noisy_image() {
  RangeImage image = small_image();
  image.sensor.model = "structured_light";
  image.normal[7] = {0.6f, 0.0f, -0.8f};  // of what it missed
  image.normal[15] = {std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f};
  return image;
}

/// Every field of every point, by name, as PCL reads it.
void expect_cloud(const pcl::PCLPointCloud2& blob, const RangeImage& image) {
  ASSERT_EQ(blob.width, 8u);
  ASSERT_EQ(blob.height, 6u);
  ASSERT_EQ(blob.fields.size(), 13u);
  const auto positions = points_of(image), normals = normals_of(image, positions);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto& p = positions[i];
    const auto& n = normals[i];
    const auto& t = image.normal[i];
    const float reals[] = {p[0], p[1], p[2], n[0], n[1], n[2],        image.intensity[i],
                           0,    0,    t[0], t[1], t[2], image.snr[i]};
    for (std::size_t f = 0; f < 13; ++f) {
      const pcl::PCLPointField& field = blob.fields[f];
      EXPECT_EQ(field.name, pcd_names[f]);
      const std::uint8_t* at = &blob.data[i * blob.point_step + field.offset];
      if (f == 7) {
        std::uint32_t label;
        std::memcpy(&label, at, sizeof label);
        EXPECT_EQ(label, image.label[i]);
      } else if (f == 8) {
        EXPECT_EQ(*at, image.validity[i]);
      } else {
        EXPECT_EQ(std::memcmp(at, &reals[f], sizeof(float)), 0) << i << " " << field.name;
      }
    }
  }
}

TEST_F(Clouds, PclReadsBackWhatTheImageHolds) {
  const RangeImage image = noisy_image();
  write_pcd(path("left.pcd"), image);
  pcl::PCLPointCloud2 blob;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version, type;
  unsigned offset;
  ASSERT_EQ(pcl::PCDReader().readHeader(path("left.pcd"), blob, origin, orientation, version, type, offset), 0);
  EXPECT_EQ(type, 1) << "binary";
  ASSERT_EQ(pcl::PCDReader().read(path("left.pcd"), blob, origin, orientation, version), 0);
  const Pose& pose = *image.sensor.pose;
  EXPECT_LT((origin.head<3>().cast<double>() - pose.position).norm(), 1e-6);
  EXPECT_LT(orientation.cast<double>().angularDistance(pose.orientation), 1e-6);
  expect_cloud(blob, image);
  EXPECT_EQ(entries(), 1u);
}

TEST_F(Clouds, PclReadsBackThePly) {
  for (const RangeImage& image : {small_image(), noisy_image()}) {
    write_ply(path("left.ply"), image);
    pcl::PCLPointCloud2 blob;
    Eigen::Vector4f origin;
    Eigen::Quaternionf orientation;
    int version;
    ASSERT_EQ(pcl::PLYReader().read(path("left.ply"), blob, origin, orientation, version), 0);
    // As PLY names normals; PCL itself takes nx for normal_x.
    for (pcl::PCLPointField& field : blob.fields)
      for (const char axis : {'x', 'y', 'z'})
        if (field.name == std::string("truth_n") + axis) field.name = std::string("truth_normal_") + axis;
    expect_cloud(blob, image);
  }
}

TEST_F(Clouds, TheTrueNormalsAreThereBesideTheMeasuredOnes) {
  const RangeImage image = noisy_image();
  write_pcd(path("left.pcd"), image);
  pcl::PCLPointCloud2 blob;
  ASSERT_EQ(pcl::PCDReader().read(path("left.pcd"), blob), 0);
  expect_cloud(blob, image);
  const auto normals = normals_of(image, points_of(image));
  EXPECT_GT(std::abs(normals[0][0] - image.normal[0][0]), 0.05f) << "a slope, which the fixture calls level";
}

TEST_F(Clouds, WhatCannotBeWrittenIsAnEnvironmentError) {
  try {
    write_pcd(path("nowhere/left.pcd"), small_image());
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::environment);
  }
}

}  // namespace
}  // namespace bin_scenes
