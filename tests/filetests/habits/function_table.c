// Buttons with their actions: function pointers in an array of structures.
//@ prints: jog 1
//@ prints: jog -1
//@ prints: stop
//@ prints: 2 of 3 allowed
#include "KMotionDef.h"

typedef struct
{
    int bit;
    void (*action)(int);
    int argument;
    int (*allowed)();
} BUTTON;

void Jogging(int direction) { printf("jog %d\n", direction); }
void Stop(int unused) { printf("stop\n"); }
int Always() { return TRUE; }
int Never() { return FALSE; }

BUTTON Buttons[] = {
    { 1024, Jogging, 1, Always },
    { 1025, Jogging, -1, Never },
    { 1026, Stop, 0, Always },
};

main()
{
    int i, n = sizeof(Buttons) / sizeof(BUTTON), allowed = 0;
    for (i = 0; i < n; i++)
    {
        Buttons[i].action(Buttons[i].argument);
        if ((*Buttons[i].allowed)()) allowed++;
    }
    printf("%d of %d allowed\n", allowed, n);
}
//@ cycles: 14655
