//@ args: check
// Every way in which programs share values and look at memory as something else.
#include "KMotionDef.h"

#define RESULT 50
#define POS(i) (*(double *)&persist.UserData[2 * (i)])
#pragma TI_COMPILER

float *speed = &persist.UserData[51];
double *table = (double *)persist.UserData;
double *even = &persist.UserData[60];
int *word = &persist.UserData[199];

union Both { double d; int half[2]; };

enum { IDLE, RUN, STOP };

void Halves(double d)
{
    double copy = d;
    int *low = (int *)&copy;
    persist.UserData[0] = ((int *)&copy)[0];
    persist.UserData[1] = ((int *)&copy)[1];
    persist.UserData[2] = low[1];
}

main()
{
    int i, n;
    unsigned u = 0x80000000;
    unsigned char c = 200;
    float f = 0.1;
    double d = ch0->Position;
    double *last = (double *)0xfffffffc;
    double *p = (double *)gather_buffer;
    int *end = persist.UserData + 200;
    char line[80];
    short s;
    char *text = (char *)gather_buffer + 1000;

    *(float *)&persist.UserData[RESULT] = f;
    *(float *)&persist.UserData[RESULT + 1] = d;
    POS(5) = d;
    table[10] = d + even[0] + table[99];
    ((double *)persist.UserData)[99] = 1;
    for (i = 0; i < 200; i++) persist.UserData[i] = 0;
    for (word = persist.UserData; word < end; word++) *word = 0;
    Halves(d);

    s = c;
    c = i;
    f = d;
    i = d;
    n = ch0->Dest + 0.5;
    if (d == 0.0) n = 1;
    if (c == 200) n++;
    if (u > 5) n--;
    if (p < last) *p++ = d;
    p++;
    FPGA(0x100) = n;
    c = FPGA(0x101);
    text[0] = 'a';
    text[1] = 0;
    sprintf(line, "%d %u %x %f %g %s", n, u, u, d, f, text);
    if (sscanf(line, "%d", &n) == 1) printf("%X\n", n);
    printf("%d %08X %5.2f %lf %0.lf %.17g %s\n", c, u, f, d, d, d, line);
    persist.UserData[RUN] = s, persist.UserData[STOP] = 1;
    (void)i;
}
