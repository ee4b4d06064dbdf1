/// Instructions in functions. Pointers that are known become places, memory accesses say which words they touch.
#include "races/decoder.hpp"

#include <stdexcept>
#include <string>

namespace bin_scenes::races {

void Decoder::instruction(Op op, const Word* o, Word n) {
  if (op != Op::OpNop && op != Op::OpNoLine) ++module_.instructions;
  switch (op) {
    case Op::OpAccessChain:
    case Op::OpInBoundsAccessChain:
      return access_chain(o, n);
    case Op::OpLoad:
      return load(o);
    case Op::OpStore:
      return store(o);
    case Op::OpCompositeExtract: {
      Word type = type_.at(o[2]), at = place(o[2]);
      for (Word k = 3; k < n; ++k) {
        at += types_.distance(type, o[k], false);
        type = types_.inner(type, o[k]);
      }
      type_[o[1]] = o[0];
      place_[o[1]] = at;
      return;
    }
    case Op::OpCompositeConstruct: {
      std::vector<Word> places;
      for (Word k = 2; k < n; ++k)
        for (Word w = 0; w < types_.at(type_.at(o[k])).words; ++w) places.push_back(place(o[k]) + w);
      const Word to = result(o[0], o[1]);
      emit(copy_list, static_cast<Word>(places.size()), to, 0, 0, list(places));
      return;
    }
    // What follows up to OpNoLine is left by spirv-opt alone.
    case Op::OpCopyObject:
    case Op::OpCopyLogical: {
      type_[o[1]] = o[0];
      place_[o[1]] = place(o[2]);
      if (known_.count(o[2])) known_.insert(o[1]);
      return;
    }
    case Op::OpCompositeInsert: {
      Word type = o[0], at = 0;
      for (Word k = 4; k < n; ++k) {
        at += types_.distance(type, o[k], false);
        type = types_.inner(type, o[k]);
      }
      const Word words = types_.at(o[0]).words, from = place(o[3]);
      const Word part = types_.at(type_.at(o[2])).words, what = place(o[2]);
      const Word to = result(o[0], o[1]);
      emit(copy, words, to, from);
      emit(copy, part, to + at, what);
      return;
    }
    case Op::OpNop:
    case Op::OpNoLine:
      return;
    case Op::OpVectorShuffle: {
      const Word size = types_.at(types_.at(o[0]).element).words, first = types_.at(type_.at(o[2])).count;
      std::vector<Word> places;
      for (Word k = 4; k < n; ++k)
        for (Word w = 0; w < size; ++w)
          places.push_back((o[k] < first ? place(o[2]) + o[k] * size : place(o[3]) + (o[k] - first) * size) + w);
      const Word to = result(o[0], o[1]);
      emit(copy_list, static_cast<Word>(places.size()), to, 0, 0, list(places));
      return;
    }
    case Op::OpPhi: {
      std::vector<Word> from;
      for (Word k = 2; k + 1 < n; k += 2) from.insert(from.end(), {o[k + 1], o[k]});
      const Word to = result(o[0], o[1]), at = list(from);
      for (Word k = 0; k < from.size(); k += 2) phis_.push_back(at + k + 1);
      emit(static_cast<Word>(op), types_.at(o[0]).words, to, static_cast<Word>(from.size() / 2), 0, at);
      return;
    }
    case Op::OpFunctionCall: {
      Call call{static_cast<Word>(module_.code.size()), o[2], {}};
      for (Word k = 3; k < n; ++k) call.arguments.push_back(o[k]);
      calls_.push_back(std::move(call));
      const Word to = result(o[0], o[1]);
      emit(static_cast<Word>(op), 0, to);
      return;
    }
    case Op::OpReturnValue:
      emit(static_cast<Word>(op), types_.at(type_.at(o[0])).words, 0, place(o[0]));
      return;
    case Op::OpReturn:
    case Op::OpUnreachable:
      emit(static_cast<Word>(op), 0, 0);
      return;
    case Op::OpBranch:
      emit(static_cast<Word>(op), 0, 0, 0, o[0]);
      return;
    case Op::OpBranchConditional:
      emit(static_cast<Word>(op), 0, 0, place(o[0]), o[1], o[2]);
      return;
    case Op::OpSwitch: {
      std::vector<Word> cases(o + 2, o + n);
      emit(static_cast<Word>(op), static_cast<Word>(cases.size() / 2), 0, place(o[0]), o[1], list(cases));
      return;
    }
    case Op::OpVectorExtractDynamic:
      emit(static_cast<Word>(op), types_.at(o[0]).words, result(o[0], o[1]), place(o[2]), place(o[3]),
           types_.at(type_.at(o[2])).count);
      return;
    case Op::OpMemoryBarrier:  // that of buffers; memory of the group is ordered by barrier() alone
      if (!(constants_.at(o[1]) & static_cast<Word>(spv::MemorySemanticsMask::UniformMemory))) return;
      [[fallthrough]];
    case Op::OpControlBarrier:
      module_.barriers.push_back(static_cast<Word>(module_.code.size()));
      emit(static_cast<Word>(op), 0, 0);
      return;
    case Op::OpExtInst:
      emit(extended + o[3], types_.components(type_.at(o[4])), result(o[0], o[1]), place(o[4]), n > 5 ? place(o[5]) : 0,
           n > 6 ? place(o[6]) : 0);
      return;
    default:
      return arithmetic(op, o, n);
  }
}

void Decoder::access_chain(const Word* o, Word n) {
  const Type& pointer = types_.at(type_.at(o[2]));
  const bool buffer = in_buffer(pointer.storage);
  Word type = pointer.element, offset = 0;
  std::vector<Word> steps;
  for (Word k = 3; k < n; ++k) {
    const auto index = constants_.find(o[k]);
    if (index != constants_.end()) {
      offset += types_.distance(type, index->second, buffer);
      type = types_.inner(type, index->second);
    } else {
      steps.insert(steps.end(), {place(o[k]), types_.distance(type, 1, buffer)});
      // An index beyond an array of known size is an error of its own; 0: as long as the buffer is.
      steps.push_back(types_.at(type).count);
      type = types_.inner(type, 0);
    }
  }
  if (steps.empty() && known_.count(o[2])) {
    const Word base = place(o[2]);
    return set_pointer(o[0], o[1], module_.registers[base], module_.registers[base + 1] + offset);
  }
  const auto count = static_cast<Word>(steps.size() / 3);
  const Word to = result(o[0], o[1]);
  emit(static_cast<Word>(Op::OpAccessChain), count, to, place(o[2]), offset, list(steps));
}

std::vector<Word> Decoder::parts(Word id, Word type, bool buffer) const {
  const std::vector<Word> layout = types_.layout(type, buffer);
  const bool is_vector = types_.at(type).kind == Op::OpTypeVector;
  const Word used = is_vector ? uses_.components(id, types_.at(type).count) : 0;
  std::vector<Word> parts;
  for (Word k = 0; k < layout.size(); ++k)
    if (!is_vector || (used >> k & 1u)) parts.insert(parts.end(), {k, layout[k]});
  return parts;
}
void Decoder::load(const Word* o) {
  const Type& pointer = types_.at(type_.at(o[2]));
  const Word words = types_.at(o[0]).words, from = place(o[2]), to = result(o[0], o[1]);
  const bool buffer = in_buffer(pointer.storage);
  if (buffer || pointer.storage == StorageClass::Workgroup) {
    const std::vector<Word> read = parts(o[1], o[0], buffer);
    emit(buffer ? load_buffer : load_shared, static_cast<Word>(read.size() / 2), to, from, 0, list(read));
  } else if (known_.count(o[2])) {
    emit(copy, words, to, module_.registers[from + 1]);
  } else {
    emit(load_registers, words, to, from);
  }
}

void Decoder::store(const Word* o) {
  const Type& pointer = types_.at(type_.at(o[0]));
  const Word words = types_.at(pointer.element).words, to = place(o[0]), from = place(o[1]);
  const bool buffer = in_buffer(pointer.storage);
  if (buffer || pointer.storage == StorageClass::Workgroup) {
    std::vector<Word> parts;
    const std::vector<Word> layout = types_.layout(pointer.element, buffer);
    for (Word k = 0; k < layout.size(); ++k) parts.insert(parts.end(), {k, layout[k]});
    emit(buffer ? store_buffer : store_shared, static_cast<Word>(layout.size()), to, from, 0, list(parts));
  } else if (known_.count(o[0])) {
    emit(copy, words, module_.registers[to + 1], from);
  } else {
    emit(store_registers, words, to, from);
  }
}

void Decoder::arithmetic(Op op, const Word* o, Word n) {
  if (op == Op::OpAtomicStore) throw std::runtime_error("atomic store");
  Word count = types_.components(o[0]), b = n > 3 ? place(o[3]) : 0, c = n > 4 ? place(o[4]) : 0;
  const bool wide = types_.is_wide(o[0]);
  switch (op) {
    case Op::OpAtomicIAdd:
    case Op::OpAtomicUMin:
    case Op::OpAtomicUMax:
    case Op::OpAtomicOr:
    case Op::OpAtomicAnd:
    case Op::OpAtomicXor:
    case Op::OpAtomicExchange:
    case Op::OpAtomicCompareExchange:
    case Op::OpAtomicLoad: {
      const bool compares = op == Op::OpAtomicCompareExchange;
      const bool buffer = in_buffer(types_.at(type_.at(o[2])).storage);
      const Word value = op == Op::OpAtomicLoad ? 0 : place(o[compares ? 6 : 5]), other = compares ? place(o[7]) : 0;
      emit(static_cast<Word>(op), buffer, result(o[0], o[1]), place(o[2]), value, other);
      return;
    }
    case Op::OpDot:
    case Op::OpAny:
    case Op::OpAll:
      count = types_.components(type_.at(o[2]));
      break;
    case Op::OpMatrixTimesVector:
      c = types_.at(type_.at(o[2])).count;  // columns
      break;
    case Op::OpVectorTimesMatrix:
      c = types_.components(type_.at(o[2]));  // rows
      break;
    case Op::OpMatrixTimesMatrix:
    case Op::OpTranspose:
      count = types_.at(o[0]).count;  // columns
      c = types_.at(type_.at(o[2])).count;
      if (count != 3 || c != 3 || types_.components(o[0]) != 9) throw std::runtime_error("a matrix that is not 3 x 3");
      break;
    case Op::OpFConvert:
      b = wide;
      break;
    case Op::OpSelect:
      c = c | (types_.components(type_.at(o[2])) == 1 ? 0x80000000u : 0u);
      count = types_.at(o[0]).words;
      break;
    case Op::OpBitcast:
      count = types_.at(o[0]).words;
      break;
    case Op::OpFAdd:
    case Op::OpFSub:
      c = wide;
      break;
    default:
      if (wide) throw std::runtime_error("double precision in instruction " + std::to_string(static_cast<Word>(op)));
  }
  emit(static_cast<Word>(op), count, result(o[0], o[1]), place(o[2]), b, c);
}

}  // namespace bin_scenes::races
