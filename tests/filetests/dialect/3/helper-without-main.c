//@ exit: 1
//@ says: main
//@ says: helper-without-main.user.c
#include "KMotionDef.h"

helper() { return 7; }
