/// Finds features between the nodes of a draft that protrude, so that no node would detect a contact there.
/// contact_samples.cpp then adds nodes.
#pragma once

#include "solver/sphere/shapes/sample_draft.hpp"

namespace bin_scenes::sphere {

/// Returns the largest height (m) by which a curved face may rise above a node, within the distance over which the node
/// slides along it.
double bulge(const Cone& cone, double face_spacing);

/// Adds the vertices that stick out between the nodes by more than `most` (m). Where the folds of a bend lie about the
/// angle that makes an edge, some of them are edges, and what lies between those counts as covered by their nodes,
/// which do not slide: nothing felt the crown of a handle.
void add_missed_vertices(const Mesh& mesh, double face_spacing, double most, Draft& draft);

/// Adds the long edges of the mesh that stick out between the nodes by more than `most` (m): the strips of which an
/// edge that is rounded is made are too narrow for nodes of faces, bend too little for sharp edges, and their vertices
/// lie at their ends.
void add_missed_ridges(const Mesh& mesh, double face_spacing, double spacing, double most, Draft& draft);

}  // namespace bin_scenes::sphere
