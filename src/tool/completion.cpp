/// From the words of a command line to what may follow: options, keys of requests level by level, presets, files.
#include "tool/completion.hpp"

#include "bin_scenes/config/presets.hpp"
#include "bin_scenes/core/error.hpp"
#include "config/reference.hpp"
#include "config/values.hpp"
#include "dataset/whole_folders.hpp"

#include <algorithm>
#include <set>

namespace bin_scenes {

extern const char* const completion_for_bash;
extern const char* const completion_for_zsh;

namespace {

using Words = std::vector<std::string>;

const std::string any_file = "file:", requests = "file:yaml,yml";
const std::string models = "file:stl,obj,ply,dae,off,step,stp,iges,igs";

bool starts_with(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

/// "auto | sphere | bullet" or "true or false" of the table of keys.
Words choices(std::string kind) {
  kind = kind.substr(0, kind.find(','));
  const std::string separator = kind.find(" | ") != std::string::npos ? " | " : " or ";
  if (separator == " or " && kind != config::kind_of(bool{})) return {};
  Words words;
  for (std::size_t at = 0; at != std::string::npos;) {
    const std::size_t end = kind.find(separator, at);
    words.push_back(kind.substr(at, end == std::string::npos ? end : end - at));
    at = end == std::string::npos ? end : end + separator.size();
  }
  return words;
}

/// parts[2].count -> parts[].count, with what was taken out.
std::string without_indices(const std::string& path, Words& indices) {
  std::string plain;
  for (std::size_t at = 0; at < path.size(); ++at) {
    plain += path[at];
    if (path[at] != '[') continue;
    const std::size_t end = std::min(path.find(']', at), path.size());
    indices.push_back(path.substr(at + 1, end - at - 1));
    at = end - 1;
  }
  return plain;
}

std::string with_indices(const std::string& plain, const Words& indices) {
  std::string path;
  std::size_t next = 0;
  for (const char c : plain) {
    path += c;
    if (c == '[') path += next < indices.size() && !indices[next].empty() ? indices[next] : "0", ++next;
  }
  return path;
}

Words values_of_key(const config::Entry& key) {
  const std::string name = key.path.substr(key.path.rfind('.') + 1);
  if (name == "preset" && key.kind == config::kind_of(std::string())) return sensor_presets();
  if (name == "material") return materials();
  if (name == "model" && starts_with(key.path, "parts")) return {models};
  if (name == "mesh") return {models};
  return choices(key.kind);
}

/// Of --set: the keys one level further on, then the values of a key.
Words assignments(const std::string& begun) {
  const std::size_t equals = begun.find('=');
  Words indices;
  const std::string plain = without_indices(begun.substr(0, equals), indices);
  Words found;
  for (const config::Entry& key : config::reference()) {
    if (equals != std::string::npos) {
      if (key.path != plain) continue;
      for (const std::string& value : values_of_key(key))
        found.push_back(starts_with(value, any_file) ? value : begun.substr(0, equals + 1) + value);
    } else if (starts_with(key.path, plain) && key.kind != "section" && key.kind != "list") {
      const std::size_t dot = key.path.find('.', plain.size());
      const std::string next = dot == std::string::npos ? key.path + "=" : key.path.substr(0, dot + 1);
      if (found.empty() || found.back() != with_indices(next, indices)) found.push_back(with_indices(next, indices));
    }
  }
  return found;
}

/// Words separated by commas, none twice.
Words list_of(const Words& known, const std::string& begun) {
  const std::size_t comma = begun.rfind(',');
  const std::string before = comma == std::string::npos ? "" : begun.substr(0, comma + 1);
  Words found;
  for (const std::string& word : known)
    if (("," + before).find("," + word + ",") == std::string::npos) found.push_back(before + word);
  return found;
}

Words with(Words words, const std::string& last) {
  words.push_back(last);
  return words;
}

Words formats() {
  Words names;
  for (const SceneFormat& format : scene_formats()) names.push_back(format.name);
  return names;
}

template <class Enum>
Words names_of() {
  return config::word_of(Enum{}).known;
}

/// Values of an option or a positional word.
Words values_of(const std::string& command, const std::string& option, const std::string& begun) {
  if (option == "--set") return assignments(begun);
  if (option == "--formats") return list_of(formats(), begun);
  if (option == "--unit") return names_of<Unit>();
  if (option == "--solver") return names_of<SolverType>();
  if (option == "SENSOR") return with(sensor_presets(), requests);
  if (option == "--sensor" && command == "new") return sensor_presets();
  if (option == "REQUEST" || option == "PLAN" || option == "--request") return {requests};
  if (option == "MODEL" || option == "PART") return {models};
  if (option == "SHELL") return {"bash", "zsh"};
  static const std::set<std::string> paths = {"--out",    "--trace", "--hulls", "--picture", "--plot",
                                              "--models", "DIR",     "SCENE",   "REAL"};
  return paths.count(option) ? Words{any_file} : Words{};
}

struct Place {
  const CLI::App* app;
  const CLI::Option* waiting = nullptr;  ///< the option whose value comes next
  std::size_t positional = 0;            ///< words of this command that are no options
};

const CLI::App* command_of(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (command->get_name() == name) return command;
  return nullptr;
}

Place place_of(const CLI::App& app, const Words& words) {
  Place place{&app};
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const std::string& word = words[i];
    if (place.waiting) {
      place.waiting = nullptr;
    } else if (starts_with(word, "-")) {
      const CLI::Option* option = place.app->get_option_no_throw(word);
      if (option && option->get_items_expected_max() > 0) place.waiting = option;
    } else if (const CLI::App* below = command_of(*place.app, word)) {
      place = Place{below};
    } else {
      ++place.positional;
    }
  }
  return place;
}

Words options_of(const CLI::App& app) {
  Words found;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_lnames().empty()) found.push_back("--" + option->get_lnames().front());
  return found;
}

Words commands_of(const CLI::App& app) {
  Words found;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty()) found.push_back(command->get_name());
  return found;
}

Words possible(const CLI::App& app, const Words& words) {
  const std::string& last = words.back();
  const Place place = place_of(app, words);
  const std::string& command = place.app->get_name();
  if (place.waiting) return values_of(command, "--" + place.waiting->get_lnames().front(), last);
  const std::size_t equals = last.find('=');
  if (starts_with(last, "--") && equals != std::string::npos) {
    const std::string option = last.substr(0, equals);
    Words found = values_of(command, option, last.substr(equals + 1));
    for (std::string& word : found)
      if (!starts_with(word, any_file)) word = option + "=" + word;
    return found;
  }
  if (starts_with(last, "-")) return options_of(*place.app);
  Words found = place.positional == 0 ? commands_of(*place.app) : Words{};
  std::size_t position = 0;
  for (const CLI::Option* option : place.app->get_options()) {
    if (!option->get_positional()) continue;
    const bool here = position == place.positional || option->get_items_expected_max() > 1;
    ++position;
    if (!here) continue;
    const Words values = values_of(command, option->get_name(true), last);
    found.insert(found.end(), values.begin(), values.end());
  }
  return found;
}

}  // namespace

std::vector<std::string> completions(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return {};
  Words found;
  for (const std::string& word : possible(app, words))
    if (starts_with(word, any_file) || starts_with(word, words.back())) found.push_back(word);
  return found;
}

std::string completion_script(const std::string& shell) {
  if (shell == "bash") return completion_for_bash;
  if (shell == "zsh") return completion_for_zsh;
  throw input_error("no completion for '" + shell + "'", "completion", "bash or zsh");
}

}  // namespace bin_scenes
