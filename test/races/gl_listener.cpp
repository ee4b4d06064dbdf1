#include "races/gl_listener.hpp"

#include "bin_scenes/gl/program.hpp"
#include "gl/shader_source.hpp"

#include <epoxy/gl.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace bin_scenes::races {

namespace {

namespace fs = std::filesystem;

GlListener* listener = nullptr;

// Each pointer of libepoxy finds its function when it is first called, and then points at it.
PFNGLSHADERSOURCEPROC real_source = nullptr;
PFNGLATTACHSHADERPROC real_attach = nullptr;
PFNGLMEMORYBARRIERPROC real_barrier = nullptr;
PFNGLDISPATCHCOMPUTEPROC real_dispatch = nullptr;
PFNGLDISPATCHCOMPUTEINDIRECTPROC real_indirect = nullptr;

/// Calls what a pointer held, with the pointer as it was: that of the first call finds its function so.
template <class Function, class... Arguments>
void pass_on(Function& real, Function& pointer, Function ours, Arguments... arguments) {
  pointer = real;
  real(arguments...);
  real = pointer;
  pointer = ours;
}

void on_source(GLuint shader, GLsizei count, const GLchar* const* texts, const GLint* lengths) {
  std::string text;
  for (GLsizei k = 0; k < count; ++k) text += texts[k];
  listener->take_source(shader, text);
  pass_on(real_source, epoxy_glShaderSource, &on_source, shader, count, texts, lengths);
}
void on_attach(GLuint program, GLuint shader) {
  listener->attach(program, shader);
  pass_on(real_attach, epoxy_glAttachShader, &on_attach, program, shader);
}
void on_barrier(GLbitfield bits) {
  listener->take_barrier(bits);
  pass_on(real_barrier, epoxy_glMemoryBarrier, &on_barrier, bits);
}
void hand_over(const GlListener::Groups& groups, const std::function<void()>& issue) {
  if (!listener->watching() || groups[0] * groups[1] * groups[2] == 0) return issue();
  listener->take_dispatch(groups, issue);
}
void on_dispatch(GLuint x, GLuint y, GLuint z) {
  hand_over({x, y, z}, [&] { pass_on(real_dispatch, epoxy_glDispatchCompute, &on_dispatch, x, y, z); });
}
void on_indirect(GLintptr offset) {
  const auto issue = [&] { pass_on(real_indirect, epoxy_glDispatchComputeIndirect, &on_indirect, offset); };
  if (!listener->watching()) return issue();
  pass_on(real_barrier, epoxy_glMemoryBarrier, &on_barrier, GLbitfield{GL_ALL_BARRIER_BITS});
  GLint buffer = 0;
  glGetIntegerv(GL_DISPATCH_INDIRECT_BUFFER_BINDING, &buffer);
  listener->take_arguments(static_cast<unsigned>(buffer), static_cast<std::size_t>(offset));
  GlListener::Groups groups{};
  glGetNamedBufferSubData(static_cast<GLuint>(buffer), offset, sizeof groups, groups.data());
  hand_over(groups, issue);
}

template <class Function>
void take_place(Function& real, Function& pointer, Function ours) {
  real = pointer;
  pointer = ours;
}

GLuint program_in_use() {
  GLint program = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  return static_cast<GLuint>(program);
}

/// Files of a pass by the numbers of #line, from its name.
std::vector<std::string> files_of(const std::string& name) {
  const fs::path directory = gl::shader_directory();
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory))
    if (entry.path().stem() == name && entry.path().extension() == ".comp")
      return gl::read_shader(fs::relative(entry.path(), directory).string(), {}).files;
  return {};
}

}  // namespace

GlListener::GlListener(Optimise optimise) : optimise_(optimise) {
  if (listener) throw std::logic_error("a second listener");
  listener = this;
  setenv("BIN_SCENES_CACHE", "off", 1);
  take_place(real_source, epoxy_glShaderSource, &on_source);
  take_place(real_attach, epoxy_glAttachShader, &on_attach);
  take_place(real_barrier, epoxy_glMemoryBarrier, &on_barrier);
  take_place(real_dispatch, epoxy_glDispatchCompute, &on_dispatch);
  take_place(real_indirect, epoxy_glDispatchComputeIndirect, &on_indirect);
}

GlListener::~GlListener() {
  epoxy_glShaderSource = real_source;
  epoxy_glAttachShader = real_attach;
  epoxy_glMemoryBarrier = real_barrier;
  epoxy_glDispatchCompute = real_dispatch;
  epoxy_glDispatchComputeIndirect = real_indirect;
  unsetenv("BIN_SCENES_CACHE");
  listener = nullptr;
}

const std::string& GlListener::current_source() const {
  return programs_.at(program_in_use());
}

Pass GlListener::current_pass() {
  const std::string& source = current_source();
  const auto known = passes_.find(source);
  if (known != passes_.end()) return known->second;
  GLchar label[256] = "";
  glGetObjectLabel(GL_PROGRAM, program_in_use(), sizeof label, nullptr, label);
  Module module = compile(source, label, optimise_);
  module.files = files_of(label);
  const std::string rest = source.find("#define REST") != std::string::npos ? " (rest)" : "";
  const std::string sums = source.find("#define PASS_SUM") != std::string::npos ? " (sums)" : "";
  return passes_[source] = {label + rest + sums, std::make_shared<const Module>(std::move(module))};
}

std::map<std::string, Word> GlListener::uniforms_of(const Pass& pass) {
  std::map<std::string, Word> uniforms;
  const GLuint id = program_in_use();
  for (const Variable& uniform : pass.module->uniforms) {
    const GLuint index = glGetProgramResourceIndex(id, GL_UNIFORM, uniform.name.c_str());
    if (index == GL_INVALID_INDEX) continue;
    const GLenum properties[] = {GL_TYPE, GL_LOCATION};
    GLint values[2] = {0, 0};
    glGetProgramResourceiv(id, GL_UNIFORM, index, 2, properties, 2, nullptr, values);
    Word& bits = uniforms[uniform.name];
    if (values[0] == GL_FLOAT)
      glGetUniformfv(id, values[1], reinterpret_cast<float*>(&bits));
    else
      glGetUniformuiv(id, values[1], &bits);
  }
  return uniforms;
}

unsigned GlListener::bound_to(const Pass& pass, const BufferVariable& variable) {
  GLint buffer = 0;
  glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, variable.binding, &buffer);
  if (buffer == 0) throw std::runtime_error(pass.name + ": nothing bound to " + variable.name);
  return static_cast<unsigned>(buffer);
}

std::vector<Word> GlListener::contents_of(unsigned buffer) {
  GLint64 bytes = 0;
  glGetNamedBufferParameteri64v(buffer, GL_BUFFER_SIZE, &bytes);
  std::vector<Word> words(static_cast<std::size_t>(bytes) / sizeof(Word));
  glGetNamedBufferSubData(buffer, 0, static_cast<GLsizeiptr>(words.size() * sizeof(Word)), words.data());
  return words;
}

void GlListener::wait_for_device() {
  pass_on(real_barrier, epoxy_glMemoryBarrier, &on_barrier, GLbitfield{GL_ALL_BARRIER_BITS});
}

}  // namespace bin_scenes::races
