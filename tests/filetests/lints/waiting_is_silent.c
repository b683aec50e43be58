//@ args: check
// Every way in which programs wait, poll and serve others for ever.
#include "KMotionDef.h"

#define HOME 136 // the switch

double start;
int flag, count;
double X0;

void Service(void)
{
    count++;
    if (ReadBit(HOME)) flag = 1;
}

Blink()
{
    static n = 0;
    SetStateBit(46, n & 1);
    n++;
}

main()
{
    CHAN *ch = &chan[2];
    int i, state = 0;
    double T0 = Time_sec();

    while (!CheckDone(0));
    while (ReadBit(HOME) == 0)
        ;
    while (X0 == ch->Dest) ;
    while (CS0_TimeExecuted == 0.0) ;
    while (persist.UserData[10]) ;
    do { Blink(); } while (Time_sec() < T0 + 0.01);
    for (i = 0; i < 100000; i++) ;
    while (Time_sec() < T0 + 0.5);
    UserCallBack = Service;

    if (flag)
        ;
    else
        SetBit(46);

    for (;;)
    {
        WaitNextTimeSlice();
        Blink();
        if (ReadBit(137)) state = 1;
        switch (state)
        {
        case 0:
            break;
        case 1:
            Jog(0, 10);
            state = 2;
            // fall through
        case 2:
            if (ch0->Position > 100.0) { Jog(0, 0); state = 0; }
            break;
        }
        if (count == 1000000) break;
    }

    UserCallBack = NULL;
    while (1) ServiceAll();
}

ServiceAll()
{
    persist.UserData[11]++;
};
