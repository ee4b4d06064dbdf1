#include "output/output_fixture.hpp"

#include <pcl/io/pcd_io.h>

namespace bin_scenes {
namespace {

using Pcd = OutputTest;

TEST_F(Pcd, PclReadsBackWhatTheImageHolds) {
  const RangeImage image = small_image();
  write_pcd(path("left.pcd"), image);
  pcl::PCLPointCloud2 blob;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version, type;
  unsigned offset;
  ASSERT_EQ(pcl::PCDReader().readHeader(path("left.pcd"), blob, origin, orientation, version, type, offset), 0);
  EXPECT_EQ(type, 1) << "binary";
  ASSERT_EQ(pcl::PCDReader().read(path("left.pcd"), blob, origin, orientation, version), 0);
  EXPECT_EQ(blob.width, 8u);
  EXPECT_EQ(blob.height, 6u);
  const Pose& pose = *image.sensor.pose;
  EXPECT_LT((origin.head<3>().cast<double>() - pose.position).norm(), 1e-6);
  EXPECT_LT(orientation.cast<double>().angularDistance(pose.orientation), 1e-6);
  const char* names[] = {"x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity", "label", "validity"};
  ASSERT_EQ(blob.fields.size(), 9u);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(blob.fields[i].name, names[i]);

  const auto value = [&](std::size_t point, int field) {
    float v;
    std::memcpy(&v, &blob.data[point * blob.point_step + blob.fields[field].offset], 4);
    return v;
  };
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 8; ++column) {
      const std::size_t i = static_cast<std::size_t>(row) * 8 + column;
      const auto point = point_at(image, column, row);
      for (int axis = 0; axis < 3; ++axis) {
        if (std::isnan(image.depth[i])) {
          EXPECT_TRUE(std::isnan(value(i, axis)));
        } else {
          EXPECT_EQ(value(i, axis), point[axis]);
          EXPECT_EQ(value(i, 3 + axis), image.normal[i][axis]);
          EXPECT_EQ(value(i, 6), image.intensity[i]);
        }
      }
      std::uint32_t label;
      std::memcpy(&label, &blob.data[i * blob.point_step + blob.fields[7].offset], 4);
      EXPECT_EQ(label, image.label[i]);
      EXPECT_EQ(blob.data[i * blob.point_step + blob.fields[8].offset], image.validity[i]);
    }
  }
  EXPECT_EQ(entries(), 1u);
}

TEST_F(Pcd, WhatCannotBeWrittenIsAnEnvironmentError) {
  try {
    write_pcd(path("nowhere/left.pcd"), small_image());
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::environment);
  }
}

}  // namespace
}  // namespace bin_scenes
