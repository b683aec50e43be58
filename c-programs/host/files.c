// cc67: run
//
// files.c - writing a table to a disk file of the PC and reading it back.
//
//   cc67 run c-programs/host/files.c --files disk
//
// A program can have one file open for writing and one for reading. Each fprintf
// should write one whole line, and each fscanf reads exactly one. The simulator puts
// the PC's disk into the folder that --files names.
//
// Expect four points read as they were written.

#include "KMotionDef.h"

#define FILE_NAME "c:\\Temp\\points.txt"
#define POINTS    4

double X(int i) { return 1.25 * i; }
double Y(int i) { return 10.0 - i * i; }

int WritePoints(void)
{
    int i;
    FILE *f = fopen(FILE_NAME, "wt");

    if (!f) return FALSE;
    for (i = 0; i < POINTS; i++) fprintf(f, "%d,%f,%f\n", i, X(i), Y(i));
    fclose(f);
    return TRUE;
}

int ReadPoints(void)
{
    int i, Number, Good = 0;
    double x, y;
    FILE *f = fopen(FILE_NAME, "rt");

    if (!f) return 0;
    for (i = 0; i < POINTS; i++)
    {
        if (fscanf(f, "%d,%lf,%lf", &Number, &x, &y) != 3) break;
        printf("point %d: X %.3f Y %.3f\n", Number, x, y);
        if (Number == i && x == X(i) && y == Y(i)) Good++;
    }
    fclose(f);
    return Good;
}

main()
{
    if (!WritePoints())
    {
        printf("the file cannot be written\n");
        ThreadDone();
    }
    printf("%d of %d points are right\n", ReadPoints(), POINTS);
}
