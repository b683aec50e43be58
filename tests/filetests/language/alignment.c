// Alignments asked for: members, structures, global, static and local variables.
//@ prints: 16 8 32 16 8
//@ prints: 0 0 0 0
//@ prints: 16 64 4
#include "KMotionDef.h"

struct cell { char tag; int value __attribute__((aligned(8))); };
struct line { char text[3]; } __attribute__((aligned(16)));
struct slot { char a; _Alignas(16) char b; };

char before;
char buffer[10] __attribute__((__aligned__(64)));
_Alignas(double) char area[8];

main()
{
    static char odd;
    static _Alignas(128) char table[3];
    char filler = 1;
    char local[5] __attribute__((aligned(32)));
    local[0] = filler + odd;
    printf("%d %d %d %d %d\n", sizeof(struct cell), (int)&((struct cell *)0)->value, sizeof(struct slot),
        sizeof(struct line), _Alignof(struct cell));
    printf("%d %d %d %d\n", (int)buffer & 63, (int)area & 7, (int)table & 127, (int)local & 31);
    printf("%d %d %d\n", __alignof__(struct line), __alignof__(buffer), __alignof__(filler + 0));
}
//@ cycles: 27467
