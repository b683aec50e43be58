//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    boolean on = 1;

    pinMode(46, OUTPUT);
    digitalWrite(46, HIGH);
    Serial.print("on");
}
