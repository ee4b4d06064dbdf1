/// Types of a SPIR-V module, and where the words of a value lie in buffers.
#pragma once

#include "races/module.hpp"

#include <spirv/unified1/spirv.hpp11>

#include <unordered_map>
#include <vector>

namespace bin_scenes::races {

struct Type {
  spv::Op kind = spv::Op::OpTypeVoid;
  Word width = 32;              ///< bits of a number
  Word element = 0, count = 0;  ///< of vectors, matrices, arrays (count 0: as many as the buffer holds); pointers
  std::vector<Word> members, offsets;  ///< of structs; offsets in buffers (words)
  Word stride = 0;                     ///< of arrays in buffers (words)
  spv::StorageClass storage = spv::StorageClass::Function;
  Word words = 0;  ///< of a value in registers
};

class Types {
 public:
  /// Takes an OpType... instruction; false if it is none.
  bool declare(spv::Op op, const Word* operands, Word count, const std::unordered_map<Word, Word>& constants);
  void decorate(const Word* operands);         // OpDecorate
  void decorate_member(const Word* operands);  // OpMemberDecorate

  const Type& at(Word id) const { return types_.at(id); }
  /// Components of a scalar or vector; columns times rows of a matrix.
  Word components(Word id) const;
  /// Scalar at the bottom of vectors and matrices.
  const Type& scalar(Word id) const;
  bool is_wide(Word id) const { return scalar(id).width == 64; }

  /// Type and distance (words) of an element or member, in a buffer or without gaps.
  Word inner(Word id, Word index) const;
  Word distance(Word id, Word index, bool in_buffer) const;
  /// By register word, the word in memory.
  std::vector<Word> layout(Word id, bool in_buffer) const;

  bool has_block_flag(Word id, spv::Decoration flag) const;  ///< on the struct or its first member

 private:
  void lay_out(Word id, Word at, bool in_buffer, std::vector<Word>& words) const;

  std::unordered_map<Word, Type> types_;
  std::unordered_map<Word, Word> strides_;
  std::unordered_map<Word, std::vector<Word>> offsets_;
  std::unordered_map<Word, std::vector<spv::Decoration>> flags_;
};

}  // namespace bin_scenes::races
