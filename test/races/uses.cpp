#include "races/uses.hpp"

#include <algorithm>

namespace bin_scenes::races {

void Uses::note(spv::Op op, const Word* o, Word n) {
  using spv::Op;
  switch (op) {
    case Op::OpCompositeExtract:
      extracted_[o[2]] |= 1u << std::min<Word>(o[3], 31);
      return;
    case Op::OpVectorShuffle:
      for (const Word id : {o[2], o[3]}) shuffles_[id].push_back({o[2], o[3], {o + 4, o + n}});
      return;
    case Op::OpLine:
    case Op::OpName:
    case Op::OpMemberName:
    case Op::OpString:
    case Op::OpSource:
      return;
    default:  // a number that happens to be the same only means that more is taken as looked at
      for (Word k = 0; k < n; ++k) ++mentions_[o[k]];
  }
}

Word Uses::components(Word id, Word size) const {
  const Word all = (1u << size) - 1;
  const auto mentions = mentions_.find(id);
  if (mentions != mentions_.end() && mentions->second > 1) return all;
  const auto extracted = extracted_.find(id);
  Word bits = extracted == extracted_.end() ? 0 : extracted->second;
  const auto shuffles = shuffles_.find(id);
  if (shuffles == shuffles_.end()) return bits;
  for (const Shuffle& shuffle : shuffles->second) {
    if (shuffle.first != id) return all;  // where its components begin is not known here
    for (const Word k : shuffle.picked)
      if (k < size || shuffle.second == id) bits |= 1u << k % size;
  }
  return bits;
}

}  // namespace bin_scenes::races
