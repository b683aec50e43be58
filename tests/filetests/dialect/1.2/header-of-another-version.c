//@ args: check -I parts/old-header
//@ says: this header is of version "4.32", the board of "4.34"
//@ says: `chan` is declared unlike firmware 4.34 has it
//@ says: its member `InputMode` is at
#include "KMotionDef.h"

main() { SetBit(46); }
