//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

helper() { return 1; }
