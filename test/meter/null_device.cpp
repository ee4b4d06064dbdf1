#include "meter/null_device.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <stdexcept>

namespace bin_scenes::meter {

namespace {

NullDevice* device = nullptr;

PFNGLMAPNAMEDBUFFERRANGEPROC real_map = nullptr;
PFNGLCOPYNAMEDBUFFERSUBDATAPROC real_copy = nullptr;
PFNGLDISPATCHCOMPUTEPROC real_dispatch = nullptr;
PFNGLDISPATCHCOMPUTEINDIRECTPROC real_indirect = nullptr;

/// A pointer of libepoxy finds its function when it is first called; then it points at it.
template <class Function>
void take_place(Function& real, Function& pointer, Function ours) {
  real = pointer;
  pointer = ours;
}

void* on_map(GLuint buffer, GLintptr offset, GLsizeiptr length, GLbitfield access) {
  epoxy_glMapNamedBufferRange = real_map;
  void* place = glMapNamedBufferRange(buffer, offset, length, access);
  take_place(real_map, epoxy_glMapNamedBufferRange, &on_map);
  device->note_mapping(buffer, place);
  return place;
}
void on_copy(GLuint source, GLuint target, GLintptr from, GLintptr to, GLsizeiptr size) {
  if (device->reaches_host(target)) {
    if (device->answers()) return device->answer(source, from, target, to, size);
    device->record(source, from, size);
  }
  epoxy_glCopyNamedBufferSubData = real_copy;
  glCopyNamedBufferSubData(source, target, from, to, size);
  take_place(real_copy, epoxy_glCopyNamedBufferSubData, &on_copy);
}
void on_dispatch(GLuint, GLuint, GLuint) {}
void on_indirect(GLintptr) {}

std::string label_of(unsigned buffer) {
  GLchar label[256] = "";
  glGetObjectLabel(GL_BUFFER, buffer, sizeof label, nullptr, label);
  return label;
}

double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

NullDevice::NullDevice() : answers_(false) {
  take_places();
}

NullDevice::NullDevice(Tape tape) : answers_(true), tape_(std::move(tape)) {
  take_places();
  take_place(real_dispatch, epoxy_glDispatchCompute, &on_dispatch);
  take_place(real_indirect, epoxy_glDispatchComputeIndirect, &on_indirect);
}

void NullDevice::take_places() {
  if (device) throw std::logic_error("a second null device");
  device = this;
  take_place(real_map, epoxy_glMapNamedBufferRange, &on_map);
  take_place(real_copy, epoxy_glCopyNamedBufferSubData, &on_copy);
}

NullDevice::~NullDevice() {
  epoxy_glMapNamedBufferRange = real_map;
  epoxy_glCopyNamedBufferSubData = real_copy;
  if (answers_) {
    epoxy_glDispatchCompute = real_dispatch;
    epoxy_glDispatchComputeIndirect = real_indirect;
  }
  device = nullptr;
}

void NullDevice::record(unsigned source, std::ptrdiff_t offset, std::ptrdiff_t bytes) {
  ++reads_.copies;
  reads_.bytes += static_cast<std::uint64_t>(bytes);
  std::vector<unsigned char> contents(static_cast<std::size_t>(bytes));
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  glFinish();
  glGetNamedBufferSubData(source, offset, bytes, contents.data());
  tape_[label_of(source)].push_back(std::move(contents));
}

void NullDevice::answer(unsigned source, std::ptrdiff_t offset, unsigned target, std::ptrdiff_t at,
                        std::ptrdiff_t bytes) {
  const double begin = thread_cpu_s();
  ++reads_.copies;
  reads_.bytes += static_cast<std::uint64_t>(bytes);
  const std::string label = label_of(source);
  const auto& records = tape_[label];
  unsigned char* place = mapped_.at(target) + at;
  for (std::ptrdiff_t done = 0; done < bytes;) {  // neighbouring worlds are one copy
    std::size_t& position = positions_[{label, offset + done}];
    const std::ptrdiff_t left = bytes - done;
    if (position < records.size() && static_cast<std::ptrdiff_t>(records[position].size()) <= left) {
      const std::vector<unsigned char>& record = records[position++];
      std::memcpy(place + done, record.data(), record.size());
      done += static_cast<std::ptrdiff_t>(record.size());
    } else {
      ++unanswered_;
      std::memset(place + done, 0, static_cast<std::size_t>(left));
      done = bytes;
    }
  }
  cpu_s_ += thread_cpu_s() - begin;
}

}  // namespace bin_scenes::meter
