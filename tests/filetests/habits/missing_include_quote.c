// Somebody lost the closing quote of the include; the vendor's compiler does not mind.
//@ prints: surface at -1.25
#include "KMotionDef.h
//~^ lax-text: missing `"`

#define PROBE_OFFSET 0.25

main()
{
    double touched = -1.0;
    printf("surface at %.2f\n", touched - PROBE_OFFSET);
}
//@ cycles: 6176
