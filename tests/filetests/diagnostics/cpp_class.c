//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

class Lamp
{
public:
    void on() { SetBit(46); }
};

main()
{
    Lamp lamp;
    lamp.on();
}
