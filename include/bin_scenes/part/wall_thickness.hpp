/// How thick the walls of a part are, as tools for moulded and sheet metal parts measure it by rays.
#pragma once

namespace bin_scenes {

class MeshQuery;

/// Length of material (m) ahead of a point of the surface, along its inward normal: of all but the 5 % of the surface
/// where it is least, such as rims and tips. 0 for an open mesh. Shells that overlap count as united.
double wall_thickness(const MeshQuery& query);

}  // namespace bin_scenes
