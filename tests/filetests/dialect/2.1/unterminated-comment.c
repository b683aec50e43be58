//@ exit: 1
#include "KMotionDef.h"

main() { }

/* never closed //~ error: comment
