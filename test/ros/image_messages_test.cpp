#include "image_messages.hpp"
#include "markers.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/raster/lens.hpp"
#include "scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace bin_scenes {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
const ros::Time stamp(12, 34);

/// 4 x 3 pixels, every value its own; pixel (2, 1) saw nothing, pixel (0, 0) saw the bin.
RangeImage some_image() {
  RangeImage image;
  image.sensor = testing::some_sensor("camera", 0.0);
  image.width = 4;
  image.height = 3;
  for (int i = 0; i < 12; ++i) {
    image.depth.push_back(0.5f + 0.01f * i);
    image.label.push_back(static_cast<std::uint16_t>(i * 5000));
    image.normal.push_back({0.01f * i, 0.02f * i, -1.0f});
    image.intensity.push_back(0.05f * i);
    image.snr.push_back(3.0f * i);
    image.validity.push_back(static_cast<std::uint8_t>(i % 9));
  }
  image.depth[6] = nan;
  image.label[6] = 0;
  image.normal[6] = {nan, nan, nan};
  image.intensity[6] = 0.0f;
  return image;
}

float float_at(const sensor_msgs::PointCloud2& cloud, int column, int row, const std::string& field) {
  for (const auto& f : cloud.fields) {
    if (f.name != field) continue;
    EXPECT_EQ(f.datatype, sensor_msgs::PointField::FLOAT32);
    float value;
    std::memcpy(&value, &cloud.data[row * cloud.row_step + column * cloud.point_step + f.offset], sizeof value);
    return value;
  }
  ADD_FAILURE() << "no field " << field;
  return 0;
}

std::uint32_t label_at(const sensor_msgs::PointCloud2& cloud, int column, int row) {
  const auto& f = cloud.fields.back();
  EXPECT_EQ(f.name, "label");
  EXPECT_EQ(f.datatype, sensor_msgs::PointField::UINT32);
  std::uint32_t value;
  std::memcpy(&value, &cloud.data[row * cloud.row_step + column * cloud.point_step + f.offset], sizeof value);
  return value;
}

TEST(ImageMessages, AnImageOfProfilesHasNoCameraInfo) {
  RangeImage image = some_image();
  image.sensor.width = 8, image.sensor.height = 6;
  image.sensor.model = "laser_line";
  for (std::size_t i = 0; i < image.depth.size(); ++i)
    image.points.push_back({0.01f * static_cast<float>(i % 4), 0.01f * static_cast<float>(i / 4), image.depth[i]});
  const ImageMessages messages = image_messages(image, stamp);
  EXPECT_FALSE(messages.camera_info) << "no pinhole made these rows";
  EXPECT_EQ(messages.depth.width, 4u);
  EXPECT_EQ(image_messages(some_image(), stamp).camera_info->width, some_image().sensor.width);
}

TEST(ImageMessages, CloudIsOrganised) {
  const auto cloud = image_messages(some_image(), stamp).points;
  EXPECT_EQ(cloud.width, 4u);
  EXPECT_EQ(cloud.height, 3u);
  EXPECT_EQ(cloud.row_step, cloud.width * cloud.point_step);
  EXPECT_EQ(cloud.data.size(), std::size_t(cloud.row_step) * cloud.height);
  EXPECT_FALSE(cloud.is_dense);
  EXPECT_FALSE(cloud.is_bigendian);
  std::string names;
  for (const auto& f : cloud.fields) names += f.name + " ";
  EXPECT_EQ(names, "x y z normal_x normal_y normal_z intensity snr label ");
}

TEST(ImageMessages, ColoredCloudHasTheColoursOfTheMarkers) {
  const RangeImage image = some_image();
  const auto plain = image_messages(image, stamp).points, cloud = colored_cloud_message(image, plain.header);
  ASSERT_EQ(cloud.fields.size(), plain.fields.size() + 1);
  EXPECT_EQ(cloud.fields.back().name, "rgb");
  EXPECT_EQ(cloud.data.size(), std::size_t(cloud.row_step) * cloud.height);
  for (const int i : {0, 1, 11}) {  // the bin, and two parts
    EXPECT_EQ(float_at(cloud, i % 4, i / 4, "z"), image.depth[i]);
    const float value = float_at(cloud, i % 4, i / 4, "rgb");
    std::uint32_t rgb;
    std::memcpy(&rgb, &value, sizeof rgb);
    const auto color = image.label[i] > 0 ? part_color(image.label[i] - 1) : bin_color();
    EXPECT_EQ(rgb >> 16, static_cast<std::uint32_t>(std::lround(255.0f * color.r)));
    EXPECT_EQ(rgb & 255, static_cast<std::uint32_t>(std::lround(255.0f * color.b)));
  }
}

