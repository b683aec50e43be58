// cc67: run
//
// init4.c - four axes on a KStep, its inputs, and amplifiers that go off when nothing moves.
//
//   cc67 run --stim c-programs/kstep/init4.stim c-programs/kstep/init4.c
//
// KStep needs longer pulses of the other polarity, its outputs are numbers 8 to 11, and
// bit 45 enables all its amplifiers. Its 16 inputs appear as bits 168 to 183 once
// KStepPresent is set.
//
// Motors that hold a position get as hot as those that move. The loop watches where the
// axes are sent, enables the amplifiers with the first step and takes the current off a
// second after the last one.
//
// The file beside this program presses a button that asks for a move. Expect the times
// of all changes of the enable signal.

#include "KMotionDef.h"

#define AXES    4
#define ENABLE  45
#define BUTTON  168
#define IDLE    1.0             // seconds

double Last[AXES];

void InitAxis(int Axis)
{
    chan[Axis].InputMode = NO_INPUT_MODE;
    chan[Axis].OutputMode = STEP_DIR_MODE;
    chan[Axis].OutputChan0 = 8 + Axis;
    chan[Axis].Vel = 20000.0;
    chan[Axis].Accel = 100000.0;
    chan[Axis].Jerk = 1e6;
    EnableAxisDest(Axis, 0.0);
    Last[Axis] = 0.0;
}

int Moved(void)
{
    int Axis, Any = FALSE;

    for (Axis = 0; Axis < AXES; Axis++)
    {
        if (chan[Axis].Dest != Last[Axis]) Any = TRUE;
        Last[Axis] = chan[Axis].Dest;
    }
    return Any;
}

void Amplifiers(int On)
{
    if (ReadBit(ENABLE) == On) return;
    SetStateBit(ENABLE, On);
    printf("%.2f s: amplifiers %s\n", Time_sec(), On ? "on" : "off");
}

main()
{
    int Axis, Pressed = FALSE;
    double T, Moving = 0.0;

    KStepPresent = TRUE;
    FPGA(STEP_PULSE_LENGTH_ADD) = 63 + 0x80;
    ClearBit(ENABLE);
    SetBitDirection(ENABLE, 1);
    for (Axis = 0; Axis < AXES; Axis++) InitAxis(Axis);

    do
    {
        T = WaitNextTimeSlice();
        if (ReadBit(BUTTON) && !Pressed)
        {
            printf("%.2f s: button\n", T);
            Move(2, Pressed ? 0.0 : 1000.0);
        }
        Pressed = ReadBit(BUTTON);

        if (Moved()) Moving = T, Amplifiers(TRUE);
        else if (T > Moving + IDLE) Amplifiers(FALSE);
    }
    while (T < 3.0);
    for (Axis = 0; Axis < AXES; Axis++) DisableAxis(Axis);
}
