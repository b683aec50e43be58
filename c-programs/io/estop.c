// cc67: run
//
// estop.c - a safety loop: an emergency stop chain, its relay, and the reset button.
//
//   cc67 run --stim c-programs/io/estop.stim c-programs/io/estop.c
//
// The chain is closed while all is well: its input is high, and a broken wire counts as
// pressed. The program switches the relay that powers the drives and checks with a second
// input that its contact has followed. After a stop the relay comes back only with the
// reset button, and not while the chain is open.
//
// The file beside this program is the machine: contact and chain, an operator who stops,
// resets too early and again, and at last a relay that is stuck. Expect each of them.

#include "KMotionDef.h"

#define CHAIN   136
#define RESET   137
#define CONTACT 138             // of the relay
#define RELAY   152

#define FOLLOW  0.05            // seconds the relay may take

double Switched;

void Relay(int On)
{
    SetStateBit(RELAY, On);
    Switched = Time_sec();
}

main()
{
    int On, Pressed, Before = FALSE;

    Relay(TRUE);
    printf("drives on\n");
    for (;;)
    {
        WaitNextTimeSlice();
        On = ReadBit(RELAY);
        Pressed = ReadBit(RESET);

        if (On && !ReadBit(CHAIN))
        {
            Relay(FALSE);
            DisableAxis(0);
            printf("%.2f s: emergency stop, drives off\n", Time_sec());
        }
        else if (!On && Pressed && !Before)
        {
            if (ReadBit(CHAIN)) Relay(TRUE), printf("%.2f s: reset, drives on\n", Time_sec());
            else printf("%.2f s: reset refused, the chain is open\n", Time_sec());
        }
        Before = Pressed;

        if (ReadBit(CONTACT) != ReadBit(RELAY) && Time_sec() > Switched + FOLLOW) break;
    }
    printf("%.2f s: the relay is stuck, give up\n", Time_sec());
}
