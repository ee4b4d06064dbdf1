/// The table of the keys of solvers; see scene/keys.hpp. Reading, checking, messages and the generated page use it.
#pragma once

#include "bin_scenes/scene/key.hpp"
#include "bin_scenes/scene/request.hpp"

namespace bin_scenes {

inline Names<SolverType> names(SolverType) {
  return {{"auto", SolverType::automatic}, {"sphere", SolverType::sphere}, {"bullet", SolverType::bullet}};
}
inline Names<SolverSettings::Preset> names(SolverSettings::Preset) {
  return {{"standard", SolverSettings::Preset::standard},
          {"quick", SolverSettings::Preset::quick},
          {"thesis", SolverSettings::Preset::thesis}};
}

inline Names<SphereSettings::Device> names(SphereSettings::Device) {
  return {{"auto", SphereSettings::Device::automatic},
          {"cpu", SphereSettings::Device::cpu},
          {"gpu", SphereSettings::Device::gpu}};
}

template <class Visitor>
void visit(Visitor& v, BulletSettings& s) {
  v.field({"time_step", "s", "larger = faster, but thin parts interlock", above(0.0, 0.1)}, s.time_step);
  v.field(
      {"cut_steps", "",
       "true: steps too long for small or fast parts are shortened; false: such parts may pass through others; only "
       "for measuring long steps"},
      s.cut_steps);
  v.field({"iterations", "",
           "sequential-impulse sweeps a step, two a sub-step, and as many relaxing sweeps; more = stiffer piles, "
           "linear cost",
           at_least(1.0, 10000.0)},
          s.iterations);
  v.field({"margin", "", "collision margin / part diagonal, inside the hulls; smaller = slower, more exact",
           above(0.0, 0.2)},
          s.margin);
  v.field({"sleeping", "", "true: islands at rest cost nothing; false: every part is simulated to the end"},
          s.sleeping);
  v.field({"hull_error", "",
           "largest surface error of the convex decomposition / part diagonal; smaller = more hulls, cost grows with "
           "their square",
           above(0.0, 1.0)},
          s.hull_error);
  v.field(
      {"hull_volume_error", "",
       "largest excess volume of all hulls together / volume of the part; smaller = more hulls; the report has a flag "
       "if max_hulls does not suffice",
       above(0.0, 10.0)},
      s.hull_volume_error);
  v.field(
      {"max_hulls", "", "largest number of hulls per part; takes precedence over both errors", at_least(1.0, 4096.0)},
      s.max_hulls);
}

template <class Visitor>
void visit(Visitor& v, ThesisSettings& s) {
  v.field({"time_step", "s", "larger = faster, but thin parts tunnel", above(0.0, 0.1)}, s.time_step);
  v.field({"sub_steps", "", "whole steps of time_step / sub_steps each; linear cost", at_least(1.0, 1000.0)},
          s.sub_steps);
  v.field({"iterations", "", "impulse and velocity passes a step (5 or 10 in the thesis); higher stacks need more",
           at_least(1.0, 10000.0)},
          s.iterations);
  v.field({"bias", "", "share of the penetration turned into velocity each step; more = stiffer, with jitter",
           at_least(0.0, 1.0)},
          s.bias);
  v.field({"slop", "", "penetration that is tolerated / sphere radius; 0 = contacts flicker", at_least(0.0, 1.0)},
          s.slop);
  v.field(
      {"rest_velocity", "m/s", "approach speed below which restitution is 0; 0 = 2 g time_step", at_least(0.0, 100.0)},
      s.rest_velocity);
  v.field({"voxels", "", "voxels along the part's longest side; spheres grow with its square", at_least(1.0, 512.0)},
          s.voxels);
  v.field({"tightness", "", "voxel pitch / sphere diameter; below 1 = overlapping spheres, smoother surface",
           above(0.0, 1.0)},
          s.tightness);
  v.field(
      {"radii", "",
       "radii of spheres / the part's longest side, largest first, instead of voxels: large spheres fill the inside, "
       "the smallest the surface",
       at_least(0.5 / 512.0, 0.5), !s.radii.empty()},
      s.radii);
  v.field({"modified_normals", "", "face spheres carry the true surface's normal: stable with fewer iterations"},
          s.modified_normals);
  v.field({"grid_size", "", "cells per axis of the collision grid; memory grows with its cube", at_least(1.0, 1024.0)},
          s.grid_size);
  v.field({"cell_size", "", "cell edge / largest sphere diameter, at least 1; larger = more candidates per cell",
           at_least(1.0, 1000.0)},
          s.cell_size);
  v.field({"contacts_per_sphere", "", "initial capacity; enlarged if necessary, with a flag in the report",
           at_least(1.0, 1024.0)},
          s.contacts_per_sphere);
}

template <class Visitor>
void visit(Visitor& v, SphereSettings& s) {
  v.field(
      {"time_step", "s", "one collision detection each; larger = faster, but thin parts interlock", above(0.0, 0.1)},
      s.time_step);
  v.field(
      {"cut_steps", "",
       "true: steps too long for small or fast parts are shortened; false: such parts may pass through others; only "
       "for measuring long steps"},
      s.cut_steps);
  v.field({"step_fall", "",
           "with cut_steps: distance that the smallest part falls from rest in one step at most / its diagonal; more = "
           "longer steps for small parts, which sink in further",
           above(0.0, 1.0)},
          s.step_fall);
  v.field({"sub_steps", "", "contact solves per time step; more = stiffer and less drift, linear cost",
           at_least(1.0, 1000.0)},
          s.sub_steps);
  v.field({"recycle", "",
           "contacts of a pair are reused until it moved so far / diagonal of the smallest part, three times as far "
           "while pouring; more = faster, contacts are less exact",
           above(0.0, 0.1)},
          s.recycle);
  v.field({"coarse_samples", "", "surface samples per part while pouring; thin parts get more", at_least(8.0, 1e6)},
          s.coarse_samples);
  v.field(
      {"fine_samples", "",
       "surface samples per part while settling; thin parts get more; more = less penetration, linear cost; 0 = the "
       "coarse ones",
       at_least(0.0, 1e6)},
      s.fine_samples);
  v.field(
      {"field_cell", "", "cell of the distance field / part diagonal; smaller = more exact, memory grows with its cube",
       above(0.0, 0.25)},
      s.field_cell);
  v.field({"device", "",
           "cpu: plain C++; gpu: OpenGL compute passes, many scenes at once; auto: what needs less time for a standard "
           "heap, "
           "measured once. Scenes repeat bit for bit on the same class of device"},
          s.device);
}

template <class Visitor>
void visit(Visitor& v, SolverSettings& solver) {
  v.field({"type", "", "auto chooses by device, part and count; the report says why"}, solver.type);
  v.field({"preset", "",
           "standard: the default sphere solver; quick: the same with other defaults for pour.finish, "
           "pour.drop_height and solver.sphere, several times as fast, parts overlap by up to 1 %; thesis: the "
           "thesis's method for its tables"},
          solver.preset);
  v.section({"bullet", "", "settings of Bullet"}, solver.bullet);
  v.section({"thesis", "", "settings of the sphere solver's preset thesis"}, solver.thesis);
  v.section({"sphere", "", "settings of the default sphere solver: presets standard and quick"}, solver.sphere);
}

}  // namespace bin_scenes
