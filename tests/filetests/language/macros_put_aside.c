// `#pragma push_macro` and `pop_macro`, also of a name that is not defined.
//@ prints: 2 1 0
#include "KMotionDef.h"

#define SPEED 1
#pragma push_macro("SPEED")
#undef SPEED
#define SPEED 2
int fast = SPEED;
#pragma pop_macro("SPEED")
int slow = SPEED;
#pragma push_macro("LATER")
#define LATER
#pragma pop_macro("LATER")

main()
{
    int defined = 0;
#ifdef LATER
    defined = 1;
#endif
    printf("%d %d %d\n", fast, slow, defined);
}
//@ cycles: 6620
