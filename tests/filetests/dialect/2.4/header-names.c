//@ exit: 1
//@ says: BOOL
#include "KMotionDef.h"

BOOL fine = TRUE;
int *p = NULL;
bool flag; //~ error: bool

main() { fine = FALSE; }
