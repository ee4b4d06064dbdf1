#include "meter/flow.hpp"

#include "meter/costs.hpp"

#include <spirv/unified1/GLSL.std.450.h>
#include <spirv/unified1/spirv.hpp11>

namespace bin_scenes::meter {

using namespace races;
using spv::Op;

namespace {

void add(std::vector<Word>& words, Word first, Word count) {
  for (Word k = 0; k < count; ++k) words.push_back(first + k);
}

/// A load or store by a list of (word of the value, word of the memory); false if it is none.
bool add_access(const Instruction& i, const Module& module, Flow& flow) {
  const bool load = i.code == load_buffer || i.code == load_shared;
  if (!load && i.code != store_buffer && i.code != store_shared) return false;
  flow.reads.push_back((load ? i.a : i.to) + 1);
  for (Word k = 0; k < i.n; ++k)
    (load ? flow.writes : flow.reads).push_back((load ? i.to : i.a) + module.lists[i.c + 2 * k]);
  return true;
}

void add_function(const Instruction& i, Flow& flow) {
  for (const Word operand : {i.a, i.b, i.c})
    if (operand) add(flow.reads, operand, i.n);
  const Word function = i.code - extended;
  add(flow.writes, i.to, function == GLSLstd450Length || function == GLSLstd450Distance ? 1 : i.n);
}

void add_arithmetic(const Instruction& i, Flow& flow) {
  const Op op = static_cast<Op>(i.code);
  const Word n = i.n, wide = (op == Op::OpFAdd || op == Op::OpFSub) && i.c ? 2 : 1;
  Word a = n * wide, b = i.b ? n * wide : 0, to = n * wide;
  switch (op) {
    case Op::OpMatrixTimesVector:
      a = 3 * n, b = i.c;
      break;
    case Op::OpVectorTimesMatrix:
      a = i.c, b = 3 * n;
      break;
    case Op::OpMatrixTimesMatrix:
      a = b = to = 9;
      break;
    case Op::OpTranspose:
      a = to = 9, b = 0;
      break;
    case Op::OpVectorTimesScalar:
    case Op::OpMatrixTimesScalar:
      b = 1;
      break;
    case Op::OpFConvert:  // i.b: to double precision
      a = i.b ? n : 2 * n, b = 0, to = i.b ? 2 * n : n;
      break;
    case Op::OpSelect:
      add(flow.reads, i.c & 0x7fffffffu, n);
      if (i.c >> 31) a = 1;
      break;
    case Op::OpDot:
    case Op::OpAny:
    case Op::OpAll:
      to = 1;
      break;
    case Op::OpBitcast:
      b = 0;
      break;
    default:
      break;
  }
  add(flow.reads, i.a, a);
  add(flow.reads, i.b, b);
  add(flow.writes, i.to, to);
}

}  // namespace

Flow flow_of(const Instruction& i, const Module& module) {
  Flow flow;
  if (add_access(i, module, flow)) return flow;
  if (is_atomic(i.code)) {
    flow.reads = {i.a + 1, i.b, i.c};
    flow.writes = {i.to};
  } else if (i.code == load_registers) {
    flow.reads = {i.a + 1};
    add(flow.writes, i.to, i.n);
  } else if (i.code == store_registers) {
    flow.reads = {i.to + 1};
    add(flow.reads, i.a, i.n);
  } else if (i.code >= extended) {
    add_function(i, flow);
  } else {
    switch (static_cast<Op>(i.code)) {
      case Op::OpAccessChain:
        add(flow.reads, i.a, 2);
        for (Word k = 0; k < i.n; ++k) flow.reads.push_back(module.lists[i.c + 3 * k]);
        add(flow.writes, i.to, 2);
        break;
      case Op::OpBranchConditional:
      case Op::OpSwitch:
        flow.reads = {i.a};
        break;
      case Op::OpVectorExtractDynamic:
        add(flow.reads, i.a, i.n * i.c);
        flow.reads.push_back(i.b);
        add(flow.writes, i.to, i.n);
        break;
      case Op::OpLabel:
      case Op::OpBranch:
      case Op::OpReturn:
      case Op::OpUnreachable:
      case Op::OpControlBarrier:
      case Op::OpMemoryBarrier:
        break;
      default:
        add_arithmetic(i, flow);
    }
  }
  return flow;
}

}  // namespace bin_scenes::meter
