//@ prints: a b c d e
#include "KMotionDef.h"
#define LEVEL 3
#define GONE
#undef GONE

main()
{
#if LEVEL > 2 && !UNKNOWN
    printf("a ");
#endif
#ifdef LEVEL
    printf("b ");
#else
    printf("wrong ");
#endif
#ifndef GONE
    printf("c ");
#endif
#if LEVEL == 1
    printf("wrong ");
#elif LEVEL == 3
    printf("d ");
#elif LEVEL == 3
    printf("wrong ");
#else
    printf("wrong ");
#endif
#if defined(LEVEL) && defined LEVEL && (1 ? 2 : 0) == 2
    printf("e\n");
#endif
}
//@ cycles: 3903
