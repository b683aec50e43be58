// cc67: run
//
// biquad.c - computing a servo filter and loading it into an axis.
//
//   cc67 run c-programs/filters/biquad.c
//
// Each axis has three filters of second order in its servo loop:
//
//     y = B0 x + B1 x' + B2 x" + A1 y' + A2 y"
//
// where ' is one tick and " two ticks ago. A low pass of second order in s becomes
// such a filter by Tustin's rule, with the frequency warped beforehand so that the
// corner stays where it was. Q is the damping here, the factor of the middle term of
// the low pass in s: 1.4 is just free of resonance, less rings.
//
// Expect the coefficients of a 100 Hz low pass with Q 1.4, a gain of 1 for a
// constant input, a step that overshoots by 5 %, and no filter again after the end.

#include "KMotionDef.h"

#define AXIS 0

void LowPass(IIR *f, double Hz, double Q)
{
    double w = 1.0 / tan(PI * Hz * TIMEBASE);
    double a0 = w * w + Q * w + 1.0;

    f->B0 = 1.0 / a0;
    f->B1 = 2.0 / a0;
    f->B2 = 1.0 / a0;
    f->A1 = 2.0 * (w * w - 1.0) / a0;
    f->A2 = -(w * w - Q * w + 1.0) / a0;
    f->d0 = f->d1 = 0.0f;
}

void Bypass(IIR *f)
{
    f->B0 = 1.0f;
    f->B1 = f->B2 = f->A1 = f->A2 = 0.0f;
    f->d0 = f->d1 = 0.0f;
}

// The same steps as the servo does in each tick.
float Step(IIR *f, float x)
{
    float w = x + f->A1 * f->d0 + f->A2 * f->d1;
    float y = f->B0 * w + f->B1 * f->d0 + f->B2 * f->d1;

    f->d1 = f->d0;
    f->d0 = w;
    return y;
}

main()
{
    int i;
    float y, Peak = 0.0f;
    IIR *f = &chan[AXIS].iir[2];

    LowPass(f, 100.0, 1.4);
    printf("B0 %f B1 %f B2 %f\n", f->B0, f->B1, f->B2);
    printf("A1 %f A2 %f\n", f->A1, f->A2);
    printf("gain at rest %.3f\n", (f->B0 + f->B1 + f->B2) / (1.0f - f->A1 - f->A2));

    for (i = 0; i < 400; i++)
    {
        y = Step(f, 1.0f);
        if (y > Peak) Peak = y;
    }
    printf("step: peak %.2f, end %.2f\n", Peak, y);

    Bypass(f);
}
