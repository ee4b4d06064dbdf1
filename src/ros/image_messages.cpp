/// Turns a range image into messages; images of lenses that distort are resampled to the pinhole that camera_info
/// states. Fields of the cloud stand in one table.
#include "image_messages.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/gray_image.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "frames.hpp"
#include "markers.hpp"

#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace bin_scenes {

namespace {

/// One point as it lies in the cloud's data.
struct Point {
  float x, y, z, normal_x, normal_y, normal_z, intensity, snr;
  std::uint32_t label;
};
static_assert(sizeof(Point) == 36);

sensor_msgs::PointField field(const char* name, std::size_t offset, std::uint8_t type) {
  sensor_msgs::PointField f;
  f.name = name;
  f.offset = static_cast<std::uint32_t>(offset);
  f.datatype = type;
  f.count = 1;
  return f;
}

template <class Pixel>
sensor_msgs::Image plane(const std::vector<Pixel>& pixels, int width, int height, const std::string& encoding,
                         const std_msgs::Header& header) {
  sensor_msgs::Image message;
  message.header = header;
  message.width = static_cast<std::uint32_t>(width);
  message.height = static_cast<std::uint32_t>(height);
  message.encoding = encoding;
  message.is_bigendian = false;
  message.step = static_cast<std::uint32_t>(message.width * sizeof(Pixel));
  BIN_SCENES_ASSERT(pixels.empty() || pixels.size() % (std::size_t{message.width} * message.height) == 0);
  message.data.resize(pixels.size() * sizeof(Pixel));
  if (!pixels.empty()) std::memcpy(message.data.data(), pixels.data(), message.data.size());
  return message;
}

/// Whether pixels of what was measured are pixels of the camera; rows of a laser line's image are profiles.
bool of_camera(const RangeImage& image) {
  return image.width == image.sensor.width && image.height == image.sensor.height && image.points.empty();
}

/// Of each pixel of the camera without distortion the nearest one that was taken, as its index; none outside of what
/// the lens sees.
std::vector<std::optional<std::size_t>> nearest_taken(const RangeImage& image) {
  const Lens taken = lens_of(image.sensor);
  Lens pinhole = taken;
  pinhole.distortion = {};
  std::vector<std::optional<std::size_t>> nearest(static_cast<std::size_t>(image.width) * image.height);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const auto pixel = taken.project(pinhole.ray(column, row));
      if (!pixel || !taken.inside(*pixel)) continue;
      const auto x = static_cast<std::size_t>(std::clamp(std::lround(pixel->x()), 0l, image.width - 1l));
      const auto y = static_cast<std::size_t>(std::clamp(std::lround(pixel->y()), 0l, image.height - 1l));
      nearest[static_cast<std::size_t>(row) * image.width + column] = y * image.width + x;
    }
  }
  return nearest;
}

bool needs_rectifying(const RangeImage& image) {
  return of_camera(image) && lens_of(image.sensor).distorts();
}

/// Pixels as a camera without distortion would have them, of the same places as rectified_depth().
template <class Pixel>
std::vector<Pixel> rectified(const std::vector<Pixel>& pixels, Pixel outside, const RangeImage& image) {
  if (!needs_rectifying(image)) return pixels;
  std::vector<Pixel> moved(pixels.size(), outside);
  const auto nearest = nearest_taken(image);
  for (std::size_t i = 0; i < moved.size(); ++i)
    if (nearest[i]) moved[i] = pixels[*nearest[i]];
  return moved;
}

/// Likewise depth: that of the nearest pixel, moved on its surface to the new ray.
std::vector<float> rectified_depth(const RangeImage& image) {
  if (!needs_rectifying(image)) return image.depth;
  Lens pinhole = lens_of(image.sensor);
  pinhole.distortion = {};
  const std::vector<std::array<float, 3>> points = points_of(image);
  const auto nearest = nearest_taken(image);
  std::vector<float> depth(image.depth.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!nearest[i]) continue;
    const auto &n = image.normal[*nearest[i]], &p = points[*nearest[i]];
    const Vec3 normal(n[0], n[1], n[2]);
    const Vec3 ray = pinhole.ray(static_cast<int>(i) % image.width, static_cast<int>(i) / image.width);
    const double z = normal.dot(Vec3(p[0], p[1], p[2])) / normal.dot(ray);
    const float seen = image.depth[*nearest[i]];
    // Of a face seen edge on the plane leads anywhere.
    depth[i] = std::abs(z - seen) < 0.1 * seen ? static_cast<float>(z) : seen;
  }
  return depth;
}

}  // namespace

sensor_msgs::PointCloud2 cloud_message(const RangeImage& image, const std_msgs::Header& header) {
  using Field = sensor_msgs::PointField;
  sensor_msgs::PointCloud2 message;
  message.header = header;
  message.width = static_cast<std::uint32_t>(image.width);
  message.height = static_cast<std::uint32_t>(image.height);
  message.fields = {field("x", offsetof(Point, x), Field::FLOAT32),
                    field("y", offsetof(Point, y), Field::FLOAT32),
                    field("z", offsetof(Point, z), Field::FLOAT32),
                    field("normal_x", offsetof(Point, normal_x), Field::FLOAT32),
                    field("normal_y", offsetof(Point, normal_y), Field::FLOAT32),
                    field("normal_z", offsetof(Point, normal_z), Field::FLOAT32),
                    field("intensity", offsetof(Point, intensity), Field::FLOAT32),
                    field("snr", offsetof(Point, snr), Field::FLOAT32),
                    field("label", offsetof(Point, label), Field::UINT32)};
  message.is_bigendian = false;
  message.is_dense = false;
  message.point_step = sizeof(Point);
  message.row_step = message.point_step * message.width;
  message.data.resize(std::size_t(message.row_step) * message.height);
  std::uint8_t* out = message.data.data();
  const std::vector<std::array<float, 3>> points = points_of(image), normals = normals_of(image, points);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const std::size_t pixel = std::size_t(row) * image.width + column;
      const auto& p = points[pixel];
      const auto& n = normals[pixel];
      const Point point = {
          p[0], p[1], p[2], n[0], n[1], n[2], image.intensity[pixel], image.snr[pixel], image.label[pixel]};
      std::memcpy(out, &point, sizeof point);
      out += sizeof point;
    }
  }
  return message;
}

