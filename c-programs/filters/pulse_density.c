// cc67: run
//
// pulse_density.c - an analog voltage from two digital outputs and a filter.
//
//   cc67 run c-programs/filters/pulse_density.c
//
// One output charges a capacitor through a resistor, the other one discharges it.
// The program computes the voltage that the capacitor must have by now and charges
// when it is too low, else discharges. On a machine the two bits are outputs of a
// Konnect board (InitAux and AddKonnect map them to virtual bits).
//
// Expect each voltage to be met within a tenth of a volt.

#include "KMotionDef.h"

#define CHARGE    62            // virtual bits
#define DISCHARGE 63
#define SUPPLY    12.0          // volts
#define RC        0.03          // seconds, resistor times capacitor

double Volts;                   // computed voltage of the capacitor
double LastTime;
int Charging;

void Service(double Wanted, double Now)
{
    double Target = Charging ? SUPPLY : 0.0;

    Volts += (Target - Volts) * (Now - LastTime) / RC;
    LastTime = Now;

    Charging = Volts < Wanted;
    SetStateBit(CHARGE, 0);                 // never both at once
    SetStateBit(DISCHARGE, !Charging);
    SetStateBit(CHARGE, Charging);
}

void Try(double Wanted)
{
    double Now, Sum = 0.0;
    double Begin = WaitNextTimeSlice();
    int n = 0, On = 0;

    do
    {
        Now = WaitNextTimeSlice();
        Service(Wanted, Now);
        if (Now > Begin + 0.2)              // it has settled
        {
            Sum += Volts;
            On += ReadBit(CHARGE);
            n++;
        }
    }
    while (Now < Begin + 0.3);

    printf("%4.1f V wanted: %4.1f V, charging %2.0f %% of the time\n", Wanted, Sum / n, 100.0 * On / n);
}

main()
{
    Volts = 0.0;
    Charging = FALSE;
    LastTime = WaitNextTimeSlice();

    Try(3.0);
    Try(9.0);
    Try(6.0);

    ClearBit(CHARGE);
    ClearBit(DISCHARGE);
}
