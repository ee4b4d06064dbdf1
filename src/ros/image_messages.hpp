/// Range image -> organised cloud, depth, labels and camera model, all of one stamp and one frame.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>

namespace bin_scenes {

/// What one sensor publishes of one scene.
struct ImageMessages {
  sensor_msgs::PointCloud2 points;
  sensor_msgs::Image depth;
  sensor_msgs::CameraInfo camera_info;
  sensor_msgs::Image labels;
};

ImageMessages image_messages(const RangeImage& image, const ros::Time& stamp);

/// Organised cloud in the optical frame: fields x y z normal_x normal_y normal_z intensity (float32) label (uint32);
/// NaN where nothing was seen (REP 117), hence not dense.
sensor_msgs::PointCloud2 cloud_message(const RangeImage& image, const std_msgs::Header& header);
/// 32FC1, metres along the optical axis, NaN where nothing was seen (REP 118).
sensor_msgs::Image depth_message(const RangeImage& image, const std_msgs::Header& header);
/// 16UC1: 0 = background, part id + 1 otherwise.
sensor_msgs::Image label_message(const RangeImage& image, const std_msgs::Header& header);
/// Ideal pinhole (REP 104): no distortion, R = identity, P = [K | 0]. Throws an input Error unless K has 9 values.
sensor_msgs::CameraInfo camera_info_message(const Sensor& sensor, const std_msgs::Header& header);

}  // namespace bin_scenes
