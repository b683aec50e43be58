//@ args: check -I parts/old-header
//@ says: its version is 4.32
//@ says: `CHAN.ChanNumber` is at byte 4 there and at 0 in the firmware
#include "KMotionDef.h" //~ header-mismatch: is not the header of firmware 4.34

main() { SetBit(46); }
