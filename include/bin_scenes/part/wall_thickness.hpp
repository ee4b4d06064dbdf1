/// The wall thickness of a part, measured by rays as tools for moulded and sheet metal parts do it. The default solver
/// shortens its time step for thin parts, which could otherwise pass through each other. The result describes a whole
/// part and not a place on it.
#pragma once

namespace bin_scenes {

class MeshQuery;

/// Returns the wall thickness (m): the length of material behind a point of the surface, along the inward normal. The
/// result is the 5 % quantile over the surface, so that rims and tips do not count. It is 0 for an open mesh. Shells
/// that overlap count as united.
double wall_thickness(const MeshQuery& query);

}  // namespace bin_scenes
