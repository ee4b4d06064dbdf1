/// From the words of SPIR-V to a Module: everything that is known before a pass runs is worked out here.
#include "races/decoder.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace bin_scenes::races {

Decoder::Decoder(const std::vector<Word>& binary) : binary_(binary) {
  if (binary.size() < 5 || binary[0] != spv::MagicNumber) throw std::runtime_error("no SPIR-V");
  allocate(1);  // place 0: nothing
}

Module Decoder::decode() {
  each([this](Op op, const Word* o, Word n) { uses_.note(op, o, n); });
  each([this](Op op, const Word* o, Word n) { take(op, o, n); });
  for (Instruction& i : module_.code) resolve(i);
  for (const Call& call : calls_) resolve(call);
  module_.entry = functions_.at(entry_);
  return std::move(module_);
}

void Decoder::take(Op op, const Word* o, Word n) {
  if (types_.declare(op, o, n, constants_)) return;
  switch (op) {
    case Op::OpName:
      names_[o[0]] = reinterpret_cast<const char*>(o + 1);
      return;
    case Op::OpDecorate:
      types_.decorate(o);
      if (static_cast<spv::Decoration>(o[1]) == spv::Decoration::Binding) bindings_[o[0]] = o[2];
      if (static_cast<spv::Decoration>(o[1]) == spv::Decoration::BuiltIn) built_ins_[o[0]] = o[2];
      return;
    case Op::OpMemberDecorate:
      return types_.decorate_member(o);
    case Op::OpEntryPoint:
      entry_ = o[1];
      return;
    case Op::OpExecutionMode:
      if (static_cast<spv::ExecutionMode>(o[1]) == spv::ExecutionMode::LocalSize) module_.group_size = o[2];
      return;
    case Op::OpLine:
      line_ = o[1];
      return;
    case Op::OpConstant:
      std::memcpy(&module_.registers[result(o[0], o[1])], o + 2, (n - 2) * sizeof(Word));
      constants_[o[1]] = o[2];
      return;
    case Op::OpConstantTrue:
    case Op::OpConstantFalse:
      module_.registers[result(o[0], o[1])] = op == Op::OpConstantTrue;
      return;
    case Op::OpConstantNull:
    case Op::OpUndef:
      result(o[0], o[1]);
      return;
    case Op::OpConstantComposite: {
      Word at = result(o[0], o[1]);
      for (Word k = 2; k < n; ++k)
        for (Word w = 0; w < types_.at(type_.at(o[k])).words; ++w)
          module_.registers[at++] = module_.registers[place(o[k]) + w];
      return;
    }
    case Op::OpVariable:
      return variable(o, n);
    case Op::OpFunction:
      functions_[o[1]] = static_cast<Word>(module_.code.size());
      function_ = o[1];
      return;
    case Op::OpFunctionParameter:
      parameters_[function_].push_back(result(o[0], o[1]));
      return;
    case Op::OpLabel:
      labels_[o[0]] = static_cast<Word>(module_.code.size());
      emit(static_cast<Word>(op), 0, 0, o[0]);
      return;
    case Op::OpCapability:
    case Op::OpExtInstImport:
    case Op::OpMemoryModel:
    case Op::OpSource:
    case Op::OpSourceExtension:
    case Op::OpString:
    case Op::OpMemberName:
    case Op::OpModuleProcessed:
    case Op::OpFunctionEnd:
    case Op::OpSelectionMerge:
    case Op::OpLoopMerge:
      return;
    default:
      instruction(op, o, n);
  }
}

void Decoder::variable(const Word* o, Word n) {
  const Type& pointer = types_.at(o[0]);
  const Word words = types_.at(pointer.element).words, id = o[1];
  Word block = 0, offset = 0;
  if (in_buffer(pointer.storage)) {
    const Word block_type = pointer.element;
    block = static_cast<Word>(module_.buffers.size());
    module_.buffers.push_back({names_[block_type], bindings_.at(id),
                               types_.has_block_flag(block_type, spv::Decoration::Coherent) ||
                                   types_.has_block_flag(id, spv::Decoration::Coherent),
                               types_.has_block_flag(block_type, spv::Decoration::NonWritable)});
  } else if (pointer.storage == StorageClass::Workgroup) {
    offset = module_.shared_words;
    module_.shared.push_back({names_[id], offset, words});
    module_.shared_words += words;
  } else {
    offset = allocate(words);
    if (pointer.storage == StorageClass::UniformConstant) module_.uniforms.push_back({names_[id], offset, words});
    if (pointer.storage == StorageClass::Input) module_.inputs[built_ins_.at(id)] = {names_[id], offset, words};
  }
  set_pointer(o[0], id, block, offset);
  if (n <= 3) return;
  if (pointer.storage != StorageClass::Function)
    std::copy_n(&module_.registers[place(o[3])], words, &module_.registers[offset]);
  else
    emit(copy, words, offset, place(o[3]));
}

void Decoder::set_pointer(Word type, Word id, Word block, Word offset) {
  const Word at = result(type, id);
  module_.registers[at] = block;
  module_.registers[at + 1] = offset;
  known_.insert(id);
}

void Decoder::resolve(Instruction& i) {
  const auto op = static_cast<Op>(i.code);
  if (op == Op::OpBranch || op == Op::OpSwitch) i.b = labels_.at(i.b);
  for (Word k = 0; op == Op::OpSwitch && k < i.n; ++k)
    module_.lists[i.c + 2 * k + 1] = labels_.at(module_.lists[i.c + 2 * k + 1]);
  if (op == Op::OpBranchConditional) i.b = labels_.at(i.b), i.c = labels_.at(i.c);
}

void Decoder::resolve(const Call& call) {
  const auto parameters = parameters_.find(call.function);
  std::vector<Word> moves;
  for (std::size_t k = 0; k < call.arguments.size(); ++k)
    for (Word w = 0; w < types_.at(type_.at(call.arguments[k])).words; ++w)
      moves.insert(moves.end(), {parameters->second[k] + w, place(call.arguments[k]) + w});
  Instruction& i = module_.code[call.at];
  i.a = functions_.at(call.function);
  i.n = static_cast<std::uint16_t>(moves.size() / 2);
  i.c = list(moves);
}

Module decode(const std::vector<Word>& binary) {
  return Decoder(binary).decode();
}

}  // namespace bin_scenes::races
