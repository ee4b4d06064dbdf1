/// The command `realism`: makes the scenes of a request in a temporary folder, and has them compared with a real
/// camera's files by bench/realism, which is installed with the package.
#include "bin_scenes/core/error.hpp"
#include "core/data_files.hpp"
#include "tool/commands.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

/// A folder that disappears with it.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_((fs::temp_directory_path() / "bin_scenes_realism_XXXXXX").string()) {
    if (!mkdtemp(path_.data())) throw environment_error("cannot be made", path_, "set TMPDIR to a folder with room");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Exit code of a program; -1 if it was ended by a signal, 127 if there is none.
/// @param to_errors  its output goes to the standard error
int run_program(std::vector<std::string> words, bool to_errors) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw environment_error("no further process can be started", words.front(), "");
  if (child == 0) {
    if (to_errors) dup2(STDERR_FILENO, STDOUT_FILENO);
    execvp(arguments.front(), arguments.data());
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string script() {
  return first_place(data_places("bench/realism"), "the script of the comparison", "install bin_scenes anew");
}

std::vector<std::string> comparison(const RealismOptions& options, const std::string& scenes) {
  std::vector<std::string> words = {script(), "--scenes", scenes};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  add("--sensor", options.sensor);
  add("--focal", options.focal);
  add("--scale", options.scale);
  add("--unit", options.unit);
  if (!options.crop.empty()) words.push_back("--crop");
  words.insert(words.end(), options.crop.begin(), options.crop.end());
  if (options.json) words.push_back("--json");
  words.push_back("--real");
  words.insert(words.end(), options.files.begin(), options.files.end());
  return words;
}

}  // namespace

int realism(const RealismOptions& options) {
  for (const std::string& file : options.files)
    if (!fs::is_regular_file(file)) throw input_error("no such file", file, "name the files of a real camera");
  const TemporaryFolder scenes;
  std::vector<std::string> words = {fs::read_symlink("/proc/self/exe").string(), "generate", options.request};
  words.insert(words.end(), {"--out", scenes.path(), "--formats", "json,png"});
  for (const std::string& item : options.set) words.insert(words.end(), {"--set", item});
  const int made = run_program(words, true);
  if (made != exit_done && made != exit_set_apart) return made < 0 ? exit_interrupted : made;
  const int compared = run_program(comparison(options, scenes.path()), false);
  if (compared == 1 || compared == 127)
    throw environment_error("the comparison could not run", "python3",
                            "install python3-numpy, python3-scipy, python3-sklearn and python3-pil");
  return compared < 0 ? static_cast<int>(exit_interrupted) : compared;
}

}  // namespace bin_scenes
