/// Converts messages of ROS 1 to the form in which ROS 2 sends and describes them: the encoding CDR, which aligns
/// values to their size, and definitions with the names of ROS 2 (Humble and later).
///
/// A definition of ROS 2 has the same fields in the same order as that of ROS 1, with three exceptions: a Header has no
/// `seq`, names of fields are in lower case, and a Marker may have a texture and the file of its mesh.
#pragma once

#include <fastcdr/Cdr.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>
#include <boost/array.hpp>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace bin_scenes {

/// The target to which the serialisers that ROS 1 generates write one field after another.
class CdrStream {
 public:
  explicit CdrStream(eprosima::fastcdr::Cdr& cdr) : cdr_(cdr) {}

  template <class Field>
  void next(const Field& field) {
    if constexpr (std::is_arithmetic_v<Field>) {
      cdr_.serialize(field);
    } else {
      ros::serialization::Serializer<Field>::template allInOne<CdrStream, const Field&>(*this, field);
    }
  }
  void next(const std::string& text) { cdr_.serialize(text); }
  void next(const ros::Time& time);
  void next(const ros::Duration& duration);
  void next(const std_msgs::Header& header);
  void next(const visualization_msgs::Marker& marker);
  template <class Element, class Allocator>
  void next(const std::vector<Element, Allocator>& elements) {
    next(static_cast<std::uint32_t>(elements.size()));
    each(elements);
  }
  template <class Element, std::size_t size>
  void next(const boost::array<Element, size>& elements) {
    each(elements);
  }

 private:
  template <class Elements>
  void each(const Elements& elements) {
    if constexpr (std::is_arithmetic_v<typename Elements::value_type>) {
      cdr_.serializeArray(elements.data(), elements.size());
    } else {
      for (const auto& element : elements) next(element);
    }
  }

  eprosima::fastcdr::Cdr& cdr_;
};

template <class Message>
std::vector<char> cdr_bytes(const Message& message) {
  eprosima::fastcdr::FastBuffer buffer;
  buffer.reserve(ros::serialization::serializationLength(message) + 4096);  // room for padding; it grows if need be
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS, eprosima::fastcdr::Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  CdrStream(cdr).next(message);
  return {buffer.getBuffer(), buffer.getBuffer() + cdr.getSerializedDataLength()};
}

/// Returns the ROS 2 name of a message type: "sensor_msgs/Image" becomes "sensor_msgs/msg/Image".
std::string ros2_type(const std::string& type);
/// Converts the full definition of a ROS 1 message, including the types of its fields, to that of ROS 2.
std::string ros2_definition(const std::string& type, const std::string& definition);

}  // namespace bin_scenes
