/// How thick the walls of a part are, as tools for moulded and sheet metal parts measure it by rays.
#pragma once

namespace bin_scenes {

class MeshQuery;

/// Wall thickness (m): the length of material behind a point of the surface, along the inward normal. The result is the
/// 5 % quantile over the surface, so that rims and tips do not count. 0 for an open mesh. Overlapping shells count as
/// united.
double wall_thickness(const MeshQuery& query);

}  // namespace bin_scenes
