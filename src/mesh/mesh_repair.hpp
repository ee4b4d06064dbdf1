/// The repairs of a loaded mesh, in the order in which src/mesh/mesh_loader.cpp applies them. Lengths are in the unit
/// of the mesh. All repairs are deterministic: ties are decided in favour of the lower index.
#pragma once

#include "edge_uses.hpp"
#include "holes.hpp"
#include "orientation.hpp"
#include "shells.hpp"
#include "t_junctions.hpp"
#include "thicken.hpp"
#include "unite.hpp"
#include "weld.hpp"
