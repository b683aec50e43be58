// cc67: run
//
// signal_tower.c - red, yellow and green lamps that show what the machine does.
//
//   cc67 run c-programs/io/signal_tower.c
//
// Green: something moves. Yellow: the axes are on and at rest. Red, blinking: an axis that
// should be on is off. The lamps follow the state; nobody has to remember to switch them.
//
// Expect yellow, green while the axis moves, yellow, and red that blinks.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define RED    1044                 // virtual bits in place of outputs
#define YELLOW 1045
#define GREEN  1046
#define AXIS   0
#define HALF   0.25                 // seconds that the red lamp is on or off

int Shown = -1;

void Show(double Now, int Red, int Yellow, int Green)
{
    int Code = Red << 2 | Yellow << 1 | Green;

    SetStateBit(RED, Red);
    SetStateBit(YELLOW, Yellow);
    SetStateBit(GREEN, Green);
    if (Code == Shown) return;
    Shown = Code;
    printf("%.2f s: %s\n", Now, Red ? "red" : Yellow ? "yellow" : Green ? "green" : "dark");
}

void ServiceTower(double Now)
{
    int IsOn = chan[AXIS].Enable, IsMoving = IsOn && !CheckDone(AXIS);

    if (IsOn) Show(Now, 0, !IsMoving, IsMoving);
    else Show(Now, (int)(Now / HALF) % 2, 0, 0);
}

void ServeUntil(double End)
{
    double Now;

    do
    {
        Now = WaitNextTimeSlice();
        ServiceTower(Now);
    }
    while (Now < End);
}

main()
{
    SetupStepAxis(AXIS, 10000.0f, 100000.0f, 1e6f);
    ServeUntil(0.1);
    Move(AXIS, 3000.0);
    ServeUntil(0.8);
    DisableAxis(AXIS);
    ServeUntil(1.6);
}
