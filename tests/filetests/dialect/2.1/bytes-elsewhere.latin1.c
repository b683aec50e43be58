//@ byte: ö f6
//@ exit: 1
#include "KMotionDef.h"

int gröe = 3; //~ error: character `ö` (U+00F6)

main() { }
