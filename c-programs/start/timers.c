// cc67: run
//
// timers.c - the four ways to tell the time and to wait.
//
//   cc67 run c-programs/start/timers.c
//
// Expect a delay of 0.25 s, five beats that take 0.50 s together however long
// the work between them takes, about 1000 servo ticks in 90 ms, and 0.18 ms
// from one time slice to the next while this is the only user thread.

#include "KMotionDef.h"

#define BEATS 5
#define BEAT  0.1           // seconds from beat to beat

void ShowDelay(void)
{
    double T0 = Time_sec();

    Delay_sec(0.25);
    printf("Delay_sec: %.2f s\n", Time_sec() - T0);
}

// Delays add up their own errors, points in time do not: a steady beat is made
// by adding to the time when the beat was due, not to the time when it came.
void ShowBeat(void)
{
    int i;
    double T0 = Time_sec();
    double Due = T0;

    for (i = 0; i < BEATS; i++)
    {
        Due += BEAT;
        Delay_sec(0.003 * i);       // work of varying length
        WaitUntil(Due);
    }
    printf("WaitUntil: %d beats in %.2f s\n", BEATS, Time_sec() - T0);
}

void ShowTicks(void)
{
    double First = ServoTick;
    int Ticks;

    Delay_sec(1000 * TIMEBASE);
    Ticks = (int)(ServoTick - First);
    printf("ServoTick: about %d ticks of %.0f us\n", (Ticks + 5) / 10 * 10, TIMEBASE * 1e6);
}

void ShowCounter(void)
{
    int Before, Counts;

    WaitNextTimeSlice();
    Before = TIMER0;
    WaitNextTimeSlice();
    Counts = TIMER0 - Before;
    printf("TIMER0:    %.2f ms from slice to slice\n", Counts / CLOCKFREQ * 1000.0);
}

main()
{
    ShowDelay();
    ShowBeat();
    ShowTicks();
    ShowCounter();
}
