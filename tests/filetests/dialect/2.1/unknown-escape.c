//@ exit: 1
//@ says: for a backslash
#include "KMotionDef.h"

char *path = "C:\Program"; //~ error: \P

main() { }
