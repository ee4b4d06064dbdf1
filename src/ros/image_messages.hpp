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

/// Organised cloud in the optical frame: fields x y z normal_x normal_y normal_z intensity snr (float32) label
/// (uint32); NaN where nothing was seen (REP 117), hence not dense.
sensor_msgs::PointCloud2 cloud_message(const RangeImage& image, const std_msgs::Header& header);
/// The cloud with an additional field `rgb` (float32 that contains 0x00rrggbb, as PCL and RViz read it): each part has
/// the colour of its marker, and the bin is grey.
sensor_msgs::PointCloud2 colored_cloud_message(const RangeImage& image, const std_msgs::Header& header);
/// 32FC1, metres along the optical axis, NaN where nothing is valid (REP 118). Of a lens that distorts, rectified: each
/// pixel has the depth of the nearest one of the image as taken, moved on its surface.
sensor_msgs::Image depth_message(const RangeImage& image, const std_msgs::Header& header);
/// 16UC1: 0 = background, part id + 1 otherwise; as taken.
sensor_msgs::Image label_message(const RangeImage& image, const std_msgs::Header& header);
/// mono8: codes of scene/validity.hpp; as taken.
sensor_msgs::Image validity_message(const RangeImage& image, const std_msgs::Header& header);
/// mono8: the grey image of a range sensor, which must have been made with it (gray_image.hpp); as taken.
sensor_msgs::Image gray_message(const RangeImage& image, const std_msgs::Header& header);
/// mono8, mono16, rgb8 or rgb16, as taken; none of a sensor that takes no picture.
std::optional<sensor_msgs::Image> picture_message(const RangeImage& image, const std_msgs::Header& header);
/// The same of a channel of the table.
std::optional<sensor_msgs::Image> channel_message(const ImageChannel& channel, const RangeImage& image,
                                                  const std_msgs::Header& header);
/// REP 104: K and D of the images as taken, R = identity, P = [K | 0] of the rectified one. None of a laser_line, whose
/// rows are profiles: no camera model describes them. Throws an input Error unless K has 9 values.
std::optional<sensor_msgs::CameraInfo> camera_info_message(const RangeImage& image, const std_msgs::Header& header);

}  // namespace bin_scenes
