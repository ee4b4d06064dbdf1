// Does not compile, at the line below: the message must say so.
layout(local_size_x = 1) in;
#include "shared/dispatch.h"
void main() { nonsense = 1; }
