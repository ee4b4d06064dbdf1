/// The repairs a loaded mesh goes through, in the order of src/mesh/mesh_loader.cpp.
/// Lengths in the unit of the mesh. All of them are deterministic: ties go to the lower index.
#pragma once

#include "edge_uses.hpp"
#include "holes.hpp"
#include "orientation.hpp"
#include "shells.hpp"
#include "t_junctions.hpp"
#include "thicken.hpp"
#include "unite.hpp"
#include "weld.hpp"
