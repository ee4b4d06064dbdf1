/// Completion of the command line in shells. It uses the same tables as the command line itself: commands and options,
/// keys of requests with their values, and presets.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace bin_scenes {

/// What may stand for the last of some words (those behind the program's name): one a line; a line "file:a,b" asks the
/// shell for files whose names end in .a or .b, "file:" for any.
std::vector<std::string> completions(const CLI::App& app, const std::vector<std::string>& words);

/// The script that a shell reads; it asks `bin_scenes complete`. Throws an input Error.
std::string completion_script(const std::string& shell);

}  // namespace bin_scenes
