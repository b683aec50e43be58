//@ exit: 1
//@ snapshot
#include "KMotionDeff.h"

main() { }
