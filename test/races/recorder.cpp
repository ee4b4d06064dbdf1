#include "races/recorder.hpp"

#include "bin_scenes/gl/program.hpp"
#include "gl/shader_source.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace bin_scenes::races {

namespace {

namespace fs = std::filesystem;

Recorder* recorder = nullptr;

// libepoxy calls OpenGL through pointers, which find their function when first called and then point at it.
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
  recorder->take_source(shader, text);
  pass_on(real_source, epoxy_glShaderSource, &on_source, shader, count, texts, lengths);
}
void on_attach(GLuint program, GLuint shader) {
  recorder->attach(program, shader);
  pass_on(real_attach, epoxy_glAttachShader, &on_attach, program, shader);
}
void barrier_now(GLbitfield bits) {
  void on_barrier(GLbitfield);
  pass_on(real_barrier, epoxy_glMemoryBarrier, &on_barrier, bits);
}
void on_barrier(GLbitfield bits) {
  recorder->take_barrier(bits);
  barrier_now(bits);
}
void on_dispatch(GLuint x, GLuint y, GLuint z) {
  const auto issue = [&] { pass_on(real_dispatch, epoxy_glDispatchCompute, &on_dispatch, x, y, z); };
  if (!recorder->watching()) return issue();
  recorder->dispatch({x, y, z}, issue);
}
void on_indirect(GLintptr offset) {
  const auto issue = [&] { pass_on(real_indirect, epoxy_glDispatchComputeIndirect, &on_indirect, offset); };
  if (!recorder->watching()) return issue();
  GLint buffer = 0;
  glGetIntegerv(GL_DISPATCH_INDIRECT_BUFFER_BINDING, &buffer);
  std::array<Word, 3> groups{};
  recorder->before_indirect(static_cast<unsigned>(buffer), static_cast<std::size_t>(offset), groups);
  recorder->dispatch(groups, issue);
}

template <class Function>
void take_place(Function& real, Function& pointer, Function ours) {
  real = pointer;
  pointer = ours;
}

/// Files of a pass by the numbers of #line, from its name.
std::vector<std::string> files_of(const std::string& name) {
  const fs::path directory = gl::shader_directory();
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory))
    if (entry.path().stem() == name && entry.path().extension() == ".comp")
      return gl::read_shader(fs::relative(entry.path(), directory).string(), {}).files;
  return {};
}

float as_float(Word word) {
  float value;
  std::memcpy(&value, &word, sizeof value);
  return value;
}

/// Devices round divisions and roots in their own ways.
bool alike(Word a, Word b) {
  if (a == b) return true;
  const float x = as_float(a), y = as_float(b);
  return std::abs(x - y) <= 1e-2f * (std::abs(x) + std::abs(y)) + 2e-5f;
}

/// Words that may be other than on the device, of those that a pass changes: where two candidates are as good, rounding
/// chooses.
std::size_t most_ties(std::size_t changed) {
  return 8 + changed / 10;
}

/// Lists of what invocations came upon, in the order of arrival, and the chains that lie in the jobs; and of two edges
/// that cross, rounding says which one is the contact's.
bool is_compared(const std::string& pass, const std::string& buffer) {
  if (buffer == "Candidates" || buffer == "NearSamples") return false;
  return !(buffer == "Jobs" && (pass == "collect_samples" || pass == "test_samples"));
}

}  // namespace

std::vector<Memory> Record::repeat(Referee& referee, const Choices& choices, Outcome* outcome) const {
  std::vector<Memory> copies = buffers;
  Dispatch own = dispatch;
  for (std::size_t k = 0; k < copies.size(); ++k) {
    copies[k].watch();
    own.buffers[k] = &copies[k];
  }
  const Outcome made = run(own, referee, choices);
  if (outcome) *outcome = made;
  return copies;
}

