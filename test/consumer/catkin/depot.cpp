// A scene of the library as a message of the package, both in one file.
#include <bin_scenes/config/request_reader.hpp>
#include <bin_scenes/messages.hpp>

#include <cstdio>

int main(int, char** argv) {
  const bin_scenes::Request request =
      bin_scenes::read_request_text("{parts: [{model: nut_hex.stl, unit: mm, count: 50}]}", argv[1]);
  bin_scenes_msgs::Scene message;
  message.parts.resize(request.part_count());
  std::printf("%zu parts in a %s\n", message.parts.size(),
              ros::message_traits::DataType<bin_scenes_msgs::Scene>::value());
}
