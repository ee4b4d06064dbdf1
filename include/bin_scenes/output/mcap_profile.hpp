/// Whose players an MCAP file is for.
#pragma once

#include <string>

namespace bin_scenes {

enum class McapProfile { ros1, ros2 };  ///< ros2: of Humble and later

const char* name_of(McapProfile profile);
/// Throws an input Error for a name that is no profile's. `where`: the key or option that holds it.
McapProfile mcap_profile_of(const std::string& name, const std::string& where);
/// Name of the profile of a file; empty if it is no MCAP file.
std::string mcap_profile_in(const std::string& path);

}  // namespace bin_scenes
