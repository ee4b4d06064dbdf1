/// The table of the images that files and topics hold of a sensor. PNG files, shards and their checks, Python's readers
/// and ROS topics are made from it, so that a new channel is one entry. A program can add channels of its own.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"

#include <functional>
#include <string>
#include <vector>

namespace bin_scenes {

struct ImageChannel {
  std::string name;  ///< <sensor>_<name>.png of the format png; <key>.<name>.png in shards
  /// Returns the counts of an image; Picture::channels is 0 if the image has no such channel.
  std::function<Picture(const RangeImage&)> counts;
  int samples = 1;         ///< values of a pixel; 0: as many as the picture has channels
  bool true_view = false;  ///< whether it has the size of the camera's own view, and not that of the measured images
  bool in_shards = false;  ///< whether shards contain it; every image must have it then
  std::string topic = {};  ///< ROS topic of a sensor; empty: none

  int width(const RangeImage& image) const { return true_view ? image.sensor.width : image.width; }
  int height(const RangeImage& image) const { return true_view ? image.sensor.height : image.height; }
};

/// Returns all channels.
const std::vector<ImageChannel>& image_channels();
/// Returns the channel of that name; null if there is none.
const ImageChannel* find_image_channel(const std::string& name);
/// Adds a channel. A program calls it before it starts its first job. Throws an input Error if a channel of that name
/// exists already.
void register_image_channel(ImageChannel channel);

}  // namespace bin_scenes
