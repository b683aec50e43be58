// cc67: part of slices.c
//
// slices_companion.c - a thread that does nothing but take its turns.

#include "KMotionDef.h"

main()
{
    for (;;) WaitNextTimeSlice();
}
