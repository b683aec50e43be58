// cc67: part of jog_bits.c
//
// jog_panel.c - plays an operator at the jog panel.

#include "KMotionDef.h"
#include "jog_panel.h"

main()
{
    Delay_sec(0.1);
    SetBit(BUTTON_PLUS);
    Delay_sec(0.3);
    SetBit(BUTTON_FAST);
    Delay_sec(0.3);
    ClearBit(BUTTON_PLUS);
    ClearBit(BUTTON_FAST);
    Delay_sec(0.3);
    SetBit(BUTTON_MINUS);
    Delay_sec(0.3);
    SetBit(BUTTON_PLUS);        // both: stop
    Delay_sec(0.2);
    ClearBit(BUTTON_PLUS);
    ClearBit(BUTTON_MINUS);
    SetBit(PANEL_END);
}
