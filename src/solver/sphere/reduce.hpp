/// The few contacts of a pair that stand for all places where its surfaces are close.
#pragma once

#include "solver/sphere/math.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes::sphere {

/// A place where two surfaces are close. Everything in the frame of `a`.
struct Candidate {
  Vec3f on_a, on_b;  ///< nearest points (m)
  Vec3f normal;      ///< a -> b
  float separation;  ///< m, negative: overlap
  std::uint32_t feature;
  bool known;  ///< a contact of the last step
};

constexpr int max_faces = 4;        ///< directions of normals that are told apart in a pair
constexpr int max_directions = 4;   ///< in which the bodies may tilt on a face
constexpr int enough_contacts = 8;  ///< up to which others are taken too: with fewer, stacks of rings dance
constexpr float like = 0.9f;        ///< cosine between normals of one face: 26 degrees

/// Chooses at most `most` of the candidates, by number:
/// - The deepest stands for a face, the deepest whose normal is unlike its own for another, and so on; a candidate
///   belongs to the face whose normal is most like its own.
/// - Of each face, those that are met first when the bodies tilt on it by `tilt` (rad), to one side after the other: a
///   part that rocks on two teeth must not find the second one late, whatever else of it lies on a wall.
/// - Up to enough_contacts, the one farthest from those chosen, in position and normal alike, deep ones preferred;
///   contacts of the last step have a small advantage, so that the choice does not flicker.
/// Candidates closer together than a thousandth of `size` (m) are one. Their order does not matter. Twin:
/// shaders/sphere/reduce.h.
void reduce(const std::vector<Candidate>& candidates, float size, float tilt, int most, std::vector<int>& chosen);

}  // namespace bin_scenes::sphere
