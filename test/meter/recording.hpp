/// A dispatch in a file, so that what was once measured on a card can be compared with the meter after the passes have
/// changed. The file holds the source, the uniforms and those words of the buffers that the pass touches.
#pragma once

#include "meter/watch.hpp"

#include <string>

namespace bin_scenes::meter {

/// Words that the dispatch never touches become zero.
void save(const Taken& taken, const std::string& file);

/// Throws std::runtime_error if the file is not whole.
Taken load(const std::string& file);

}  // namespace bin_scenes::meter
