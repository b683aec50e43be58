/* cc67's monitor: each start of its thread does one request, answers in the last words of the gather buffer, and ends. */
#include "KMotionDef.h"

enum Kind { READ, SUM, PAUSE, RESUME };
enum { ROOM = 256, REPLY = 2 * MAX_GATHER_DATA - ROOM - 2 };

struct {
    unsigned serial;
    enum Kind kind;
    unsigned address;
    unsigned count;
} cc67_request;

unsigned sum_of(unsigned char *byte, unsigned count)
{
    unsigned sum = 0;
    while (count--) sum = sum * 31 + *byte++;
    return sum;
}

main()
{
    unsigned *reply = (unsigned *)gather_buffer + REPLY, i;
    unsigned *from = (unsigned *)cc67_request.address;

    reply[1] = 0;
    switch (cc67_request.kind)
    {
        case READ:
            for (i = 0; i < cc67_request.count && i < ROOM; i++) reply[2 + i] = from[i];
            break;
        case SUM:
            reply[1] = sum_of((unsigned char *)from, cc67_request.count);
            break;
        case PAUSE:
            PauseThread(cc67_request.address);
            break;
        case RESUME:
            ResumeThread(cc67_request.address);
            break;
    }
    reply[0] = cc67_request.serial;
}
