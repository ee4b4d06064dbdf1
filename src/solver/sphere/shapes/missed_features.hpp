/// Finds features that protrude between the nodes of a draft, where no node would detect a contact, and adds nodes to
/// the draft there. contact_samples.cpp uses it.
#pragma once

#include "solver/sphere/shapes/sample_draft.hpp"

namespace bin_scenes::sphere {

/// Returns the largest height (m) by which a curved face may rise above a node, within the distance over which the node
/// slides along it.
double bulge(const Cone& cone, double face_spacing);

/// Adds nodes at vertices that protrude between the nodes by more than `most` (m). In a bend whose folds are about as
/// large as the angle that defines an edge, only some folds are edges. The places between these edges count as covered
/// by their nodes, which do not slide, so that no node detected the crown of a handle.
void add_missed_vertices(const Mesh& mesh, double face_spacing, double most, Draft& draft);

/// Adds nodes on long edges of the mesh that protrude between the nodes by more than `most` (m). The strips of which a
/// rounded edge consists are too narrow for nodes of faces and bend too little for sharp edges, and their vertices are
/// at their ends.
void add_missed_ridges(const Mesh& mesh, double face_spacing, double spacing, double most, Draft& draft);

}  // namespace bin_scenes::sphere
