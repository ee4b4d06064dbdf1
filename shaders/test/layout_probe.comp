// Copies every field back, changed so that the fields can be distinguished.
#include "shared/dispatch.h"
#include "shared/layout_probe.h"

layout(local_size_x = 32) in;

layout(std430, binding = 0) readonly buffer Input { LayoutProbe probes[]; };
layout(std430, binding = 1) writeonly buffer Output { LayoutProbe copies[]; };

uniform uint count;

void main() {
  uint i = thread_index();
  if (i >= count) return;
  LayoutProbe p = probes[i];
  p.vector = p.vector.wzyx;
  p.pair = p.pair.yx;
  p.number += 1.0;
  p.word += 2u;
  p.signed_words -= ivec4(1, 2, 3, 4);
  p.two *= 2.0;
  p.tail[0] ^= 1u;
  p.tail[1] ^= 2u;
  p.three = p.three.zxy;
  p.behind += 3u;
  copies[i] = p;
}
