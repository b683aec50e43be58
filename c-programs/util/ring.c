// cc67: run
//
// ring.c - the last values of a signal, their mean, and the middle one that ignores outliers.
//
//   cc67 run c-programs/util/ring.c
//
// A ring keeps the newest N values in an array without moving any of them. The mean of them
// smooths; but one wrong value, as a spark makes, shows in it for N rounds. The median, the
// middle one in order, does not see it at all.
//
// Expect a mean that is spoiled by the outlier, and a median that is not.

#include "KMotionDef.h"

#define N 5

typedef struct
{
    double Value[N];
    int Next, Count;
} RING;

void Put(RING *r, double Value)
{
    r->Value[r->Next] = Value;
    r->Next = (r->Next + 1) % N;
    if (r->Count < N) r->Count++;
}

double Mean(RING *r)
{
    int i;
    double Sum = 0.0;

    for (i = 0; i < r->Count; i++) Sum += r->Value[i];
    return Sum / r->Count;
}

double Median(RING *r)
{
    double Sorted[N], x;
    int i, j;

    for (i = 0; i < r->Count; i++)
    {
        x = r->Value[i];
        for (j = i; j > 0 && Sorted[j - 1] > x; j--) Sorted[j] = Sorted[j - 1];
        Sorted[j] = x;
    }
    return Sorted[r->Count / 2];
}

main()
{
    static RING Ring;
    double Signal[8] = { 10.0, 10.2, 9.9, 55.0, 10.1, 10.0, 9.8, 10.1 };
    int i;

    Ring.Next = Ring.Count = 0;
    for (i = 0; i < 8; i++)
    {
        Put(&Ring, Signal[i]);
        printf("%5.1f  mean %5.2f  median %5.2f\n", Signal[i], Mean(&Ring), Median(&Ring));
    }
}