Recorder::Recorder() {
  if (recorder) throw std::logic_error("a second recorder");
  recorder = this;
  setenv("BIN_SCENES_CACHE", "off", 1);
  take_place(real_source, epoxy_glShaderSource, &on_source);
  take_place(real_attach, epoxy_glAttachShader, &on_attach);
  take_place(real_barrier, epoxy_glMemoryBarrier, &on_barrier);
  take_place(real_dispatch, epoxy_glDispatchCompute, &on_dispatch);
  take_place(real_indirect, epoxy_glDispatchComputeIndirect, &on_indirect);
}

Recorder::~Recorder() {
  epoxy_glShaderSource = real_source;
  epoxy_glAttachShader = real_attach;
  epoxy_glMemoryBarrier = real_barrier;
  epoxy_glDispatchCompute = real_dispatch;
  epoxy_glDispatchComputeIndirect = real_indirect;
  unsetenv("BIN_SCENES_CACHE");
  recorder = nullptr;
}

void Recorder::begin(bool compares) {
  watching_ = true;
  compares_ = compares;
  memories_.clear();
  kept_.clear();
  referee_ = {};
}

void Recorder::take_barrier(unsigned bits) {
  if (bits & GL_SHADER_STORAGE_BARRIER_BIT) referee_.host_barrier();
  if (bits & GL_COMMAND_BARRIER_BIT) referee_.argument_barrier();
}

Pass Recorder::current_pass() {
  GLint program = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  const std::string& source = programs_[static_cast<unsigned>(program)];
  const auto known = passes_.find(source);
  if (known != passes_.end()) return known->second;
  GLchar label[256] = "";
  glGetObjectLabel(GL_PROGRAM, static_cast<GLuint>(program), sizeof label, nullptr, label);
  Module module = compile(source, label);
  module.files = files_of(label);
  const std::string rest = source.find("#define REST") != std::string::npos ? " (rest)" : "";
  const std::string sums = source.find("#define PASS_SUM") != std::string::npos ? " (sums)" : "";
  return passes_[source] = {label + rest + sums, std::make_shared<const Module>(std::move(module))};
}

Memory& Recorder::download(unsigned buffer, const std::string& name) {
  Memory& memory = memories_[buffer];
  GLint64 bytes = 0;
  glGetNamedBufferParameteri64v(buffer, GL_BUFFER_SIZE, &bytes);
  memory.name = name;
  memory.words.resize(static_cast<std::size_t>(bytes) / sizeof(Word));
  glGetNamedBufferSubData(buffer, 0, static_cast<GLsizeiptr>(memory.words.size() * sizeof(Word)), memory.words.data());
  return memory;
}

Dispatch Recorder::prepare(const Pass& pass, const std::array<Word, 3>& groups) {
  Dispatch dispatch;
  dispatch.module = pass.module.get();
  dispatch.groups = groups;
  GLint program = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  const auto id = static_cast<GLuint>(program);
  for (const Variable& uniform : pass.module->uniforms) {
    const GLuint index = glGetProgramResourceIndex(id, GL_UNIFORM, uniform.name.c_str());
    if (index == GL_INVALID_INDEX) continue;
    const GLenum properties[] = {GL_TYPE, GL_LOCATION};
    GLint values[2] = {0, 0};
    glGetProgramResourceiv(id, GL_UNIFORM, index, 2, properties, 2, nullptr, values);
    Word& bits = dispatch.uniforms[uniform.name];
    if (values[0] == GL_FLOAT)
      glGetUniformfv(id, values[1], reinterpret_cast<float*>(&bits));
    else
      glGetUniformuiv(id, values[1], &bits);
  }
  bound_.clear();
  for (const BufferVariable& variable : pass.module->buffers) {
    GLint buffer = 0;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, variable.binding, &buffer);
    if (buffer == 0) throw std::runtime_error(pass.name + ": nothing bound to " + variable.name);
    Memory& memory = download(static_cast<unsigned>(buffer), variable.name);
    if (!variable.readonly) memory.watch();
    if (!memory.marks.empty()) memory.watch();
    dispatch.buffers.push_back(&memory);
    bound_.push_back(static_cast<unsigned>(buffer));
  }
  return dispatch;
}