sensor_msgs::PointCloud2 colored_cloud_message(const RangeImage& image, const std_msgs::Header& header) {
  sensor_msgs::PointCloud2 plain = cloud_message(image, header), message = plain;
  message.fields.push_back(field("rgb", plain.point_step, sensor_msgs::PointField::FLOAT32));
  message.point_step += sizeof(std::uint32_t);
  message.row_step = message.point_step * message.width;
  message.data.resize(std::size_t(message.row_step) * message.height);
  const auto byte = [](float share) { return static_cast<std::uint32_t>(std::lround(255.0f * share)); };
  for (std::size_t pixel = 0; pixel < image.label.size(); ++pixel) {
    const std_msgs::ColorRGBA color = image.label[pixel] > 0 ? part_color(image.label[pixel] - 1) : bin_color();
    const std::uint32_t rgb = byte(color.r) << 16 | byte(color.g) << 8 | byte(color.b);
    std::uint8_t* out = message.data.data() + pixel * message.point_step;
    std::memcpy(out, plain.data.data() + pixel * plain.point_step, plain.point_step);
    std::memcpy(out + plain.point_step, &rgb, sizeof rgb);
  }
  return message;
}

sensor_msgs::Image depth_message(const RangeImage& image, const std_msgs::Header& header) {
  return plane(rectified_depth(image), image.width, image.height, sensor_msgs::image_encodings::TYPE_32FC1, header);
}

sensor_msgs::Image label_message(const RangeImage& image, const std_msgs::Header& header) {
  return plane(rectified(image.label, std::uint16_t{0}, image), image.width, image.height,
               sensor_msgs::image_encodings::TYPE_16UC1, header);
}

sensor_msgs::Image validity_message(const RangeImage& image, const std_msgs::Header& header) {
  const auto outside = static_cast<std::uint8_t>(Validity::nothing);
  return plane(rectified(image.validity, outside, image), image.width, image.height,
               sensor_msgs::image_encodings::MONO8, header);
}

sensor_msgs::Image gray_message(const RangeImage& image, const std_msgs::Header& header) {
  return plane(rectified(gray_of(image), std::uint8_t{0}, image), image.width, image.height,
               sensor_msgs::image_encodings::MONO8, header);
}

namespace {

std::optional<sensor_msgs::Image> message_of(const Picture& picture, int width, int height,
                                             const std_msgs::Header& header) {
  if (picture.channels == 0) return std::nullopt;
  const std::string encoding = (picture.channels == 3 ? "rgb" : "mono") + std::to_string(picture.bits);
  sensor_msgs::Image message;
  if (picture.bits == 16) {
    message = plane(picture.counts, width, height, encoding, header);
  } else {
    message =
        plane(std::vector<std::uint8_t>(picture.counts.begin(), picture.counts.end()), width, height, encoding, header);
  }
  message.step *= static_cast<std::uint32_t>(picture.channels);
  return message;
}

}  // namespace

std::optional<sensor_msgs::Image> picture_message(const RangeImage& image, const std_msgs::Header& header) {
  return message_of(image.picture, image.width, image.height, header);
}

std::optional<sensor_msgs::Image> channel_message(const ImageChannel& channel, const RangeImage& image,
                                                  const std_msgs::Header& header) {
  return message_of(channel.counts(image), channel.width(image), channel.height(image), header);
}

std::optional<sensor_msgs::CameraInfo> camera_info_message(const RangeImage& image, const std_msgs::Header& header) {
  if (!of_camera(image)) return std::nullopt;
  const Sensor& sensor = image.sensor;
  if (sensor.k.size() != 9) {
    throw input_error("the intrinsic matrix has " + std::to_string(sensor.k.size()) + " values",
                      "sensor " + sensor.name, "give the nine of a 3x3 matrix, or leave K out");
  }
  sensor_msgs::CameraInfo message;
  message.header = header;
  message.width = static_cast<std::uint32_t>(sensor.width);
  message.height = static_cast<std::uint32_t>(sensor.height);
  message.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  message.D.assign(sensor.distortion.begin(), sensor.distortion.end());
  for (std::size_t i = 0; i < 9; ++i) {
    message.K[i] = sensor.k[i];
    message.R[i] = i % 4 == 0 ? 1.0 : 0.0;
    message.P[i / 3 * 4 + i % 3] = sensor.k[i];
  }
  return message;
}

ImageMessages image_messages(const RangeImage& image, const ros::Time& stamp, const std::string& frame_prefix) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = sensor_frame(image.sensor.name, frame_prefix);
  return {cloud_message(image, header), depth_message(image, header),    camera_info_message(image, header),
          label_message(image, header), validity_message(image, header), picture_message(image, header)};
}

}  // namespace bin_scenes
