// cc67: run
//
// step_response.c - a step of a servo axis, recorded and printed as a table to draw.
//
//   cc67 run --machine c-programs/gather/step_response.toml c-programs/gather/step_response.c > step.csv
//   cc67 plot step.csv
//
// The gather buffer records in every servo tick, 11111 times a second, what no loop of a
// program can follow. The table has a head with names, so it is drawn with the time as
// its axis. Lines with # are skipped by the plot.
//
// Expect a step of 400 counts with some overshoot, and rest after 0.1 s.

#include "KMotionDef.h"

#define AXIS    0
#define STEP    400.0
#define SAMPLES 1400
#define EVERY   50

void SetupServo(void)
{
    CHAN *ch = &chan[AXIS];

    ch->InputMode = ENCODER_MODE;
    ch->OutputMode = DC_SERVO_MODE;
    ch->OutputChan0 = 0;
    ch->P = 1.0f;
    ch->I = 0.0f;
    ch->D = 50.0f;
    ch->MaxOutput = 230.0f;
    ch->MaxFollowingError = 1e6;
    EnableAxisDest(AXIS, 0.0);
}

void Record(int Samples)
{
    gather.Inject = FALSE;
    gather.list[0].type = GATHER_DOUBLE_TYPE;
    gather.list[0].addr = &chan[AXIS].Position;
    gather.list[1].type = GATHER_FLOAT_TYPE;
    gather.list[1].addr = &chan[AXIS].Output;
    gather.list[2].type = GATHER_END_TYPE;
    gather.bufptr = (double *)0xfffffffc;       // beyond the end: idle
    gather.endptr = gather_buffer + 2 * Samples;
    TriggerGather();
}

main()
{
    int i;
    double Peak = 0.0;

    SetupServo();
    Record(SAMPLES);
    Delay_sec(0.01);
    chan[AXIS].Dest = STEP;
    while (!CheckDoneGather()) WaitNextTimeSlice();

    printf("time,position,output\n");
    for (i = 0; i < SAMPLES; i++)
    {
        if (gather_buffer[2 * i] > Peak) Peak = gather_buffer[2 * i];
        if (i % EVERY == 0) printf("%.4f,%.0f,%.1f\n", i * TIMEBASE, gather_buffer[2 * i], gather_buffer[2 * i + 1]);
    }
    printf("# overshoot %.0f %%\n", 100.0 * (Peak - STEP) / STEP);
    DisableAxis(AXIS);
}
