// cc67: run
//
// excite.c - an axis that is measured by a resolver which the program excites itself.
//
//   cc67 run --stim c-programs/resolver/excite.stim c-programs/resolver/excite.c
//
// A resolver is a transformer whose two windings show the sine and the cosine of the
// shaft's angle, but only while the current in its coil changes. The program switches the
// coil with an output and converts both windings shortly before it switches again: once
// while the current grows, once while it falls. The difference of the two is free of
// offsets. From each pair the board computes the angle and keeps the position; a turn is
// 1000 units.
//
// The file beside this program connects the resolver and turns its shaft by two and a
// half turns. Expect 2500 units.

#include "KMotionDef.h"

#define COIL 30

int Sine[2], Cosine[2];

// Lets the coil work for two slices, converts, and switches it over.
void HalfPeriod(int Phase)
{
    WaitNextTimeSlice();
    WaitNextTimeSlice();
    Sine[Phase] = ADC(0);
    Cosine[Phase] = ADC(1);
    SetStateBit(COIL, Phase == 0);
    DoResolverInput2(ch0, Cosine[1] - Cosine[0], Sine[1] - Sine[0]);
}

main()
{
    int i;

    ch0->InputMode = USER_INPUT_MODE;
    ch0->OutputMode = NO_OUTPUT_MODE;
    SetBitDirection(COIL, 1);

    for (i = 0; i < 20; i++) HalfPeriod(i & 1);         // until both pairs are measured
    Zero(0);
    printf("at the start: %.0f\n", ch0->Position);

    while (Time_sec() < 0.6) { HalfPeriod(0); HalfPeriod(1); }
    printf("after two and a half turns: %.0f\n", ch0->Position);
}