TEST(ImageMessages, CloudPointsLieOnTheRaysOfTheirPixels) {
  const RangeImage image = some_image();
  const auto cloud = image_messages(image, stamp).points;
  const auto& k = image.sensor.k;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      const int i = row * 4 + column;
      if (i == 6) continue;
      const float z = image.depth[i];
      EXPECT_FLOAT_EQ(float_at(cloud, column, row, "z"), z);
      // The pinhole model, with pixel centres at whole coordinates.
      EXPECT_NEAR(float_at(cloud, column, row, "x"), (column - k[2]) / k[0] * z, 1e-6);
      EXPECT_NEAR(float_at(cloud, column, row, "y"), (row - k[5]) / k[4] * z, 1e-6);
      EXPECT_EQ(float_at(cloud, column, row, "normal_x"), image.normal[i][0]);
      EXPECT_EQ(float_at(cloud, column, row, "normal_y"), image.normal[i][1]);
      EXPECT_EQ(float_at(cloud, column, row, "normal_z"), image.normal[i][2]);
      EXPECT_EQ(float_at(cloud, column, row, "intensity"), image.intensity[i]);
      EXPECT_EQ(float_at(cloud, column, row, "snr"), image.snr[i]);
      EXPECT_EQ(label_at(cloud, column, row), image.label[i]);
    }
  }
}

TEST(ImageMessages, WhatSawNothingIsNanEverywhere) {
  const auto messages = image_messages(some_image(), stamp);
  for (const char* field : {"x", "y", "z", "normal_x", "normal_y", "normal_z"}) {
    EXPECT_TRUE(std::isnan(float_at(messages.points, 2, 1, field))) << field;
  }
  EXPECT_EQ(label_at(messages.points, 2, 1), 0u);
  float depth;
  std::memcpy(&depth, &messages.depth.data[messages.depth.step + 2 * sizeof depth], sizeof depth);
  EXPECT_TRUE(std::isnan(depth));
}

TEST(ImageMessages, DepthAndLabelsKeepTheirPixels) {
  const RangeImage image = some_image();
  const auto messages = image_messages(image, stamp);
  EXPECT_EQ(messages.depth.encoding, "32FC1");
  EXPECT_EQ(messages.depth.step, 16u);
  EXPECT_EQ(messages.labels.encoding, "16UC1");
  EXPECT_EQ(messages.labels.step, 8u);
  ASSERT_EQ(messages.depth.data.size(), 48u);
  ASSERT_EQ(messages.labels.data.size(), 24u);
  EXPECT_EQ(std::memcmp(messages.depth.data.data(), image.depth.data(), 48), 0);
  EXPECT_EQ(std::memcmp(messages.labels.data.data(), image.label.data(), 24), 0);
  EXPECT_EQ(messages.validity.encoding, "mono8");
  EXPECT_EQ(messages.validity.data, image.validity);
}

TEST(ImageMessages, RectifiedImagesAreOfTheSameSurface) {
  // Two tilted planes that meet in a step of 50 mm, seen through a lens that distorts; each has a label and a code.
  RangeImage image;
  image.sensor = testing::some_sensor("camera", 0.0);
  Lens lens = Lens::from_fov(image.width = 160, image.height = 120, 1.0);
  image.sensor.width = image.width, image.sensor.height = image.height;
  image.sensor.k = {lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1};
  lens.distortion = image.sensor.distortion = {0.15, 0.05, 0.001, -0.002, 0.0};
  const Vec3 normal = Vec3(0.5, -0.3, -1.0).normalized();
  const auto depth = [&](bool left, const Vec3& ray) { return (left ? -0.75 : -0.70) / normal.dot(ray); };
  for (int i = 0; i < image.width * image.height; ++i) {
    const bool left = i % image.width < 30;  // far from the middle, where nothing is moved
    image.depth.push_back(static_cast<float>(depth(left, lens.ray(i % image.width, i / image.width))));
    image.normal.push_back({float(normal.x()), float(normal.y()), float(normal.z())});
    image.label.push_back(left ? 1 : 2);
    image.validity.push_back(left ? 0 : 6);
  }
  const sensor_msgs::Image message = depth_message(image, {});
  const sensor_msgs::Image labels = label_message(image, {}), validity = validity_message(image, {});
  lens.distortion = {};
  int compared = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    float z;
    std::uint16_t label;
    std::memcpy(&z, &message.data[i * sizeof z], sizeof z);
    std::memcpy(&label, &labels.data[i * sizeof label], sizeof label);
    if (std::isnan(z)) {  // where the lens sees nothing
      ASSERT_EQ(label, 0) << i;
      ASSERT_EQ(validity.data[i], 1) << i;
      continue;
    }
    const Vec3 ray = lens.ray(static_cast<int>(i) % image.width, static_cast<int>(i) / image.width);
    const double off_left = std::abs(z - depth(true, ray)), off_right = std::abs(z - depth(false, ray));
    ASSERT_LT(std::min(off_left, off_right), 1e-6) << i;  // on one of the planes, never between them
    ASSERT_EQ(label, off_left < off_right ? 1 : 2) << i;
    ASSERT_EQ(validity.data[i], off_left < off_right ? 0 : 6) << i;
    ++compared;
  }
  EXPECT_GT(compared, 15000);
}

