/// Completion of the command line in shells. It uses the same tables as the command line itself: commands and options,
/// keys of requests with their values, and presets.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace bin_scenes {

/// Returns the possible completions of the last of `words` (the words after the program's name), one per line. A line
/// "file:a,b" asks the shell for files that end in .a or .b; "file:" asks for any files.
std::vector<std::string> completions(const CLI::App& app, const std::vector<std::string>& words);

/// Returns the completion script for a shell; it calls `bin_scenes complete`. Throws an input Error for unknown shells.
std::string completion_script(const std::string& shell);

}  // namespace bin_scenes
