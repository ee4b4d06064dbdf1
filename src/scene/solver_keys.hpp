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
  v.field(
      {"time_step", "s", "Length of a time step. Longer steps are faster, but thin parts may penetrate and interlock.",
       above(0.0, 0.1)},
      s.time_step);
  v.field({"cut_steps", "",
           "If true, time steps that are too long for small or fast parts are shortened. If false, such parts may pass "
           "through others; use this only to measure the effect of long steps."},
          s.cut_steps);
  v.field({"iterations", "",
           "Number of sequential-impulse sweeps in a time step, two for each sub-step; as many relaxation sweeps "
           "follow. More sweeps make stacks stiffer, and the computing time grows linearly.",
           at_least(1.0, 10000.0)},
          s.iterations);
  v.field({"margin", "",
           "Collision margin, which is inside the hulls, divided by the diagonal of the part's bounding box. Smaller "
           "margins are slower and more exact.",
           above(0.0, 0.2)},
          s.margin);
  v.field({"sleeping", "",
           "If true, islands of parts at rest are not simulated and take no time. If false, every part is simulated "
           "until the end."},
          s.sleeping);
  v.field(
      {"hull_error", "",
       "Largest allowed surface error of the convex decomposition of a part, divided by the diagonal of its bounding "
       "box. A smaller error needs more hulls, and the computing time grows with the square of their number.",
       above(0.0, 1.0)},
      s.hull_error);
  v.field({"hull_volume_error", "",
           "Largest allowed excess volume of all hulls of a part together, divided by the volume of the part. A "
           "smaller error needs more hulls. If `max_hulls` hulls do not suffice, the report has a flag.",
           above(0.0, 10.0)},
          s.hull_volume_error);
  v.field({"max_hulls", "",
           "Largest number of hulls of a part. This limit has precedence over `hull_error` and `hull_volume_error`.",
           at_least(1.0, 4096.0)},
          s.max_hulls);
}

template <class Visitor>
void visit(Visitor& v, ThesisSettings& s) {
  v.field(
      {"time_step", "s", "Length of a time step. Longer steps are faster, but thin parts may pass through each other.",
       above(0.0, 0.1)},
      s.time_step);
  v.field({"sub_steps", "",
           "Number of sub-steps in a time step. Each is a whole step of the length `time_step` / `sub_steps`, so that "
           "the computing time grows linearly.",
           at_least(1.0, 1000.0)},
          s.sub_steps);
  v.field({"iterations", "",
           "Number of impulse and velocity passes in a step. The thesis uses 5 or 10. Higher stacks need more.",
           at_least(1.0, 10000.0)},
          s.iterations);
  v.field({"bias", "",
           "Share of the penetration that is converted into a separating velocity in each step. Larger values make "
           "contacts stiffer, but cause jitter.",
           at_least(0.0, 1.0)},
          s.bias);
  v.field({"slop", "",
           "Penetration that is tolerated, divided by the radius of a sphere. With 0, contacts appear and disappear "
           "all the time.",
           at_least(0.0, 1.0)},
          s.slop);
  v.field({"rest_velocity", "m/s",
           "Approach speed below which the restitution of a contact is 0. The value 0 means 2 * gravity * length of a "
           "step.",
           at_least(0.0, 100.0)},
          s.rest_velocity);
  v.field(
      {"voxels", "", "Number of voxels along the longest side of a part. The number of spheres grows with its square.",
       at_least(1.0, 512.0)},
      s.voxels);
  v.field({"tightness", "",
           "Distance of neighbouring voxels divided by the diameter of a sphere. With values below 1, spheres overlap "
           "and the surface is smoother.",
           above(0.0, 1.0)},
          s.tightness);
  v.field({"radii", "",
           "Radii of spheres divided by the longest side of the part, the largest first. They replace `voxels`: large "
           "spheres fill the inside of the part, and the smallest ones form its surface.",
           at_least(0.5 / 512.0, 0.5), !s.radii.empty()},
          s.radii);
  v.field({"modified_normals", "",
           "If true, spheres on faces of a part have the normal of the true surface, so that stacks are stable with "
           "fewer iterations."},
          s.modified_normals);
  v.field({"grid_size", "", "Number of cells of the collision grid along each axis. The memory grows with its cube.",
           at_least(1.0, 1024.0)},
          s.grid_size);
  v.field({"cell_size", "",
           "Edge length of a cell of the collision grid divided by the diameter of the largest sphere. Larger cells "
           "contain more candidates.",
           at_least(1.0, 1000.0)},
          s.cell_size);
  v.field({"contacts_per_sphere", "",
           "Initial number of contacts for which memory is reserved, for each sphere. If it does not suffice, more "
           "memory is reserved, and the report has a flag.",
           at_least(1.0, 1024.0)},
          s.contacts_per_sphere);
}

