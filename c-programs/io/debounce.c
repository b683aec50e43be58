// cc67: run also 2:debounce_switch.c
//
// debounce.c - all inputs read once a slice into a buffer, and cleaned of bouncing.
//
//   cc67 run 1:c-programs/io/debounce.c 2:c-programs/io/debounce_switch.c
//
// The rest of the program looks at the clean word only: it sees the same inputs
// for the whole slice, and every press exactly once. Thread 2 plays a bouncing
// push button and a bouncing limit switch on virtual bits.
//
// Expect four events, and more raw changes than clean ones.

#include "KMotionDef.h"

#define N_INPUTS    2
#define FIRST_INPUT 1024            // virtual bits, see debounce_switch.c
#define END_BIT     1031            // set by the other thread when it has finished
#define STEADY      0.005           // seconds an input must keep its new level

char *Name[N_INPUTS] = { "button", "limit" };

int Raw;                            // one bit an input, as read
int Clean;                          // the same, cleaned
int RawChanges;                     // for comparison only
int CleanChanges;
double Since[N_INPUTS];             // when the raw input last changed

void ReadInputs(double Now)
{
    int i, Mask, Level;

    for (i = 0; i < N_INPUTS; i++)
    {
        Mask = 1 << i;
        Level = ReadBit(FIRST_INPUT + i) ? Mask : 0;

        if (Level != (Raw & Mask))
        {
            Raw ^= Mask;
            Since[i] = Now;
            RawChanges++;
        }
        if (Level != (Clean & Mask) && Now - Since[i] >= STEADY) Clean ^= Mask;
    }
}

void Report(int Changed)
{
    int i;

    for (i = 0; i < N_INPUTS; i++)
    {
        if (Changed & (1 << i))
        {
            printf("%s %s\n", Name[i], (Clean >> i) & 1 ? "on" : "off");
            CleanChanges++;
        }
    }
}

main()
{
    int Before;

    Raw = Clean = RawChanges = CleanChanges = 0;
    VirtualBitsEx[0] = 0;
    StartThread(2);

    while (!ReadBit(END_BIT))
    {
        Before = Clean;
        ReadInputs(WaitNextTimeSlice());
        Report(Before ^ Clean);
    }

    printf("%d clean changes, %s raw ones\n", CleanChanges,
           RawChanges > CleanChanges ? "more" : "as many");
}
