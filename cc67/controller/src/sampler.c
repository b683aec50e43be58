/* cc67's sampler: copies variables to rows in the gather buffer at a rate, as long as the PC reads them. */
#include "KMotionDef.h"

enum { CELLS = 32, FIRST = MAX_GATHER_DATA / 4 };

struct {
    double interval;
    int rows;
    int count;
    struct { int kind; void *variable; } cells[CELLS];
} cc67_request;

double value_of(int kind, void *variable)
{
    if (kind == GATHER_DOUBLE_TYPE) return *(double *)variable;
    if (kind == GATHER_FLOAT_TYPE) return *(float *)variable;
    return *(int *)variable;
}

main()
{
    volatile unsigned *head = (unsigned *)(gather_buffer + FIRST);
    unsigned written = 0, beat = head[1];
    double next = Time_sec(), heard = next, now = next;
    int i;

    while (now - heard < 3.0)
    {
        double *row = gather_buffer + FIRST + 1 + written % cc67_request.rows * (cc67_request.count + 1);

        *row++ = now;
        for (i = 0; i < cc67_request.count; i++)
            *row++ = value_of(cc67_request.cells[i].kind, cc67_request.cells[i].variable);
        head[0] = ++written;
        next += cc67_request.interval;
        if (next < now) next = now;
        do
        {
            WaitNextTimeSlice();
            now = Time_sec();
        } while (now < next);
        if (head[1] != beat) { beat = head[1]; heard = now; }
    }
}
