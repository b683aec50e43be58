// feedhold.c - what a feedhold of axes that move by themselves leaves: its state, done or not, kinds of motion.

#include "KMotionDef.h"

void Show(char *At)
{
    printf("%s: state %d, done %d %d, all %d, kinds %d %d\n", At, CS0_StoppingState, CheckDone(0), CheckDone(2),
           CheckDoneXYZABC(), chan[0].LastMotionType, chan[2].LastMotionType);
}

void Hold(char *Moving, char *Held)
{
    Delay_sec(0.1);
    Show(Moving);
    StopCoordinatedMotion();
    Delay_sec(0.2);
    Show(Held);
}

main()
{
    int i;

    for (i = 0; i < 3; i++)
    {
        chan[i].InputMode = NO_INPUT_MODE;
        chan[i].OutputMode = STEP_DIR_MODE;
        chan[i].OutputChan0 = 8 + i;
        chan[i].Vel = 10000.0f;
        chan[i].Accel = 50000.0f;
        chan[i].Jerk = 1e6f;
        EnableAxisDest(i, 0.0);
    }
    DefineCoordSystem(0, 1, 2, -1);

    MoveAtVel(2, -2000.0, 1000.0f);
    Hold("move", "held");
    ResumeCoordinatedMotion();
    Show("resumed");
    Delay_sec(1.0);
    Show("done");

    MoveExp(0, 2000.0, 0.05);
    Hold("approach", "held");
    DisableAxis(1);
    Show("one disabled");
    EnableAxisDest(1, 0.0);
    ClearStopImmediately();
    Show("cleared");

    Jog(0, 500.0);
    Hold("jog", "held");
    ResumeCoordinatedMotion();
    Delay_sec(0.1);
    Show("resumed");

    MoveXYZABC(100.0, 200.0, 300.0, 0.0, 0.0, 0.0);
    Show("three axes");
    StopCoordinatedMotion();
    Delay_sec(0.2);
    Show("held");
    ResumeCoordinatedMotion();
    Delay_sec(0.5);
    Show("done");
}
