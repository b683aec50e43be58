// cc67: run
//
// thread.c - cutting a thread: a path whose clock is the spindle.
//
//   cc67 run --machine c-programs/machine/thread.toml c-programs/machine/thread.c
//
// The machine file beside this program has a spindle with an encoder on axis 6, driven
// by the analog output of axis 7. The path is planned for 10 revolutions a second; the
// spindle turns at 5, and Z still covers one pitch in each revolution.
//
// Expect the speed, then the pitch again and again, whatever the speed is.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define Z_AXIS       2
#define SPINDLE      6
#define DRIVE        7
#define COUNTS       4096.0f    // of a revolution
#define BASE         10.0       // revolutions a second that the path is planned for
#define PITCH        200.0      // steps
#define TURNS        8.0
#define UNUSED       255

void SetupDrive(void)
{
    CHAN *ch = &chan[DRIVE];

    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = DAC_SERVO_MODE;
    ch->OutputChan0 = 0;
    ch->P = ch->I = ch->D = 0.0f;
    ch->FFVel = 1.0f;               // output: the commanded speed
    ch->MaxOutput = 2047.0f;
    ch->Accel = 1e6f;
    ch->Jerk = 1e9f;
    EnableAxisDest(DRIVE, 0.0);
}

// One segment: Z at a steady speed, as long as the spindle takes for the turns.
void PlanPath(void)
{
    PARAMETRIC_COEFF *s = &ParametricCoeffs[0];

    CoordSystem0 = NULL;
    LastCoordSystem0 = s;
    ParametricIndex = 1;
    CS0_TimeExecuted = 0.0;
    s->trajectory_mode = TRAJECTORY_LINEAR;
    s->x_axis = s->y_axis = s->a_axis = s->b_axis = s->c_axis = s->u_axis = s->v_axis = UNUSED;
    s->z_axis = Z_AXIS;
    s->t = TURNS / BASE;
    s->a = s->b = s->d = 0.0;
    s->c = 1.0 / s->t;
    s->Z.c = TURNS * PITCH;
    s->Z.d = chan[Z_AXIS].Dest;
    ParametricCoeffs[1].trajectory_mode = TRAJECTORY_OFF;
}

double Turns(void)
{
    return chan[SPINDLE].Position / COUNTS;
}

main()
{
    double Turn, Depth;

    SetupDrive();
    SetupStepAxis(Z_AXIS, 40000.0f, 1e6f, 2e7f);
    DefineCoordSystem(-1, -1, Z_AXIS, -1);
    ConfigureSpindle(1, SPINDLE, 0.05f, 0.01f, COUNTS);
    Jog(DRIVE, 1023.5);                     // half the full scale
    Delay_sec(3.0);
    printf("spindle at %.1f revolutions a second\n", Spindle.TrueSpeedRPS);

    PlanPath();
    TrigThreading(BASE);
    CS0_Flushed = TRUE;
    while (chan[Z_AXIS].Dest <= PITCH) WaitNextTimeSlice();      // the first turn
    while (chan[Z_AXIS].Dest < 6.0 * PITCH)
    {
        Turn = Turns();
        Depth = chan[Z_AXIS].Dest;
        while (Turns() < Turn + 1.0) WaitNextTimeSlice();
        printf("one turn: %.0f\n", chan[Z_AXIS].Dest - Depth);
    }
    while (!CheckDoneBuf()) WaitNextTimeSlice();
    printf("end: %.0f\n", chan[Z_AXIS].Dest);
    Jog(DRIVE, 0.0);
    WaitForAxis(DRIVE);
}
