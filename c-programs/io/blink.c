// cc67: run
//
// blink.c - the two LEDs of the board, alternating.
//
//   cc67 run c-programs/io/blink.c
//
// Expect four changes, a quarter of a second apart; both LEDs are on at power-up
// and are on again at the end. Outputs can be read back.

#include "KMotionDef.h"

#define CHANGES 4
#define PERIOD  0.25        // seconds

void Show(double T0)
{
    printf("%.2f s: LED0 %s, LED1 %s\n", Time_sec() - T0,
           ReadBit(LED0) ? "on" : "off", ReadBit(LED1) ? "on" : "off");
}

main()
{
    int i;
    double T0 = Time_sec();

    Show(T0);
    for (i = 0; i < CHANGES; i++)
    {
        SetStateBit(LED0, i & 1);
        SetStateBit(LED1, !(i & 1));
        Show(T0);
        WaitUntil(T0 + (i + 1) * PERIOD);
    }

    SetBit(LED0);
    SetBit(LED1);
    Show(T0);
}
