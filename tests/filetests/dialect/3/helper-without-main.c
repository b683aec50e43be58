//@ exit: 1
//@ says: no `main`
//@ says: included by helper-without-main.user.c
#include "KMotionDef.h"

helper() { return 7; }
