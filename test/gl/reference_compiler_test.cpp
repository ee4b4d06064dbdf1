/// Drivers are lenient, each in its own way: what Mesa takes another may refuse. So every shader goes through the
/// reference compiler of the language, which needs no device.
#include "gl/shader_source.hpp"

#include "bin_scenes/gl/program.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace bin_scenes::gl {
namespace {

namespace fs = std::filesystem;

/// What the reference compiler says against a shader, if anything.
std::string complaints(const fs::path& file, const Defines& defines = {}) {
  const ShaderSource source = read_shader(file.string(), defines);
  char name[] = "/tmp/bin_scenes_glslang_XXXXXX";
  const int log = mkstemp(name);
  const std::string stage = file.extension().string().substr(1);
  FILE* compiler = popen((GLSLANG " --stdin -S " + stage + " > " + name).c_str(), "w");
  fwrite(source.text.data(), 1, source.text.size(), compiler);
  const int code = pclose(compiler);
  std::string said;
  FILE* in = fdopen(log, "r");
  for (int c; (c = fgetc(in)) != EOF;) said += static_cast<char>(c);
  fclose(in);
  fs::remove(name);
  return code == 0 ? "" : file.string() + ", exit code " + std::to_string(code) + ":\n" + said;
}

TEST(ReferenceCompiler, TakesEveryShader) {
  if (!fs::exists(GLSLANG)) GTEST_SKIP() << "no glslangValidator here: apt-get install glslang-tools";
  const fs::path directory = shader_directory(), broken = "test/broken.comp";
  int shaders = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory)) {
    const std::string kind = entry.path().extension().string();
    const fs::path file = fs::relative(entry.path(), directory);
    if ((kind != ".comp" && kind != ".vert" && kind != ".frag") || file == broken) continue;
    EXPECT_EQ(complaints(file, {{"CAPACITY", "64u"}}), "");  // of thesis/detect.comp alone
    ++shaders;
  }
  EXPECT_GT(shaders, 30);
  EXPECT_EQ(complaints("gl/prefix_sum.comp", {{"PASS_SUM", ""}}), "");
  EXPECT_NE(complaints(broken), "");
}

}  // namespace
}  // namespace bin_scenes::gl
