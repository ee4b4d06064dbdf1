#include "meter/costs.hpp"

#include <spirv/unified1/GLSL.std.450.h>
#include <spirv/unified1/spirv.hpp11>

namespace bin_scenes::meter {

using namespace races;
using spv::Op;

namespace {

Cost cost(double slots, double latency) {
  return {static_cast<float>(slots), static_cast<float>(latency)};
}

Cost cost_of_function(const Instruction& i, const Card& card) {
  const double n = i.n, step = card.arithmetic, special = card.special;
  switch (i.code - extended) {
    case GLSLstd450Sqrt:
      return cost(3 * n, special + 8);
    case GLSLstd450InverseSqrt:
      return cost(n, special);
    case GLSLstd450Length:
      return cost(n + 3, step * n + special + 8);
    case GLSLstd450Distance:
      return cost(2 * n + 3, step * (n + 1) + special + 8);
    case GLSLstd450Normalize:
      return cost(2 * n + 1, step * (n + 1) + special);
    case GLSLstd450Cross:
      return cost(6, 2 * step);
    case GLSLstd450Sin:
    case GLSLstd450Cos:
      return cost(2 * n, special + step);
    case GLSLstd450Atan2:
    case GLSLstd450Acos:
      return cost(22, 80);  // a polynomial of about twenty terms
    case GLSLstd450Pow:
      return cost(3, 2 * special + 12);
    case GLSLstd450FClamp:
    case GLSLstd450FMix:
    case GLSLstd450UClamp:
    case GLSLstd450SClamp:
      return cost(2 * n, 2 * step);
    case GLSLstd450FAbs:
      return cost(0.2 * n, 0);
    case GLSLstd450FindILsb:
    case GLSLstd450FindUMsb:
      return cost(3, 20);
    default:
      return cost(n, step);
  }
}

/// Arithmetic on numbers; false if it is something else.
bool cost_of_arithmetic(const Instruction& i, const Card& card, Cost& out) {
  const double n = i.n, step = card.arithmetic;
  switch (static_cast<Op>(i.code)) {
    case Op::OpFMul:
    case Op::OpVectorTimesScalar:
    case Op::OpMatrixTimesScalar:
      out = cost(0.6 * n, step);
      return true;
    case Op::OpFAdd:
    case Op::OpFSub:
      out = i.c ? cost(2 * n, 16) : cost(0.9 * n, step);  // i.c: double precision
      return true;
    case Op::OpFNegate:
      out = cost(0.1 * n, 0);
      return true;
    case Op::OpFDiv:
      out = cost(3 * n, card.special + 2 * step);
      return true;
    case Op::OpDot:
      out = cost(n, step * n);
      return true;
    case Op::OpMatrixTimesVector:
    case Op::OpVectorTimesMatrix:
      out = cost(9, 3 * step);
      return true;
    case Op::OpMatrixTimesMatrix:
      out = cost(27, 3 * step);
      return true;
    case Op::OpUDiv:
    case Op::OpUMod:
    case Op::OpSDiv:
    case Op::OpSRem:  // mostly by constants: a multiplication and a shift
      out = cost(2 * n, 10);
      return true;
    case Op::OpFConvert:
      out = cost(2 * n, 14);
      return true;
    case Op::OpConvertFToU:
    case Op::OpConvertFToS:
    case Op::OpConvertUToF:
    case Op::OpConvertSToF:
      out = cost(n, 10);
      return true;
    case Op::OpLogicalAnd:
    case Op::OpLogicalOr:
    case Op::OpLogicalNot:
    case Op::OpLogicalEqual:
    case Op::OpLogicalNotEqual:
      out = cost(0.5 * n, 5);  // half of them are folded into the comparison before
      return true;
    case Op::OpTranspose:
    case Op::OpBitcast:
      out = {};
      return true;
    default:
      return false;
  }
}

/// 16-byte pieces that a load or store touches for one lane: what one instruction moves at most.
double pieces(const Instruction& i) {
  return (i.n + 3) / 4;
}

}  // namespace

bool is_atomic(Word code) {
  switch (static_cast<Op>(code)) {
    case Op::OpAtomicLoad:
    case Op::OpAtomicIAdd:
    case Op::OpAtomicUMin:
    case Op::OpAtomicUMax:
    case Op::OpAtomicOr:
    case Op::OpAtomicAnd:
    case Op::OpAtomicXor:
    case Op::OpAtomicExchange:
    case Op::OpAtomicCompareExchange:
      return true;
    default:
      return false;
  }
}

Cost cost_of(const Instruction& i, const Card& card) {
  const double n = i.n;
  if (i.code >= extended) return cost_of_function(i, card);
  Cost arithmetic;
  if (cost_of_arithmetic(i, card, arithmetic)) return arithmetic;
  if (is_atomic(i.code)) return cost(1, i.n ? card.buffer_atomic : card.shared_atomic);  // i.n: in a buffer
  switch (i.code) {
    case copy:
    case copy_list:
      return {};
    case load_registers:
    case store_registers:
      return cost(n, card.local);
    case load_buffer:
    case store_buffer:
    case load_shared:
    case store_shared:
      return cost(n + pieces(i), 0);
    default:
      break;
  }
  switch (static_cast<Op>(i.code)) {
    case Op::OpAccessChain:
      return i.n ? cost(n + 1, 2 * card.arithmetic) : Cost{};
    case Op::OpPhi:
      return cost(0.3 * n, 0);  // a move, where the compiler does not find one register for both ends
    case Op::OpBranch:
    case Op::OpReturn:
      return cost(1, 0);
    case Op::OpBranchConditional:
      return cost(2, 0);
    case Op::OpSwitch:
      return cost(3, 0);
    case Op::OpLabel:
    case Op::OpControlBarrier:
    case Op::OpMemoryBarrier:
      return {};
    case Op::OpVectorExtractDynamic:
      return cost(n, 20);
    default:
      return cost(n, card.arithmetic);
  }
}

}  // namespace bin_scenes::meter
