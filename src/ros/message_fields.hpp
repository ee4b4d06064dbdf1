/// Access to the fields of a ROS message by their names, so that requests and reports are converted by the tables of
/// their keys. It reads and writes the values of a message, and does not know what they mean.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <regex>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace bin_scenes {

/// Returns the names of the fields of a definition in their order, without those of the types that it contains.
inline std::vector<std::string> field_names(const std::string& definition) {
  static const std::regex field(R"(\s*[\w/]+(\[\d*\])?\s+(\w+)\s*(#.*)?)");
  std::istringstream lines(definition);
  std::vector<std::string> names;
  std::smatch found;
  for (std::string line; std::getline(lines, line) && line.rfind("====", 0) != 0;)
    if (std::regex_match(line, found, field)) names.push_back(found[2]);
  return names;
}

/// Calls a function for each field of a message. It replaces the stream that the serialisers of roscpp write to.
template <class Visit>
struct FieldStream {
  const std::vector<std::string>& names;
  Visit& visit;
  std::size_t at = 0;  ///< index of the next field

  template <class Value>
  void next(Value& value) {
    visit(names.at(at++), value);
  }
};

/// Calls visit(name, value) for each field of a message, which may be const.
template <class Message, class Visit>
void for_each_field(Message& message, Visit& visit) {
  using Plain = std::remove_const_t<Message>;
  static const std::vector<std::string> names = field_names(ros::message_traits::Definition<Plain>::value());
  FieldStream<Visit> stream{names, visit};
  ros::serialization::Serializer<Plain>::template allInOne<FieldStream<Visit>, Message&>(stream, message);
}

}  // namespace bin_scenes
