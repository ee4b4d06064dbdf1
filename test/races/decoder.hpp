/// Makes a Module of SPIR-V. An implementation detail of decode().
#pragma once

#include "races/module.hpp"
#include "races/types.hpp"
#include "races/uses.hpp"

#include <spirv/unified1/spirv.hpp11>

#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace bin_scenes::races {

using spv::Op;
using spv::StorageClass;

class Decoder {
 public:
  explicit Decoder(const std::vector<Word>& binary);

  Module decode();

 private:
  template <class Take>
  void each(Take take) {
    for (std::size_t at = 5; at < binary_.size(); at += binary_[at] >> 16)
      take(static_cast<Op>(binary_[at] & 0xffffu), binary_.data() + at + 1, (binary_[at] >> 16) - 1);
  }

  Word allocate(Word words) {
    const auto at = static_cast<Word>(module_.registers.size());
    module_.registers.resize(at + words);
    return at;
  }
  Word place(Word id) const { return place_.at(id); }
  Word result(Word type, Word id) {
    type_[id] = type;
    return place_[id] = allocate(types_.at(type).words);
  }
  Instruction& emit(Word code, Word n, Word to, Word a = 0, Word b = 0, Word c = 0) {
    module_.code.push_back({static_cast<std::uint16_t>(code), static_cast<std::uint16_t>(n), to, a, b, c, line_});
    return module_.code.back();
  }
  Word list(const std::vector<Word>& words) {
    const auto at = static_cast<Word>(module_.lists.size());
    module_.lists.insert(module_.lists.end(), words.begin(), words.end());
    return at;
  }
  static bool in_buffer(StorageClass storage) {
    return storage == StorageClass::Uniform || storage == StorageClass::StorageBuffer;
  }

  // decode.cpp: what stands outside of functions
  void take(Op op, const Word* o, Word n);
  void variable(const Word* o, Word n);
  /// A pointer that is known before the pass runs.
  void set_pointer(Word type, Word id, Word block, Word offset);

  /// A function may lie behind those that call it.
  struct Call {
    Word at, function;
    std::vector<Word> arguments;
  };
  void resolve(Instruction& i);
  void resolve(const Call& call);

  // decode_code.cpp: instructions
  void instruction(Op op, const Word* o, Word n);
  void access_chain(const Word* o, Word n);
  /// (word of the value, word of the memory) of all that is looked at.
  std::vector<Word> parts(Word id, Word type, bool buffer) const;
  void load(const Word* o);
  void store(const Word* o);
  void arithmetic(Op op, const Word* o, Word n);

  const std::vector<Word>& binary_;
  Module module_;
  Types types_;
  Uses uses_;
  std::unordered_map<Word, Word> place_, type_, constants_, bindings_, built_ins_, labels_, functions_;
  std::unordered_map<Word, std::string> names_;
  std::unordered_map<Word, std::vector<Word>> parameters_;
  std::unordered_set<Word> known_;  ///< pointers
  std::vector<Call> calls_;
  std::vector<Word> phis_;  ///< ids in lists that may be defined later; resolved to places at the end
  Word entry_ = 0, function_ = 0, line_ = 0;
};

}  // namespace bin_scenes::races
