/// Which components of a vector that was loaded are ever looked at: of one that is read for its xyz, w is not.
#pragma once

#include "races/module.hpp"

#include <spirv/unified1/spirv.hpp11>

#include <unordered_map>
#include <vector>

namespace bin_scenes::races {

class Uses {
 public:
  void note(spv::Op op, const Word* operands, Word count);
  /// Bits of the components of a vector of `size`.
  Word components(Word id, Word size) const;

 private:
  struct Shuffle {
    Word first, second;        ///< vectors
    std::vector<Word> picked;  ///< components of the two, one behind the other
  };
  std::unordered_map<Word, Word> extracted_;  ///< bits
  std::unordered_map<Word, Word> mentions_;   ///< other than in extractions and shuffles; its own definition is one
  std::unordered_map<Word, std::vector<Shuffle>> shuffles_;
};

}  // namespace bin_scenes::races
