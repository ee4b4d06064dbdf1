/// Drivers are lenient, each in its own way: what Mesa takes another may refuse. So every shader goes through the
/// reference compiler of the language and the validator of its binary form, which need no device.
#include "gl/shader_source.hpp"

#include "bin_scenes/gl/program.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace bin_scenes::gl {
namespace {

namespace fs = std::filesystem;

/// What the reference compiler says against a shader, or the validator of SPIR-V against what it becomes, if anything.
std::string complaints(const fs::path& file, const Defines& defines = {}) {
  const ShaderSource source = read_shader(file.string(), defines);
  char folder[] = "/tmp/bin_scenes_glslang_XXXXXX";
  if (!mkdtemp(folder)) return "no folder for temporary files";
  const std::string log = std::string(folder) + "/log", binary = std::string(folder) + "/binary";
  const std::string stage = file.extension().string().substr(1);
  FILE* compiler = popen((GLSLANG " -G --amb --aml --stdin -S " + stage + " -o " + binary + " > " + log).c_str(), "w");
  fwrite(source.text.data(), 1, source.text.size(), compiler);
  int code = pclose(compiler);
  if (code == 0) code = std::system((SPIRV_VAL " --target-env opengl4.5 " + binary + " >> " + log + " 2>&1").c_str());
  std::ifstream in(log);
  const std::string said((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  fs::remove_all(folder);
  return code == 0 ? "" : file.string() + ", exit code " + std::to_string(code) + ":\n" + said;
}

TEST(ReferenceCompiler, TakesEveryShader) {
  if (!fs::exists(GLSLANG) || !fs::exists(SPIRV_VAL))
    GTEST_SKIP() << "no glslangValidator and spirv-val here: apt-get install glslang-tools spirv-tools";
  const fs::path directory = shader_directory(), broken = "test/broken.comp";
  int shaders = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory)) {
    const std::string kind = entry.path().extension().string();
    const fs::path file = fs::relative(entry.path(), directory);
    if ((kind != ".comp" && kind != ".vert" && kind != ".frag") || file == broken) continue;
    EXPECT_EQ(complaints(file, {{"CAPACITY", "64u"}}), "");  // of thesis/detect.comp alone
    ++shaders;
  }
  EXPECT_GT(shaders, 20);
  EXPECT_EQ(complaints("gl/prefix_sum.comp", {{"PASS_SUM", ""}}), "");
  EXPECT_NE(complaints(broken), "");
}

}  // namespace
}  // namespace bin_scenes::gl
