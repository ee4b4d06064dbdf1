#include "races/arithmetic.hpp"

#include <spirv/unified1/GLSL.std.450.h>
#include <spirv/unified1/spirv.hpp11>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace bin_scenes::races {

namespace {

float real(Word bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
Word bits(float value) {
  Word word;
  std::memcpy(&word, &value, sizeof word);
  return word;
}
double wide(const Word* words) {
  double value;
  std::memcpy(&value, words, sizeof value);
  return value;
}
void put(double value, Word* words) {
  std::memcpy(words, &value, sizeof value);
}
std::int32_t whole(Word bits) {
  return static_cast<std::int32_t>(bits);
}

/// What lies outside the range is undefined in GLSL; not here, where a cast would be undefined too.
Word to_unsigned(float f) {
  return f >= 4294967296.0f ? 0xffffffffu : f > 0 ? static_cast<Word>(f) : 0u;
}
Word to_signed(float f) {
  return static_cast<Word>(f >= 2147483648.0f   ? 0x7fffffff
                           : f < -2147483648.0f ? std::numeric_limits<std::int32_t>::min()
                                                : static_cast<std::int32_t>(f));
}

/// Matrices lie column by column.
void times_matrix(const Instruction& i, Word* r) {
  float out[9];
  for (Word column = 0; column < 3; ++column)
    for (Word row = 0; row < 3; ++row) {
      float sum = 0;
      for (Word k = 0; k < 3; ++k) sum += real(r[i.a + 3 * k + row]) * real(r[i.b + 3 * column + k]);
      out[3 * column + row] = sum;
    }
  for (Word k = 0; k < 9; ++k) r[i.to + k] = bits(out[k]);
}

}  // namespace

// clang-format off
#define EACH(expression) for (Word k = 0; k < i.n; ++k) { const Word a = r[i.a + k]; (void)a; r[i.to + k] = expression; } return true
#define EACH_OF_TWO(expression) \
  for (Word k = 0; k < i.n; ++k) { const Word a = r[i.a + k], b = r[i.b + k]; r[i.to + k] = expression; } return true
// clang-format on

bool compute(const Instruction& i, Word* r) {
  using spv::Op;
  switch (static_cast<Op>(i.code)) {
    case Op::OpFAdd:
      if (i.c) {
        for (Word k = 0; k < 2u * i.n; k += 2) put(wide(r + i.a + k) + wide(r + i.b + k), r + i.to + k);
        return true;
      }
      EACH_OF_TWO(bits(real(a) + real(b)));
    case Op::OpFSub:
      if (i.c) {
        for (Word k = 0; k < 2u * i.n; k += 2) put(wide(r + i.a + k) - wide(r + i.b + k), r + i.to + k);
        return true;
      }
      EACH_OF_TWO(bits(real(a) - real(b)));
    case Op::OpFMul:
      EACH_OF_TWO(bits(real(a) * real(b)));
    case Op::OpFDiv:
      EACH_OF_TWO(bits(real(a) / real(b)));
    case Op::OpFMod:
      EACH_OF_TWO(bits(real(a) - real(b) * std::floor(real(a) / real(b))));
    case Op::OpFNegate:
      EACH(bits(-real(a)));
    case Op::OpIAdd:
      EACH_OF_TWO(a + b);
    case Op::OpISub:
      EACH_OF_TWO(a - b);
    case Op::OpIMul:
      EACH_OF_TWO(a * b);
    case Op::OpUDiv:
      EACH_OF_TWO(b ? a / b : 0xffffffffu);
    case Op::OpUMod:
      EACH_OF_TWO(b ? a % b : 0xffffffffu);
    case Op::OpSDiv:
      EACH_OF_TWO(b ? static_cast<Word>(whole(a) / whole(b)) : 0xffffffffu);
    case Op::OpSRem:
      EACH_OF_TWO(b ? static_cast<Word>(whole(a) % whole(b)) : 0xffffffffu);
    case Op::OpSMod:
      EACH_OF_TWO(b ? static_cast<Word>((whole(a) % whole(b) + whole(b)) % whole(b)) : 0xffffffffu);
    case Op::OpSNegate:
      EACH(0u - a);
    case Op::OpNot:
      EACH(~a);
    case Op::OpBitwiseAnd:
      EACH_OF_TWO(a & b);
    case Op::OpBitwiseOr:
      EACH_OF_TWO(a | b);
    case Op::OpBitwiseXor:
      EACH_OF_TWO(a ^ b);
    case Op::OpShiftLeftLogical:
      EACH_OF_TWO(b < 32 ? a << b : 0u);
    case Op::OpShiftRightLogical:
      EACH_OF_TWO(b < 32 ? a >> b : 0u);
    case Op::OpShiftRightArithmetic:
      EACH_OF_TWO(static_cast<Word>(whole(a) >> std::min<Word>(b, 31)));
    case Op::OpBitCount:
      EACH(static_cast<Word>(__builtin_popcount(a)));
    case Op::OpBitcast:
      EACH(a);
    case Op::OpConvertUToF:
      EACH(bits(static_cast<float>(a)));
    case Op::OpConvertSToF:
      EACH(bits(static_cast<float>(whole(a))));
    case Op::OpConvertFToU:
      EACH(to_unsigned(real(a)));
    case Op::OpConvertFToS:
      EACH(to_signed(real(a)));
    case Op::OpFConvert:
      for (Word k = 0; k < i.n; ++k) {
        if (i.b)
          put(static_cast<double>(real(r[i.a + k])), r + i.to + 2 * k);
        else
          r[i.to + k] = bits(static_cast<float>(wide(r + i.a + 2 * k)));
      }
      return true;

    case Op::OpIEqual:
      EACH_OF_TWO(a == b);
    case Op::OpINotEqual:
      EACH_OF_TWO(a != b);
    case Op::OpULessThan:
      EACH_OF_TWO(a < b);
    case Op::OpULessThanEqual:
      EACH_OF_TWO(a <= b);
    case Op::OpUGreaterThan:
      EACH_OF_TWO(a > b);
    case Op::OpUGreaterThanEqual:
      EACH_OF_TWO(a >= b);
    case Op::OpSLessThan:
      EACH_OF_TWO(whole(a) < whole(b));
    case Op::OpSLessThanEqual:
      EACH_OF_TWO(whole(a) <= whole(b));
    case Op::OpSGreaterThan:
      EACH_OF_TWO(whole(a) > whole(b));
    case Op::OpSGreaterThanEqual:
      EACH_OF_TWO(whole(a) >= whole(b));
    case Op::OpFOrdEqual:
      EACH_OF_TWO(real(a) == real(b));
    case Op::OpFOrdNotEqual:
      EACH_OF_TWO(real(a) < real(b) || real(a) > real(b));
    case Op::OpFUnordNotEqual:
      EACH_OF_TWO(real(a) != real(b));
    case Op::OpFOrdLessThan:
      EACH_OF_TWO(real(a) < real(b));
    case Op::OpFOrdLessThanEqual:
      EACH_OF_TWO(real(a) <= real(b));
    case Op::OpFOrdGreaterThan:
      EACH_OF_TWO(real(a) > real(b));
    case Op::OpFOrdGreaterThanEqual:
      EACH_OF_TWO(real(a) >= real(b));
    case Op::OpIsNan:
      EACH(std::isnan(real(a)));
    case Op::OpIsInf:
      EACH(std::isinf(real(a)));
    case Op::OpLogicalAnd:
      EACH_OF_TWO(a & b);
    case Op::OpLogicalOr:
      EACH_OF_TWO(a | b);
    case Op::OpLogicalNot:
      EACH(a ^ 1u);
    case Op::OpLogicalEqual:
      EACH_OF_TWO(a == b);
    case Op::OpLogicalNotEqual:
      EACH_OF_TWO(a != b);
    case Op::OpSelect:
      for (Word k = 0; k < i.n; ++k)
        r[i.to + k] = r[i.a + (i.c >> 31 ? 0 : k)] ? r[i.b + k] : r[(i.c & 0x7fffffffu) + k];
      return true;
    case Op::OpAny:
    case Op::OpAll: {
      Word any = 0, all = 1;
      for (Word k = 0; k < i.n; ++k) any |= r[i.a + k], all &= r[i.a + k];
      r[i.to] = static_cast<Op>(i.code) == Op::OpAny ? any : all;
      return true;
    }

    case Op::OpDot: {
      float sum = 0;
      for (Word k = 0; k < i.n; ++k) sum += real(r[i.a + k]) * real(r[i.b + k]);
      r[i.to] = bits(sum);
      return true;
    }
    case Op::OpVectorTimesScalar:
    case Op::OpMatrixTimesScalar:
      for (Word k = 0; k < i.n; ++k) r[i.to + k] = bits(real(r[i.a + k]) * real(r[i.b]));
      return true;
    case Op::OpMatrixTimesVector:
      for (Word row = 0; row < i.n; ++row) {
        float sum = 0;
        for (Word k = 0; k < i.c; ++k) sum += real(r[i.a + i.n * k + row]) * real(r[i.b + k]);
        r[i.to + row] = bits(sum);
      }
      return true;
    case Op::OpVectorTimesMatrix:
      for (Word column = 0; column < i.n; ++column) {
        float sum = 0;
        for (Word k = 0; k < i.c; ++k) sum += real(r[i.a + k]) * real(r[i.b + i.c * column + k]);
        r[i.to + column] = bits(sum);
      }
      return true;
    case Op::OpMatrixTimesMatrix:
      times_matrix(i, r);
      return true;
    case Op::OpTranspose:
      for (Word column = 0; column < 3; ++column)
        for (Word row = 0; row < 3; ++row) r[i.to + 3 * column + row] = r[i.a + 3 * row + column];
      return true;
    default:
      return false;
  }
}

void compute_extended(const Instruction& i, Word* r) {
  const auto each = [&](auto f) {
    for (Word k = 0; k < i.n; ++k) r[i.to + k] = f(r[i.a + k], i.b ? r[i.b + k] : 0, i.c ? r[i.c + k] : 0);
  };
  const auto reals = [&](auto f) { each([&](Word a, Word b, Word) { return bits(f(real(a), real(b))); }); };
  const auto dot = [&](const Word* a, const Word* b) {
    float sum = 0;
    for (Word k = 0; k < i.n; ++k) sum += real(a[k]) * real(b[k]);
    return sum;
  };
  switch (i.code - extended) {
    case GLSLstd450Round:
    case GLSLstd450RoundEven:
      return reals([](float a, float) { return std::nearbyint(a); });
    case GLSLstd450Trunc:
      return reals([](float a, float) { return std::trunc(a); });
    case GLSLstd450FAbs:
      return reals([](float a, float) { return std::abs(a); });
    case GLSLstd450FSign:
      return reals([](float a, float) { return static_cast<float>((a > 0) - (a < 0)); });
    case GLSLstd450Floor:
      return reals([](float a, float) { return std::floor(a); });
    case GLSLstd450Ceil:
      return reals([](float a, float) { return std::ceil(a); });
    case GLSLstd450Fract:
      return reals([](float a, float) { return a - std::floor(a); });
    case GLSLstd450Sin:
      return reals([](float a, float) { return std::sin(a); });
    case GLSLstd450Cos:
      return reals([](float a, float) { return std::cos(a); });
    case GLSLstd450Acos:
      return reals([](float a, float) { return std::acos(a); });
    case GLSLstd450Atan2:
      return reals([](float a, float b) { return std::atan2(a, b); });
    case GLSLstd450Pow:
      return reals([](float a, float b) { return std::pow(a, b); });
    case GLSLstd450Exp:
      return reals([](float a, float) { return std::exp(a); });
    case GLSLstd450Log:
      return reals([](float a, float) { return std::log(a); });
    case GLSLstd450Sqrt:
      return reals([](float a, float) { return std::sqrt(a); });
    case GLSLstd450InverseSqrt:
      return reals([](float a, float) { return 1.0f / std::sqrt(a); });
    case GLSLstd450FMin:
      return reals([](float a, float b) { return b < a ? b : a; });
    case GLSLstd450FMax:
      return reals([](float a, float b) { return a < b ? b : a; });
    case GLSLstd450SAbs:
      return each([](Word a, Word, Word) { return whole(a) < 0 ? 0u - a : a; });
    case GLSLstd450UMin:
      return each([](Word a, Word b, Word) { return std::min(a, b); });
    case GLSLstd450UMax:
      return each([](Word a, Word b, Word) { return std::max(a, b); });
    case GLSLstd450SMin:
      return each([](Word a, Word b, Word) { return whole(a) < whole(b) ? a : b; });
    case GLSLstd450SMax:
      return each([](Word a, Word b, Word) { return whole(a) > whole(b) ? a : b; });
    case GLSLstd450UClamp:
      return each([](Word a, Word b, Word c) { return std::min(std::max(a, b), c); });
    case GLSLstd450SClamp:
      return each(
          [](Word a, Word b, Word c) { return static_cast<Word>(std::min(std::max(whole(a), whole(b)), whole(c))); });
    case GLSLstd450FClamp:
      return each([](Word a, Word b, Word c) { return bits(std::min(std::max(real(a), real(b)), real(c))); });
    case GLSLstd450Fma:
      return each([](Word a, Word b, Word c) { return bits(std::fma(real(a), real(b), real(c))); });
    case GLSLstd450FMix:
      return each([](Word a, Word b, Word c) { return bits(real(a) * (1.0f - real(c)) + real(b) * real(c)); });
    case GLSLstd450Step:
      return reals([](float edge, float x) { return x < edge ? 0.0f : 1.0f; });
    case GLSLstd450FindILsb:
      return each([](Word a, Word, Word) { return a ? static_cast<Word>(__builtin_ctz(a)) : 0xffffffffu; });
    case GLSLstd450FindUMsb:
      return each([](Word a, Word, Word) { return a ? 31u - static_cast<Word>(__builtin_clz(a)) : 0xffffffffu; });
    case GLSLstd450Length:
      r[i.to] = bits(std::sqrt(dot(r + i.a, r + i.a)));
      return;
    case GLSLstd450Distance: {
      float sum = 0;
      for (Word k = 0; k < i.n; ++k) {
        const float apart = real(r[i.a + k]) - real(r[i.b + k]);
        sum += apart * apart;
      }
      r[i.to] = bits(std::sqrt(sum));
      return;
    }
    case GLSLstd450Normalize: {
      const float length = std::sqrt(dot(r + i.a, r + i.a));
      for (Word k = 0; k < i.n; ++k) r[i.to + k] = bits(real(r[i.a + k]) / length);
      return;
    }
    case GLSLstd450Cross: {
      const float a[3] = {real(r[i.a]), real(r[i.a + 1]), real(r[i.a + 2])};
      const float b[3] = {real(r[i.b]), real(r[i.b + 1]), real(r[i.b + 2])};
      r[i.to] = bits(a[1] * b[2] - b[1] * a[2]);
      r[i.to + 1] = bits(a[2] * b[0] - b[2] * a[0]);
      r[i.to + 2] = bits(a[0] * b[1] - b[0] * a[1]);
      return;
    }
    default:
      throw std::runtime_error("GLSL.std.450 function " + std::to_string(i.code - extended));
  }
}

}  // namespace bin_scenes::races
