/// Makes the markers with which RViz shows a scene: the parts, the bin, and the contacts of a recorded heap. The
/// functions return messages and publish nothing.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "frames.hpp"

#include <visualization_msgs/MarkerArray.h>

namespace bin_scenes {

/// A deletion of everything older, then the parts (namespace "parts", marker id = part id, the model file as mesh
/// resource scaled to metres, one colour each) and the bin (namespace "bin": its walls and floor as boxes, or its
/// mesh).
visualization_msgs::MarkerArray scene_markers(const Scene& scene, const LoadedRequest& loaded, const Frames& frames,
                                              const ros::Time& stamp);

/// Returns markers of the parts and the bin that follow the TF frames of the parts, for a recording of a heap that
/// moves.
visualization_msgs::MarkerArray following_markers(const LoadedRequest& loaded, const Frames& frames,
                                                  const ros::Time& stamp);

/// Contacts as three lists: "contact_points", "contact_normals" (from the point towards part b) and "contact_forces"
/// (on part b, friction included; the weight of the lightest part is drawn as long as half its diagonal, and no force
/// longer than three diagonals). Points have the colour of their action. Normals and forces have the colour of the
/// load: blue up to a tenth of that weight, red from a hundred times that weight on, on a logarithmic scale. Lists
/// without contacts are deleted.
visualization_msgs::MarkerArray contact_markers(const std::vector<SceneContact>& contacts, const LoadedRequest& loaded,
                                                const Frames& frames, const ros::Time& stamp);

/// Colour of what a contact does: green resting, yellow sliding, magenta pushed apart, red impact.
std_msgs::ColorRGBA action_color(ContactAction action);

/// Neighbouring ids get hues far apart: steps of the golden ratio round the colour circle.
std_msgs::ColorRGBA part_color(int id);
std_msgs::ColorRGBA bin_color();

/// Returns the URI by which RViz finds a model: package:// as the user wrote it, otherwise file:// with the absolute
/// path, percent-encoded.
std::string resource_uri(const std::string& model, const std::string& path);

}  // namespace bin_scenes
