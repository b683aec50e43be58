// cc67: run
//
// terminal.c - a look at all that a Kanalog board has, for the first day with the wiring.
//
//   cc67 run --machine c-programs/kanalog/terminal.toml --stim c-programs/kanalog/terminal.stim c-programs/kanalog/terminal.c
//
// Inputs 128 to 143, outputs 144 to 167, eight analog inputs and eight analog outputs. The
// program shows each input that is on, switches one output and looks at the input that is
// wired to it, and shows the analog inputs: one value, and the range over a tenth of a
// second, from which noise and hum can be seen.
//
// Expect input 128 on, 129 following output 144, 2.5 V at one analog input, and a hum of
// 10 V from peak to peak at another one.

#include "KMotionDef.h"

#define OUTPUT 144
#define INPUT  129

void ShowInputs(void)
{
    int i;

    printf("inputs on:");
    for (i = KAN_INPUTS; i < KAN_INPUTS + KAN_NINPUTS; i++)
    {
        if (ReadBit(i)) printf(" %d", i);
    }
    printf("\n");
}

double Volts(double Counts)
{
    return Counts * 10.0 / 2048.0;
}

void ShowAnalog(int Channel)
{
    int Counts, Low = 4096, High = -4096, First = ADC(Channel);
    double End = Time_sec() + 0.1;

    while (WaitNextTimeSlice() < End)
    {
        Counts = ADC(Channel);
        if (Counts < Low) Low = Counts;
        if (Counts > High) High = Counts;
    }
    if (Low || High) printf("analog %d: %.2f V, range %.2f V\n", Channel, Volts(First), Volts(High - Low));
}

main()
{
    int i;

    Delay_sec(0.01);
    ShowInputs();
    SetBit(OUTPUT);
    Delay_sec(0.01);
    printf("output %d on: input %d is %d\n", OUTPUT, INPUT, ReadBit(INPUT));
    ClearBit(OUTPUT);
    Delay_sec(0.01);
    printf("output %d off: input %d is %d\n", OUTPUT, INPUT, ReadBit(INPUT));
    for (i = 0; i < 8; i++) ShowAnalog(i);
}
