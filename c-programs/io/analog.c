// cc67: run
//
// analog.c - analog outputs and inputs of a Kanalog board in volts.
//
//   cc67 run c-programs/io/analog.c
//
// An output takes -2048 to 2047 counts and its voltage is inverted: +2047 counts
// are about -10 V. Beyond the range the value wraps around, so it is limited here.
// An input reads -2048 to 2047 counts for -10 to +10 V.
//
// Expect four voltages as they were set, the last one limited, and 0 V at an
// input to which nothing is connected.

#include "KMotionDef.h"

#define OUTPUT 0
#define INPUT  3

float Wanted[4] = { 5.0f, -2.5f, 0.1f, 12.0f };

int CountsFromVolts(float Volts)
{
    float Counts = Volts * (-2048.0f / 10.0f);

    if (Counts > 2047.0f) return 2047;
    if (Counts < -2047.0f) return -2047;
    return (int)Counts;
}

main()
{
    int i, Counts;

    for (i = 0; i < 4; i++)
    {
        Counts = CountsFromVolts(Wanted[i]);
        DAC(OUTPUT, Counts);

        Counts = (DAC_Buffer[OUTPUT] & 0xfff) - 2048;   // what the board will send
        printf("wanted %6.2f V: %5d counts, %6.2f V\n",
               Wanted[i], Counts, KANALOG_CONVERT_DAC_TO_VOLTS(Counts));
    }
    DAC(OUTPUT, 0);

    printf("input %d: %.2f V\n", INPUT, KANALOG_CONVERT_ADC_TO_VOLTS(ADC(INPUT)));
}