void Recorder::before_indirect(unsigned buffer, std::size_t offset, std::array<Word, 3>& groups) {
  barrier_now(GL_ALL_BARRIER_BITS);
  const auto known = memories_.find(buffer);
  for (std::size_t k = 0; known != memories_.end() && k < groups.size(); ++k)
    referee_.read_arguments(known->second, static_cast<Word>(offset / sizeof(Word) + k));
  glGetNamedBufferSubData(buffer, static_cast<GLintptr>(offset), sizeof groups, groups.data());
}

template <class Issue>
void Recorder::dispatch(const std::array<Word, 3>& groups, Issue issue) {
  if (groups[0] * groups[1] * groups[2] == 0) return issue();
  barrier_now(GL_ALL_BARRIER_BITS);
  const Pass pass = current_pass();
  Record record{pass, prepare(pass, groups), {}, 0};
  for (Memory* memory : record.dispatch.buffers) record.buffers.push_back({memory->name, memory->words, {}});

  const std::uint64_t steps = run(record.dispatch, referee_).steps;
  seen_.steps += steps;
  Count& count = seen_.counts[pass.name];
  ++count.dispatches;
  count.needed_barriers += referee_.needs_barrier();
  take_findings(pass, referee_);
  std::vector<Memory> first;
  for (Memory* memory : record.dispatch.buffers) first.push_back({memory->name, memory->words, {}});

  Referee fresh;
  Choices other_order;
  other_order.seed = 12345 + count.dispatches;
  const std::vector<Memory> second = record.repeat(fresh, other_order);
  take_findings(pass, fresh);

  issue();
  barrier_now(GL_ALL_BARRIER_BITS);
  std::vector<Memory> device;
  for (std::size_t k = 0; k < bound_.size(); ++k)
    device.push_back({first[k].name, download(bound_[k], first[k].name).words, {}});
  if (compares_) compare(record, first, second, device);
  record.steps = steps;
  keep(record);
}

/// What depends on the order of invocations, as a place in a list, may be other on the device.
void Recorder::compare(const Record& record, const std::vector<Memory>& first, const std::vector<Memory>& second,
                       const std::vector<Memory>& device) {
  const Pass& pass = record.pass;
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (pass.module->buffers[k].readonly || !is_compared(pass.name, first[k].name)) continue;
    std::size_t others = 0, example = 0, free = 0, changed = 0;
    for (std::size_t w = 0; w < first[k].words.size(); ++w) {
      changed += first[k].words[w] != record.buffers[k].words[w];
      if (first[k].words[w] != second[k].words[w]) {
        ++free;
      } else if (!alike(first[k].words[w], device[k].words[w])) {
        if (others++ == 0) example = w;
      }
    }
    if (others > most_ties(changed))
      add(pass.name + ": " + first[k].name + " is other than on the device in " + std::to_string(others) + " of " +
          std::to_string(changed) + " changed words (" + std::to_string(free) + " by order), as " +
          std::to_string(example) + ": " + std::to_string(as_float(first[k].words[example])) + " for " +
          std::to_string(as_float(device[k].words[example])));
  }
}

void Recorder::add(const std::string& finding) {
  if (std::find(seen_.findings.begin(), seen_.findings.end(), finding) == seen_.findings.end())
    seen_.findings.push_back(finding);
}

void Recorder::take_findings(const Pass& pass, Referee& referee) {
  for (const Finding& f : referee.findings())
    add(pass.name + ": " + f.kind + ": " + f.memory + ", " + pass.module->place_of(f.first) + " and " +
        pass.module->place_of(f.second));
  referee.forget_findings();
}

void Recorder::keep(const Record& record) {
  if (record.pass.module->barriers.empty()) return;
  std::string key = record.pass.name;
  const auto stage = record.dispatch.uniforms.find("stage");
  if (stage != record.dispatch.uniforms.end()) key += std::to_string(stage->second);
  if (++kept_[key] <= 2) seen_.records.push_back(record);
}

}  // namespace bin_scenes::races
