// cc67: run
//
// jog_wheel.c - a hand wheel on an encoder input moves an axis.
//
//   cc67 run --stim c-programs/io/jog_wheel.stim c-programs/io/jog_wheel.c
//
// The wheel is an axis without a motor: only its position is used. A wheel with 100
// clicks gives 400 counts a turn. In every slice the axis is sent on by what the wheel
// has turned, times the factor of the range switch, while the enable button is held.
// By MoveExp, which may be called in every slice: a Move that is called while the axis
// moves is planned for 1.8 ms first, at the speed that the axis has.
//
// The file beside this program is the operator: a turn forward, half a turn back with the
// button released, and another turn at ten times the range. Expect 400, 400 and 4400.

#include "KMotionDef.h"

#define WHEEL  3
#define AXIS   0
#define ENABLE 136
#define TIMES10 137
#define TAU    0.02                 // seconds for 63 percent of the way

void InitAxes(void)
{
    chan[WHEEL].InputMode = ENCODER_MODE;
    chan[WHEEL].OutputMode = NO_OUTPUT_MODE;

    chan[AXIS].InputMode = NO_INPUT_MODE;
    chan[AXIS].OutputMode = STEP_DIR_MODE;
    chan[AXIS].Vel = 50000.0;
    chan[AXIS].Accel = 500000.0;
    chan[AXIS].Jerk = 1e7;
    EnableAxisDest(AXIS, 0.0);
}

main()
{
    double Last, Turned, Target = 0.0, Report = 1.0;

    InitAxes();
    Last = chan[WHEEL].Position;
    while (Report < 3.5)
    {
        WaitNextTimeSlice();
        Turned = chan[WHEEL].Position - Last;
        Last += Turned;
        if (Turned != 0.0 && ReadBit(ENABLE))
        {
            Target += Turned * (ReadBit(TIMES10) ? 10.0 : 1.0);
            MoveExp(AXIS, Target, TAU);
        }
        if (Time_sec() >= Report)
        {
            printf("%.0f s: axis at %.0f\n", Report, chan[AXIS].Dest);
            Report += 1.0;
        }
    }
    DisableAxis(AXIS);
}
