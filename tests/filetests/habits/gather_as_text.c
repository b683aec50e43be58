// A line for the PC is put together in the gather buffer, byte by byte, behind a count.
//@ prints: G01 X5 Y-3
//@ prints: 10 characters, first byte 47
#include "KMotionDef.h"

#define TEXT_AT 100

main()
{
    char *p = (char *)gather_buffer + TEXT_AT;
    char *s;
    int n = 0;

    sprintf(p, "G01 X%d Y%d", 5, -3);
    for (s = p; *s; s++) n++;
    ((int *)gather_buffer)[0] = n;
    printf("%s\n", (char *)gather_buffer + TEXT_AT);
    printf("%d characters, first byte %x\n", *(int *)gather_buffer, *p);
}
//@ cycles: 16969
