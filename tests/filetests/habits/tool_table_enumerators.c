// A tool changer whose two state lists share names; the second list changes one number.
//@ prints: magazine at pocket 3
//@ prints: state 1 then 4
//@ prints: unlock is 4 here
#include "KMotionDef.h"

enum ChangerStates { IDLE, UNLOCK, TURN, LOCK };

int ChangerState = IDLE;

int FirstStep()
{
    return UNLOCK;
}

// Pasted from the documentation of the drawbar, with one step more.
enum DrawbarStates { IDLE, RELEASE = 3, UNLOCK, CLAMP }; //~ redeclared: UNLOCK

int NextStep()
{
    return UNLOCK;
}

main()
{
    int pocket = 3;
    printf("magazine at pocket %d\n", pocket);
    ChangerState = FirstStep();
    printf("state %d then %d\n", ChangerState, NextStep());
    if (UNLOCK == 4) printf("unlock is %d here\n", UNLOCK);
}
//@ cycles: 17919
