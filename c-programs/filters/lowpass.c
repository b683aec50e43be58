// cc67: run
//
// lowpass.c - smoothing a noisy reading with a filter of one line.
//
//   cc67 run c-programs/filters/lowpass.c
//
// In every slice the result moves a part of the way to the reading. With the part
// k = 1 - exp(-dt/Tau) the time constant is Tau however often the loop runs.
//
// Expect 63 % after one time constant and 95 % after three, and noise that is
// reduced to less than a tenth.

#include "KMotionDef.h"

#define TAU 0.1             // seconds

typedef struct
{
    double Tau;
    double Value;
    double Time;            // of the last update
} LOWPASS;

LOWPASS Filter;

void Start(LOWPASS *f, double Tau, double Value, double Now)
{
    f->Tau = Tau;
    f->Value = Value;
    f->Time = Now;
}

double Update(LOWPASS *f, double Reading, double Now)
{
    double k = 1.0 - exp((f->Time - Now) / f->Tau);

    f->Time = Now;
    f->Value += k * (Reading - f->Value);
    return f->Value;
}

// The reading jumps from 0 to 1; what does the filter say after n time constants?
void StepResponse(int n)
{
    double Now = WaitNextTimeSlice();
    double End = Now + n * TAU;

    Start(&Filter, TAU, 0.0, Now);
    while (Now < End)
    {
        Now = WaitNextTimeSlice();
        Update(&Filter, 1.0, Now);
    }
    printf("after %d Tau: %.0f %%\n", n, 100.0 * Filter.Value);
}

// Readings that jump between 4 and 6: the filter shall say 5.
void Noise(void)
{
    int i;
    double y, Low = 1e9, High = -1e9;

    Start(&Filter, TAU, 5.0, WaitNextTimeSlice());
    for (i = 0; i < 500; i++)
    {
        y = Update(&Filter, i & 1 ? 6.0 : 4.0, WaitNextTimeSlice());
        if (y < Low) Low = y;
        if (y > High) High = y;
    }
    printf("noise of 2 became %s 0.2\n", High - Low < 0.2 ? "less than" : "at least");
}

main()
{
    StepResponse(1);
    StepResponse(3);
    Noise();
}
