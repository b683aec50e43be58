// cc67: run
//
// table.c - correcting a curved characteristic with a table.
//
//   cc67 run c-programs/util/table.c
//
// The analog speed output of many interfaces is bent at its lower end. Measure it at
// a few settings, put the pairs into a table, and look the setting up for the wanted
// output: straight lines between the points, the ends as limits.
//
// Expect the table's own points to be met, values in between, and limits outside.

#include "KMotionDef.h"

typedef struct
{
    float Output;           // measured, as a part of full scale; must rise
    float Setting;          // PWM counts that gave it
} POINT;

#define POINTS 6

POINT Table[POINTS] =
{
    { 0.002f,   0.0f },
    { 0.040f,   2.0f },
    { 0.065f,   4.0f },
    { 0.080f,   7.0f },
    { 0.500f, 120.0f },
    { 0.970f, 240.0f }
};

float Lookup(POINT *p, int n, float Output)
{
    int i = 1;

    if (Output <= p[0].Output) return p[0].Setting;
    if (Output >= p[n - 1].Output) return p[n - 1].Setting;

    while (p[i].Output < Output) i++;       // now between i-1 and i
    return p[i - 1].Setting + (Output - p[i - 1].Output) *
           (p[i].Setting - p[i - 1].Setting) / (p[i].Output - p[i - 1].Output);
}

void Show(float Output)
{
    printf("output %5.3f: setting %6.2f\n", Output, Lookup(Table, POINTS, Output));
}

main()
{
    int i;
    float Output;

    for (i = 0; i < POINTS; i++) Show(Table[i].Output);
    printf("between and beyond\n");
    for (Output = 0.0f; Output < 1.1f; Output += 0.25f) Show(Output);
}