template <class Visitor>
void visit(Visitor& v, SphereSettings& s) {
  v.field({"time_step", "s",
           "Length of a time step. Contacts are found once in each step. Longer steps are faster, but thin parts may "
           "penetrate and interlock.",
           above(0.0, 0.1)},
          s.time_step);
  v.field({"cut_steps", "",
           "If true, time steps that are too long for small or fast parts are shortened. If false, such parts may pass "
           "through others; use this only to measure the effect of long steps."},
          s.cut_steps);
  v.field({"step_fall", "",
           "Only with `cut_steps`: largest distance that the smallest part falls from rest within one step, divided by "
           "the diagonal of its bounding box. Larger values allow longer steps for small parts, which then penetrate "
           "more deeply.",
           above(0.0, 1.0)},
          s.step_fall);
  v.field({"sub_steps", "",
           "Number of sub-steps in a time step. Contact forces are solved in each of them. More sub-steps make "
           "contacts stiffer and reduce drift, and the computing time grows linearly.",
           at_least(1.0, 1000.0)},
          s.sub_steps);
  v.field({"recycle", "",
           "Relative displacement of two parts up to which their contacts are reused, divided by the diagonal of the "
           "smallest part's bounding box. During the pour, three times this value is used; while the heap is pressed "
           "and checked, at most 0.001, and with the preset `quick` 0.0002. Larger values are faster, but contacts are "
           "less exact.",
           above(0.0, 0.1)},
          s.recycle);
  v.field({"coarse_samples", "", "Number of surface samples of a part during the pour. Thin parts have more.",
           at_least(8.0, 1e6)},
          s.coarse_samples);
  v.field({"fine_samples", "",
           "Number of surface samples of a part while the heap settles. Thin parts have more. More samples reduce "
           "penetration, and the computing time grows linearly. With 0, the coarse samples are used.",
           at_least(0.0, 1e6)},
          s.fine_samples);
  v.field({"field_cell", "",
           "Edge length of a cell of the distance field divided by the diagonal of the part's bounding box. Smaller "
           "cells are more exact; half the edge length needs eight times the memory.",
           above(0.0, 0.25)},
          s.field_cell);
  v.field({"device", "",
           "Where the solver runs. `cpu`: C++ code. `gpu`: OpenGL compute shaders, for many scenes at once. `auto`: "
           "the device that needed less time for a standard heap, which is measured once. Scenes are repeatable, bit "
           "for bit, within one class of devices."},
          s.device);
}

template <class Visitor>
void visit(Visitor& v, SolverSettings& solver) {
  v.field(
      {"type", "", "The solver. `auto` chooses by device, part and number of parts, and the report states the reason."},
      solver.type);
  v.field({"preset", "",
           "`standard`: the default solver `sphere`. `quick`: the same solver with other defaults of `pour.finish`, "
           "`pour.drop_height`, `solver.sphere` and two limits of `accept`; it is several times as fast, but parts "
           "overlap by up to 1 % of their size. `thesis`: the method of the thesis from which this project grew, to "
           "compare results with its tables."},
          solver.preset);
  v.section({"bullet", "", "Settings of the solver `bullet`."}, solver.bullet);
  v.section({"thesis", "", "Settings of the solver `sphere` with the preset `thesis`."}, solver.thesis);
  v.section({"sphere", "", "Settings of the solver `sphere` with the presets `standard` and `quick`."}, solver.sphere);
}

}  // namespace bin_scenes
