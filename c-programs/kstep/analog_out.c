// cc67: run
//
// analog_out.c - the analog output of a KStep, made straight by a table.
//
//   cc67 run --stim c-programs/kstep/analog_out.stim c-programs/kstep/analog_out.c
//
// KStep filters a pulse width signal on bit 44 to a voltage for a spindle inverter. An
// opto coupler on the way makes short pulses longer: the first counts give far more than
// their share, above them the output is a straight line again. Both are measured once;
// the program then looks up the count that comes nearest to the voltage it wants.
//
// The file beside this program connects the output, with a supply of 10 V, to analog
// input 0. Expect raw counts to be wrong by up to 5 % of the full scale, and corrected
// ones by less than 1 %, or half a step of the first counts.

#include "KMotionDef.h"

#define SUPPLY 10.0f
#define FULL   255

// Part of the supply at counts 0 to 7, and at count 240.
float First[8] = { 0.001f, 0.031f, 0.044f, 0.054f, 0.062f, 0.069f, 0.074f, 0.079f };
#define FAR_COUNT 240
#define FAR_PART  0.970f

int CountsFor(float Part)
{
    int i, Counts;

    for (i = 0; i < 7; i++)
    {
        if (Part < 0.5f * (First[i] + First[i + 1])) return i;
    }
    Counts = (int)(7.5f + (Part - First[7]) / (FAR_PART - First[7]) * (FAR_COUNT - 7));
    return Counts > FULL ? FULL : Counts;
}

float Output(int Counts)
{
    FPGA(IO_PWMS) = Counts;
    Delay_sec(0.1);                             // ten time constants of the low pass
    return ADC(0) * 10.0f / 2048.0f;
}

main()
{
    float Part;

    FPGA(KAN_TRIG_REG) = 4;                     // PWM 0 to bit 44
    SetBitDirection(44, 1);
    FPGA(IO_PWMS_PRESCALE) = 46;                // 1.4 kHz
    FPGA(IO_PWMS + 1) = 1;

    printf("wanted     raw  corrected\n");
    for (Part = 0.0f; Part < 0.99f; Part += 0.12f)
    {
        printf("%5.2f V", Part * SUPPLY);
        printf(" %5.2f V", Output((int)(Part * FULL + 0.5f)));
        printf(" %5.2f V\n", Output(CountsFor(Part)));
    }
    Output(0);
}
