// cc67: run
//
// software_pwm.c - an analog voltage from two outputs of a Konnect board and a low pass.
//
//   cc67 run --stim c-programs/konnect/software_pwm.stim c-programs/konnect/software_pwm.c
//
// One output charges a capacitor through a resistor, the other one discharges it. The
// program computes the capacitor's voltage from what it switched last, and switches so
// that it is closest to the set voltage when it is read again, in its next slice
// 0.18 ms later. A step of charging and one of draining differ by up to 0.07 V: half of
// that is the ripple that remains.
//
// What is decided in one slice is reached in the next, and measured in the one after
// that: so the voltage measured now belongs to the sine of two slices before.
//
// The file beside this program connects such a low pass to board 0 on JP4, and its
// voltage to analog input 0. Expect the measured sine of 5 Hz and 3 V to stay within 2 %
// of the set voltage.

#include "KMotionDef.h"

#define OHMS     100.0
#define FARADS   290e-6
#define SUPPLY   11.23
#define CHARGE   62             // output 14 of the board
#define DRAIN    63             // output 15

#define MEAN     5.0
#define SWING    3.0
#define HZ       5.0

double Computed;                // the voltage as it should be now
int Charging;

void Drive(int Charge)
{
    ClearBit(Charge ? DRAIN : CHARGE);
    SetBit(Charge ? CHARGE : DRAIN);
    Charging = Charge;
}

double Measured(void)
{
    return ADC(0) * 10.0 / 2048.0;
}

main()
{
    double T, Last, Start, Part, Error, Largest = 0.0;
    double Wanted = MEAN, Before = MEAN, Earlier = MEAN;

    InitAux();
    AddKonnect_Aux0(0, &VirtualBits, VirtualBitsEx);
    Drive(TRUE);

    Start = Last = WaitNextTimeSlice();
    do
    {
        T = WaitNextTimeSlice();
        Part = (T - Last) / (OHMS * FARADS);
        Computed += ((Charging ? SUPPLY : 0.0) - Computed) * Part;
        Last = T;

        Earlier = Before;
        Before = Wanted;
        Wanted = MEAN + SWING * sin((T - Start) * TWO_PI * HZ);
        // Halfway between what charging and what draining will make of it.
        Drive(Computed + (SUPPLY / 2.0 - Computed) * Part < Wanted);

        Error = fast_fabs(Measured() - Earlier);
        if (T - Start > 0.2 && Error > Largest) Largest = Error;    // charged by then
    }
    while (T - Start < 1.0);

    printf("largest error %.3f V, %.1f %% of %.0f V\n", Largest, Largest / SWING * 100.0, SWING);
    printf("within 2 %%: %s\n", Largest < 0.02 * SWING ? "yes" : "no");
    Drive(FALSE);
    InitAux();                  // the outputs stay as they are
}
