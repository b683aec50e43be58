// cc67: run
//
// at_speed.c - waiting until the spindle has its speed, with a time limit.
//
//   cc67 run --machine c-programs/spindle/at_speed.toml c-programs/spindle/at_speed.c
//
// A tool that enters the material too early breaks. The encoder of the spindle tells the
// true speed; the program continues when it has stayed within 3 % for a quarter of a second.
// The machine file beside this program has a spindle that takes its time: each 0.8 s two
// thirds of what is missing.
//
// Expect about 1500 rpm after about three seconds, and no success at 4000 rpm: the inverter
// reaches 3000.

#include "KMotionDef.h"

#define DRIVE      7                // analog output as an axis
#define ENCODER    6
#define COUNTS     4096.0f          // of a turn
#define FULL_SCALE 3000.0           // rpm at 2047 counts of the output
#define TIME_OUT   8.0

void Setup(void)
{
    CHAN *ch = &chan[DRIVE];

    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = DAC_SERVO_MODE;
    ch->OutputChan0 = 0;
    ch->P = ch->I = ch->D = 0.0f;
    ch->FFVel = 1.0f;                   // the commanded speed is the output
    ch->MaxOutput = 2047.0f;
    ch->Accel = 1e6f;
    ch->Jerk = 1e9f;
    EnableAxisDest(DRIVE, 0.0);

    chan[ENCODER].InputMode = ENCODER_MODE;
    ConfigureSpindle(1, ENCODER, 0.1f, 0.05f, COUNTS);
}

double Rpm(void)
{
    return 60.0 * Spindle.TrueSpeedRPS;
}

int WaitForSpeed(double Wanted)
{
    double Now = Time_sec(), Limit = Now + TIME_OUT, GoodSince = Now;

    while (Now - GoodSince < 0.25)
    {
        Now = WaitNextTimeSlice();
        if (Now > Limit) return FALSE;
        if (fast_fabs(Rpm() - Wanted) > 0.03 * Wanted) GoodSince = Now;
    }
    return TRUE;
}

void Command(double Wanted)
{
    double Start = Time_sec();

    Jog(DRIVE, Wanted / FULL_SCALE * 2047.0);
    if (WaitForSpeed(Wanted)) printf("%.0f rpm after %.1f s\n", Rpm(), Time_sec() - Start);
    else printf("%.0f rpm is not reached: %.0f rpm\n", Wanted, Rpm());
}

main()
{
    Setup();
    Command(1500.0);
    Command(4000.0);
    Jog(DRIVE, 0.0);
}
