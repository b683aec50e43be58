// Sections for a newer compiler, switched off; with an apostrophe in the text that is skipped.
//@ prints: old way
#pragma TI_COMPILER
#include "KMotionDef.h"

#if 0
    printf("doesn't work yet);
#endif

#ifdef __TI_COMPILER_VERSION__
#error this isn't for the old compiler
#else the old compiler
main()
{
    printf("old way\n");
}
#endif __TI_COMPILER_VERSION__
//@ cycles: 1905