TEST(ImageMessages, APictureKeepsItsCounts) {
  RangeImage image = some_image();
  EXPECT_FALSE(image_messages(image, stamp).picture);
  image.picture.channels = 1, image.picture.bits = 16;
  for (int i = 0; i < 12; ++i) image.picture.counts.push_back(static_cast<std::uint16_t>(i * 5000));
  const sensor_msgs::Image grey = *image_messages(image, stamp).picture;
  EXPECT_EQ(grey.encoding, "mono16");
  EXPECT_EQ(grey.step, 8u);
  ASSERT_EQ(grey.data.size(), 24u);
  EXPECT_EQ(std::memcmp(grey.data.data(), image.picture.counts.data(), 24), 0);
  image.picture = {3, 8, {}};
  for (int i = 0; i < 36; ++i) image.picture.counts.push_back(static_cast<std::uint16_t>(7 * i));
  const sensor_msgs::Image colour = *image_messages(image, stamp).picture;
  EXPECT_EQ(colour.encoding, "rgb8");
  EXPECT_EQ(colour.step, 12u);
  ASSERT_EQ(colour.data.size(), 36u);
  for (std::size_t i = 0; i < 36; ++i) EXPECT_EQ(colour.data[i], image.picture.counts[i]);
}

TEST(ImageMessages, AGreyImageKeepsItsLevels) {
  RangeImage image = some_image();
  for (int i = 0; i < 12; ++i) image.gray.push_back(static_cast<std::uint8_t>(20 * i));
  std_msgs::Header header;
  header.frame_id = "there";
  const sensor_msgs::Image message = gray_message(image, header);
  EXPECT_EQ(message.header.frame_id, "there");
  EXPECT_EQ(message.encoding, "mono8");
  EXPECT_EQ(message.step, 4u);
  EXPECT_EQ(message.data, image.gray);
}

TEST(ImageMessages, AChannelOfTheTableIsAMessageOfItsCounts) {
  const RangeImage image = some_image();
  std_msgs::Header header;
  header.frame_id = "there";
  const auto snr = channel_message(*find_image_channel("snr"), image, header);
  ASSERT_TRUE(snr);
  EXPECT_EQ(snr->header.frame_id, "there");
  EXPECT_EQ(snr->encoding, "mono16");
  std::uint16_t tenths = 0;
  std::memcpy(&tenths, &snr->data[2 * 5], sizeof tenths);
  EXPECT_EQ(tenths, 150);
  EXPECT_FALSE(channel_message(*find_image_channel("image"), image, header)) << "a range sensor takes no picture";
}

TEST(ImageMessages, OneStampOneFrame) {
  const auto m = image_messages(some_image(), stamp);
  for (const std_msgs::Header* header :
       {&m.points.header, &m.depth.header, &m.camera_info->header, &m.labels.header, &m.validity.header}) {
    EXPECT_EQ(header->stamp, stamp);
    EXPECT_EQ(header->frame_id, "camera_optical_frame");
  }
}

TEST(ImageMessages, CameraInfoIsAnIdealPinhole) {
  const auto info = *image_messages(some_image(), stamp).camera_info;
  EXPECT_EQ(info.width, 4u);
  EXPECT_EQ(info.height, 3u);
  EXPECT_EQ(info.distortion_model, "plumb_bob");
  EXPECT_EQ(info.D, std::vector<double>(5, 0.0));
  const boost::array<double, 9> k = {{5, 0, 1.5, 0, 5, 1, 0, 0, 1}}, r = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const boost::array<double, 12> p = {{5, 0, 1.5, 0, 0, 5, 1, 0, 0, 0, 1, 0}};
  EXPECT_EQ(info.K, k);
  EXPECT_EQ(info.R, r);
  EXPECT_EQ(info.P, p);
}

TEST(ImageMessages, AnIncompleteMatrixIsRefused) {
  RangeImage image = some_image();
  image.sensor.k.pop_back();
  EXPECT_THROW(image_messages(image, stamp), Error);
}

}  // namespace
}  // namespace bin_scenes
