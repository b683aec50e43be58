//@ byte: ü fc
//@ byte: µ e2 82 ac
//@ prints: 4 fc e2 82 ac
#include "KMotionDef.h"

/* für µ */
char text[] = "üµ"; // für

main()
{
    unsigned char *p = (unsigned char *)text;
    printf("%d %x %x %x %x\n", sizeof text - 1, p[0], p[1], p[2], p[3]);
}
//@ cycles: 11665
