/// The reference compiler, as a program of its own.
#include "races/module.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>

namespace bin_scenes::races {

namespace {

/// "#line 12 3" becomes "#line 30012": the compiler keeps lines, but not the numbers of files.
std::string with_joined_lines(const std::string& source) {
  static const std::regex mark("#line (\\d+) (\\d+)");
  std::string text;
  auto rest = source.begin();
  for (std::sregex_iterator at(source.begin(), source.end(), mark), end; at != end; ++at) {
    text.append(rest, source.begin() + at->position());
    text += "#line " + std::to_string(std::stoul((*at)[2]) * lines_per_file + std::stoul((*at)[1]));
    rest = source.begin() + at->position() + at->length();
  }
  return text.append(rest, source.end());
}

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return std::string((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
}

}  // namespace

Module compile(const std::string& source, const std::string& name, Optimise optimise) {
  char folder[] = "/tmp/bin_scenes_races_XXXXXX";
  if (!mkdtemp(folder)) throw std::runtime_error("no folder for temporary files");
  const std::string out = std::string(folder) + "/binary", log = std::string(folder) + "/log";
  std::string command = GLSLANG " -g -G --amb --aml --stdin -S comp -o " + out + " > " + log;
  if (optimise == Optimise::yes)
    command += " && " SPIRV_OPT " --target-env=opengl4.5 -O " + out + " -o " + out + " >> " + log + " 2>&1";
  FILE* compiler = popen(command.c_str(), "w");
  const std::string text = with_joined_lines(source);
  fwrite(text.data(), 1, text.size(), compiler);
  const int code = pclose(compiler);
  const std::string binary = content(out), said = content(log);
  std::filesystem::remove_all(folder);
  if (code != 0) throw std::runtime_error(name + " does not compile:\n" + said);
  std::vector<Word> words(binary.size() / sizeof(Word));
  binary.copy(reinterpret_cast<char*>(words.data()), words.size() * sizeof(Word));
  return decode(words);
}

std::string Module::place_of(Word line) const {
  const Word file = line / lines_per_file;
  return (file < files.size() ? files[file] : "source " + std::to_string(file)) + ":" +
         std::to_string(line % lines_per_file);
}

}  // namespace bin_scenes::races
