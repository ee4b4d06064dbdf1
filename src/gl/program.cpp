/// Compiles or loads compute programs and sets their uniforms. Dispatches of many groups are folded into rows that
/// every driver takes.
#include "bin_scenes/gl/program.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/traffic.hpp"
#include "program_cache.hpp"
#include "shader_source.hpp"

#include <epoxy/gl.h>

#include <utility>

namespace bin_scenes::gl {

namespace {

std::string log_of(unsigned id, bool program) {
  GLint length = 0;
  program ? glGetProgramiv(id, GL_INFO_LOG_LENGTH, &length) : glGetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length > 0 ? length : 1), '\0');
  program ? glGetProgramInfoLog(id, length, nullptr, log.data()) : glGetShaderInfoLog(id, length, nullptr, log.data());
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  return log;
}

unsigned compile(unsigned stage, const ShaderSource& source) {
  stop_if_cancelled();
  const unsigned id = glCreateShader(stage);
  const char* text = source.text.c_str();
  glShaderSource(id, 1, &text, nullptr);
  glCompileShader(id);
  GLint good = GL_FALSE;
  glGetShaderiv(id, GL_COMPILE_STATUS, &good);
  if (good) return id;
  const std::string log = with_file_names(log_of(id, false), source);
  glDeleteShader(id);
  throw environment_error("shader does not compile on " + Device::current().renderer() + ":\n" + log,
                          source.files.front(), "a defect of bin_scenes or of the driver: report it with this text");
}

unsigned link_shaders(const std::string& name, const std::vector<unsigned>& shaders) {
  const unsigned id = glCreateProgram();
  glProgramParameteri(id, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
  for (unsigned shader : shaders) glAttachShader(id, shader);
  glLinkProgram(id);
  for (unsigned shader : shaders) glDetachShader(id, shader), glDeleteShader(shader);
  GLint good = GL_FALSE;
  glGetProgramiv(id, GL_LINK_STATUS, &good);
  if (good) return id;
  const std::string log = log_of(id, true);
  glDeleteProgram(id);
  throw environment_error("shader program does not link on " + Device::current().renderer() + ":\n" + log, name,
                          "a defect of bin_scenes or of the driver: report it with this text");
}

std::string stem(const std::string& file) {
  const std::size_t slash = file.rfind('/') + 1, dot = file.rfind('.');
  return file.substr(slash, dot - slash);
}

}  // namespace

Program Program::link(const std::string& name, const std::vector<std::pair<unsigned, std::string>>& stages,
                      const Defines& defines) {
  const Device& device = Device::current();
  std::vector<ShaderSource> sources;
  std::string key = device.vendor() + "\n" + device.renderer() + "\n" + device.version() + "\n";
  for (const auto& [stage, file] : stages) {
    sources.push_back(read_shader(file, defines));
    key += std::to_string(stage) + "\n" + sources.back().text;
  }

  Program program;
  program.id_ = load_program_binary(name, key);
  program.from_cache_ = program.id_ != 0;
  if (!program.id_) {
    std::vector<unsigned> shaders;
    for (std::size_t i = 0; i < stages.size(); ++i) shaders.push_back(compile(stages[i].first, sources[i]));
    program.id_ = link_shaders(name, shaders);
    store_program_binary(name, key, program.id_);
  }
  glObjectLabel(GL_PROGRAM, program.id_, static_cast<GLsizei>(name.size()), name.data());
  if (stages.front().first == GL_COMPUTE_SHADER) {
    GLint size[3] = {0, 0, 0};
    glGetProgramiv(program.id_, GL_COMPUTE_WORK_GROUP_SIZE, size);
    program.group_size_ = static_cast<unsigned>(size[0]);
  }
  return program;
}

Program Program::compute(const std::string& file, const Defines& defines) {
  return link(stem(file), {{GL_COMPUTE_SHADER, file}}, defines);
}

Program::~Program() {
  if (id_) glDeleteProgram(id_);
}

Program::Program(Program&& other) noexcept {
  *this = std::move(other);
}

Program& Program::operator=(Program&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(group_size_, other.group_size_);
  std::swap(from_cache_, other.from_cache_);
  std::swap(locations_, other.locations_);
  return *this;
}

void Program::use() const {
  BIN_SCENES_ASSERT(id_ != 0 && Device::is_current());
  glUseProgram(id_);
}

int Program::location(const char* uniform) const {
  BIN_SCENES_ASSERT(id_ != 0);
  const auto known = locations_.find(uniform);
  if (known != locations_.end()) return known->second;
  return locations_[uniform] = glGetUniformLocation(id_, uniform);
}

void Program::set(const char* uniform, int value) const {
  glProgramUniform1i(id_, location(uniform), value);
}
void Program::set(const char* uniform, unsigned value) const {
  glProgramUniform1ui(id_, location(uniform), value);
}
void Program::set(const char* uniform, float value) const {
  glProgramUniform1f(id_, location(uniform), value);
}

void barrier(Barrier kind) {
  switch (kind) {
    case Barrier::none:
      return;
    case Barrier::storage:
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
      break;
    case Barrier::arguments:
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
      break;
    case Barrier::all:
      glMemoryBarrier(GL_ALL_BARRIER_BITS);
  }
  ++traffic().barriers;
  if (kind != Barrier::storage) ++traffic().argument_barriers;
}

std::array<unsigned, 2> folded_groups(std::size_t groups) {
  constexpr std::size_t per_axis = 65535;  // the least that OpenGL 4.5 promises
  if (groups == 0) return {0, 0};
  const std::size_t x = groups < per_axis ? groups : per_axis;
  return {static_cast<unsigned>(x), static_cast<unsigned>((groups + x - 1) / x)};
}

void dispatch_groups(const Program& program, std::size_t groups, Barrier after) {
  const auto [x, y] = folded_groups(groups);
  if (x == 0) return;
  program.use();
  glDispatchCompute(x, y, 1);
  ++traffic().dispatches;
  barrier(after);
}

void dispatch(const Program& program, std::size_t items, Barrier after) {
  BIN_SCENES_ASSERT(program.group_size() > 0);
  dispatch_groups(program, (items + program.group_size() - 1) / program.group_size(), after);
}

void dispatch_indirect(const Program& program, const Storage& arguments, std::size_t offset, Barrier after) {
  program.use();
  BIN_SCENES_ASSERT(offset % 4 == 0 && offset + 12 <= arguments.bytes());
  arguments.bind_indirect();
  glDispatchComputeIndirect(static_cast<GLintptr>(offset));
  ++traffic().dispatches;
  barrier(after);
}

}  // namespace bin_scenes::gl
