/// Meshes of the stress suite: closed, outward-oriented, as bad as the case wants them.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <string>

namespace bin_scenes::stress {

Mesh box(const Vec3& size, const Vec3& center = Vec3::Zero());
Mesh cube(double edge);
/// Icosahedron, each triangle split into four `splits` times.
Mesh ball(double radius, int splits = 2);
/// Rectangle from `inner` to `outer` radius, `height` high, turned about z in `segments` steps: concave, genus 1.
Mesh ring(double inner, double outer, double height, int segments = 24);
/// L of two plates with edge `length`, thickness `wall`, width `width`: concave.
Mesh angle(double length, double wall, double width);
/// A flat quad of two triangles, without any thickness.
Mesh quad(double width, double depth);
/// A plate with slivers: its top is a fan of `spikes` triangles, thinner than a thousandth of their length.
Mesh sliver_plate(double width, double depth, double height, int spikes);
/// V-shaped trough along x with end plates, `opening` wide and `depth` deep; walls `wall` thick. Floor line at z = 0.
Mesh v_bin(double length, double opening, double depth, double wall);
/// Box-shaped bin whose floor is a grid with square holes of edge `hole` and bars of width `bar`; floor top at z = 0.
Mesh slotted_bin(const Vec3& inner, double hole, double bar, double wall);

/// Writes Wavefront OBJ with enough digits to read the same numbers back. Throws an environment Error.
void write_obj(const Mesh& mesh, const std::string& path);

}  // namespace bin_scenes::stress
