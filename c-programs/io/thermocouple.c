// cc67: run
//
// thermocouple.c - a temperature from a converter on a serial bus that the program clocks itself.
//
//   cc67 run --stim c-programs/io/thermocouple.stim c-programs/io/thermocouple.c
//
// The converter shows 16 bits, the highest one when it is selected and the next one after
// each falling clock. Bits 14 to 3 are the temperature in quarters of a degree, bit 2 is
// set while the thermocouple is open. All edges fit into one slice: a slice is not
// interrupted, so the delays between them are exact.
//
// The file beside this program is the converter: 25.0, 100.0 and 218.5 degrees, then an
// open thermocouple. Expect these, and the time that a reading takes.

#include "KMotionDef.h"

#define SELECT 16
#define CLOCK  17
#define DATA   18

#define HALF_CLOCK 1e-6         // seconds
#define OPEN       0x4

int ReadConverter(void)
{
    int i, Word = 0;

    ClearBit(SELECT);
    for (i = 0; i < 16; i++)
    {
        SetBit(CLOCK);
        Word = (Word << 1) | ReadBit(DATA);
        Delay_sec(HALF_CLOCK);
        ClearBit(CLOCK);
        Delay_sec(HALF_CLOCK);
    }
    SetBit(SELECT);
    return Word;
}

main()
{
    int i, Word;
    double Start;

    SetBit(SELECT);
    ClearBit(CLOCK);
    SetBitDirection(SELECT, 1);
    SetBitDirection(CLOCK, 1);
    SetBitDirection(DATA, 0);

    for (i = 0; i < 4; i++)
    {
        WaitNextTimeSlice();
        Start = Time_sec();
        Word = ReadConverter();
        if (Word & OPEN) printf("open\n");
        else printf("%6.2f degrees, read in %.0f us\n", (Word >> 3) * 0.25, (Time_sec() - Start) * 1e6);
        Delay_sec(0.25);        // the next conversion
    }
}
