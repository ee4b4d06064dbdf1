/// Converts a range image to ROS messages: an organised cloud, depth, labels, validity and camera model, all with one
/// stamp and one frame. It converts only; topics.hpp decides what is published.
#pragma once

#include "bin_scenes/output/image_channel.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>

#include <optional>

namespace bin_scenes {

/// The messages that one sensor publishes for one scene.
struct ImageMessages {
  sensor_msgs::PointCloud2 points;
  sensor_msgs::Image depth;
  std::optional<sensor_msgs::CameraInfo> camera_info;
  sensor_msgs::Image labels;
  sensor_msgs::Image validity;
  std::optional<sensor_msgs::Image> picture;
};

ImageMessages image_messages(const RangeImage& image, const ros::Time& stamp, const std::string& frame_prefix = "");

/// Returns an organised cloud in the optical frame with the fields x y z normal_x normal_y normal_z intensity snr
/// (float32) and label (uint32). Points without a measurement are NaN (REP 117), so that the cloud is not dense.
sensor_msgs::PointCloud2 cloud_message(const RangeImage& image, const std_msgs::Header& header);
/// The cloud with an additional field `rgb` (float32 that contains 0x00rrggbb, as PCL and RViz read it): each part has
/// the colour of its marker, and the bin is grey.
sensor_msgs::PointCloud2 colored_cloud_message(const RangeImage& image, const std_msgs::Header& header);
/// Returns depth along the optical axis (m) as 32FC1; NaN where it is not valid (REP 118). For a lens with distortion,
/// the image is rectified: each pixel has the depth of the nearest measured pixel, extrapolated on its surface.
sensor_msgs::Image depth_message(const RangeImage& image, const std_msgs::Header& header);
/// Returns labels as 16UC1: 0 is the background, otherwise part id + 1. The image is not rectified.
sensor_msgs::Image label_message(const RangeImage& image, const std_msgs::Header& header);
/// Returns the codes of scene/validity.hpp as mono8. The image is not rectified.
sensor_msgs::Image validity_message(const RangeImage& image, const std_msgs::Header& header);
/// Returns the grey image of a range sensor as mono8. `image` must contain it (gray_image.hpp). It is not rectified.
sensor_msgs::Image gray_message(const RangeImage& image, const std_msgs::Header& header);
/// Returns the picture as mono8, mono16, rgb8 or rgb16, not rectified; empty if the sensor takes no picture.
std::optional<sensor_msgs::Image> picture_message(const RangeImage& image, const std_msgs::Header& header);
/// Returns the image of one channel of image_channels(); empty if `image` does not have this channel.
std::optional<sensor_msgs::Image> channel_message(const ImageChannel& channel, const RangeImage& image,
                                                  const std_msgs::Header& header);
/// Returns the camera model of REP 104: K and D of the measured images, R = identity, P = [K | 0] of the rectified
/// image. Empty for laser_line, to which no camera model applies. Throws an input Error unless K has 9 values.
std::optional<sensor_msgs::CameraInfo> camera_info_message(const RangeImage& image, const std_msgs::Header& header);

}  // namespace bin_scenes
