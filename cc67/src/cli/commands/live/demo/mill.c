// mill.c - the demonstration of `cc67 live --demo`: three axes are homed, then a rosette is milled.
//
// Press START to mill, open the DOOR to hold, press ESTOP to stop everything (panel.c, thread 2).

#include "KMotionDef.h"
#include "machine.h"

// Runs to the home switch of an axis, backs off slowly, and takes that place as zero.
void Home(int Axis, double Fast)
{
    Jog(Axis, -Fast);
    while (!ReadBit(HOME_X + Axis)) WaitNextTimeSlice();
    Jog(Axis, Fast / 10);
    while (ReadBit(HOME_X + Axis)) WaitNextTimeSlice();
    Jog(Axis, 0);
    while (!CheckDone(Axis)) WaitNextTimeSlice();
    Zero(Axis);
    printf("axis %d is home\n", Axis);
}

void MoveTo(int Axis, double Position)
{
    Move(Axis, Position);
    while (!CheckDone(Axis)) WaitNextTimeSlice();
}

// Where the rosette is at an angle.
double RosetteX(double a) { return 10000 + 5000 * cos(a) + 2600 * cos(2.5 * a); }
double RosetteY(double a) { return 8000 + 5000 * sin(a) - 2600 * sin(2.5 * a); }

void Mill(void)
{
    double Angle = 0.0, Before, Now;

    MoveTo(0, RosetteX(0));
    MoveTo(1, RosetteY(0));
    SetBit(SPINDLE);
    SetBit(COOLANT);
    Delay_sec(0.5);
    MoveTo(2, 500);
    Before = Time_sec();
    while (Angle < 4 * PI)
    {
        Now = WaitNextTimeSlice();
        if (!ReadBit(DOOR)) Angle += 0.6 * (Now - Before);
        Before = Now;
        ch0->Dest = RosetteX(Angle);
        ch1->Dest = RosetteY(Angle);
    }
    MoveTo(2, 4000);
    ClearBit(COOLANT);
    ClearBit(SPINDLE);
}

main()
{
    int i, Parts = 0;

    for (i = 0; i < 3; i++)
    {
        chan[i].InputMode = NO_INPUT_MODE;
        chan[i].OutputMode = STEP_DIR_MODE;
        chan[i].OutputChan0 = 8 + i;
        chan[i].Vel = 8000; chan[i].Accel = 40000; chan[i].Jerk = 400000;
        EnableAxisDest(i, 0);
    }
    SetBitDirection(SPINDLE, 1);
    SetBitDirection(COOLANT, 1);

    Home(2, 3000);
    MoveTo(2, 4000);
    Home(0, 6000);
    Home(1, 6000);
    for (i = 0; i < 3; i++)
    {
        chan[i].SoftLimitNeg = -200;
        chan[i].SoftLimitPos = i == 2 ? 5000 : 20000;
    }

    for (;;)
    {
        printf("part %d: press START\n", Parts + 1);
        while (!ReadBit(START)) WaitNextTimeSlice();
        Mill();
        persist.UserData[10] = ++Parts;
        printf("part %d is done\n", Parts);
    }
}
