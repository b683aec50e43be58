// cc67: run
//
// power.c - laser power in proportion to the speed, so that corners do not burn.
//
//   cc67 run c-programs/laser/power.c
//
// A loop measures how fast the head moves along its path and sets the duty of a pulse width
// output accordingly, a thousand times a second or so. At rest the beam is off. Below the least
// power nothing is marked at all, so a moving head gets at least that.
//
// Expect the duty to rise with the speed, 255 at full speed, and 0 at the end.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define PWM      0
#define PWM_BIT  26
#define FULL     20000.0            // steps a second for full power
#define LEAST    25                 // of 255
#define TICKS    11                 // servo ticks from one look to the next, about 1 ms

void Power(int Value)
{
    FPGA(IO_PWMS + 2 * PWM) = Value;
}

int ValueAt(double Speed)
{
    int Value = (int)(Speed / FULL * IO_PWM_MAX_VALUE + 0.5);

    if (Speed < 1.0) return 0;
    if (Value < LEAST) return LEAST;
    return Value > IO_PWM_MAX_VALUE ? IO_PWM_MAX_VALUE : Value;
}

main()
{
    double X = 0.0, Y = 0.0, DX, DY, Tick, Speed = 0.0, Report;

    SetBitDirection(PWM_BIT, 1);
    FPGA(IO_PWMS_PRESCALE) = 0;
    Power(0);
    FPGA(IO_PWMS + 2 * PWM + 1) = 1;

    SetupStepAxis(0, 16000.0f, 80000.0f, 800000.0f);
    SetupStepAxis(1, 12000.0f, 60000.0f, 600000.0f);
    Move(0, 8000.0);
    Move(1, 6000.0);

    Tick = ServoTick;
    Report = Time_sec();
    while (!CheckDone(0) || !CheckDone(1) || Speed > 0.0)
    {
        // The positions change with each tick: only whole ticks give a true speed.
        while (ServoTick - Tick < TICKS) WaitNextTimeSlice();
        DX = chan[0].Dest - X;
        DY = chan[1].Dest - Y;
        X += DX;
        Y += DY;
        Speed = sqrt(DX * DX + DY * DY) / ((ServoTick - Tick) * TIMEBASE);
        Tick = ServoTick;
        Power(ValueAt(Speed));
        if (Time_sec() >= Report)
        {
            printf("%5.0f steps/s: %3d\n", Speed, ValueAt(Speed));
            Report += 0.1;
        }
    }
    Power(0);
    printf("at the end: %d\n", ValueAt(Speed));
}
