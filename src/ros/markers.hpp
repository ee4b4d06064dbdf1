/// Makes the markers with which RViz shows a scene: the parts, the bin, and the contacts of a recorded heap. The
/// functions return messages and publish nothing.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "frames.hpp"

#include <visualization_msgs/MarkerArray.h>

namespace bin_scenes {

/// Returns a marker that deletes all older ones, then markers of the parts (namespace "parts", marker id = part id; the
/// mesh resource is the model file, scaled to metres), of the bin (namespace "bin": boxes for its walls and floor, or
/// its mesh), and of the table (namespace "table": a box with the edge lengths 4 m, 4 m and 1 mm, whose upper side is
/// that of the table). Each part has its own colour.
visualization_msgs::MarkerArray scene_markers(const Scene& scene, const LoadedRequest& loaded, const Frames& frames,
                                              const ros::Time& stamp);

/// Returns markers of the parts and the bin that follow the TF frames of the parts, for a recording of a heap that
/// moves.
visualization_msgs::MarkerArray following_markers(const LoadedRequest& loaded, const Frames& frames,
                                                  const ros::Time& stamp);

/// Returns contacts as three lists of lines or points. "contact_normals" point to part b; "contact_forces" act on part
/// b and include friction. A force equal to the weight of the lightest part is half the diagonal of this part long; no
/// force is longer than three diagonals. Points have the colour of their action. Normals and forces have a colour for
/// the force on a logarithmic scale, from blue (a tenth of this weight) to red (a hundred times it). Empty lists are
/// deleted.
visualization_msgs::MarkerArray contact_markers(const std::vector<SceneContact>& contacts, const LoadedRequest& loaded,
                                                const Frames& frames, const ros::Time& stamp);

/// Returns the colour of a contact: green at rest, yellow sliding, magenta pushed apart, red impact.
std_msgs::ColorRGBA action_color(ContactAction action);

/// Returns the colour of a part: that of all outputs (scene/palette.hpp).
std_msgs::ColorRGBA part_color(int id);
std_msgs::ColorRGBA bin_color();

/// Returns the URI by which RViz finds a model: package:// as the user wrote it, otherwise file:// with the absolute
/// path, percent-encoded.
std::string resource_uri(const std::string& model, const std::string& path);

}  // namespace bin_scenes
