// cc67: run
//
// digital.c - inputs, outputs and their direction.
//
//   cc67 run c-programs/io/digital.c
//
// A pin has a direction and a latch. Writing to a pin that is an input changes the
// latch only; the level appears when the pin becomes an output. So a valve output
// is cleared first and made an output afterwards, and never flickers.
//
// Expect the direction 0 and then 1, the latch set while still an input, and the
// pattern 1 0 1 1 on four outputs in a row.

#include "KMotionDef.h"

#define VALVE   20          // a pin of connector JP4
#define FIRST   16          // four outputs in a row, also JP4
#define PATTERN 0xD         // lowest bit first: 1 0 1 1

void SafeOutput(int Bit)
{
    ClearBit(Bit);
    SetBitDirection(Bit, 1);
}

main()
{
    int i;

    printf("valve: direction %d, level %d\n", GetBitDirection(VALVE), ReadBit(VALVE));
    SetBit(VALVE);
    printf("latch set: direction %d, level %d\n", GetBitDirection(VALVE), ReadBit(VALVE));
    SetBitDirection(VALVE, 1);
    printf("made an output: direction %d, level %d\n", GetBitDirection(VALVE), ReadBit(VALVE));

    for (i = 0; i < 4; i++)
    {
        SafeOutput(FIRST + i);
        SetStateBit(FIRST + i, (PATTERN >> i) & 1);
    }
    for (i = 0; i < 4; i++) printf("%d ", ReadBit(FIRST + i));
    printf("\n");
}
