#include "races/types.hpp"

#include <algorithm>
#include <stdexcept>

namespace bin_scenes::races {

bool Types::declare(spv::Op op, const Word* operands, Word count, const std::unordered_map<Word, Word>& constants) {
  using spv::Op;
  Type type;
  type.kind = op;
  const Word id = count > 0 ? operands[0] : 0;
  switch (op) {
    case Op::OpTypeVoid:
    case Op::OpTypeFunction:
      break;
    case Op::OpTypeBool:
      type.words = 1;
      break;
    case Op::OpTypeInt:
    case Op::OpTypeFloat:
      type.width = operands[1];
      type.words = type.width / 32;
      break;
    case Op::OpTypeVector:
    case Op::OpTypeMatrix:
      type.element = operands[1];
      type.count = operands[2];
      type.words = type.count * at(type.element).words;
      break;
    case Op::OpTypeArray:
      type.element = operands[1];
      type.count = constants.at(operands[2]);
      type.words = type.count * at(type.element).words;
      type.stride = strides_[id];
      break;
    case Op::OpTypeRuntimeArray:
      type.element = operands[1];
      type.stride = strides_[id];
      break;
    case Op::OpTypeStruct:
      type.members.assign(operands + 1, operands + count);
      type.offsets = offsets_[id];
      type.offsets.resize(type.members.size());
      for (const Word member : type.members) type.words += at(member).words;
      break;
    case Op::OpTypePointer:
      type.storage = static_cast<spv::StorageClass>(operands[1]);
      type.element = operands[2];
      type.words = 2;
      break;
    default:
      return false;
  }
  types_[id] = type;
  return true;
}

void Types::decorate(const Word* operands) {
  const auto decoration = static_cast<spv::Decoration>(operands[1]);
  if (decoration == spv::Decoration::ArrayStride) strides_[operands[0]] = operands[2] / 4;
  flags_[operands[0]].push_back(decoration);
}

void Types::decorate_member(const Word* operands) {
  const auto decoration = static_cast<spv::Decoration>(operands[2]);
  if (decoration == spv::Decoration::Offset) {
    std::vector<Word>& offsets = offsets_[operands[0]];
    offsets.resize(std::max<std::size_t>(offsets.size(), operands[1] + 1));
    offsets[operands[1]] = operands[3] / 4;
  } else if (decoration == spv::Decoration::MatrixStride) {
    throw std::runtime_error("a matrix in a buffer");
  } else {
    flags_[operands[0]].push_back(decoration);
  }
}

Word Types::components(Word id) const {
  const Type& type = at(id);
  const bool many = type.kind == spv::Op::OpTypeVector || type.kind == spv::Op::OpTypeMatrix;
  return many ? type.count * components(type.element) : 1;
}

const Type& Types::scalar(Word id) const {
  const Type& type = at(id);
  return type.kind == spv::Op::OpTypeVector || type.kind == spv::Op::OpTypeMatrix ? scalar(type.element) : type;
}

Word Types::inner(Word id, Word index) const {
  const Type& type = at(id);
  return type.kind == spv::Op::OpTypeStruct ? type.members.at(index) : type.element;
}

Word Types::distance(Word id, Word index, bool in_buffer) const {
  const Type& type = at(id);
  if (type.kind == spv::Op::OpTypeStruct) {
    if (in_buffer) return type.offsets.at(index);
    Word before = 0;
    for (Word i = 0; i < index; ++i) before += at(type.members[i]).words;
    return before;
  }
  const bool is_array = type.kind == spv::Op::OpTypeArray || type.kind == spv::Op::OpTypeRuntimeArray;
  return index * (is_array && in_buffer ? type.stride : at(type.element).words);
}

std::vector<Word> Types::layout(Word id, bool in_buffer) const {
  std::vector<Word> words;
  lay_out(id, 0, in_buffer, words);
  return words;
}

void Types::lay_out(Word id, Word at_word, bool in_buffer, std::vector<Word>& words) const {
  const Type& type = at(id);
  const auto count = type.kind == spv::Op::OpTypeStruct ? static_cast<Word>(type.members.size()) : type.count;
  if (count == 0) {
    for (Word k = 0; k < type.words; ++k) words.push_back(at_word + k);
    return;
  }
  for (Word i = 0; i < count; ++i) lay_out(inner(id, i), at_word + distance(id, i, in_buffer), in_buffer, words);
}

bool Types::has_block_flag(Word id, spv::Decoration flag) const {
  const auto flags = flags_.find(id);
  return flags != flags_.end() && std::find(flags->second.begin(), flags->second.end(), flag) != flags->second.end();
}

}  // namespace bin_scenes::races
