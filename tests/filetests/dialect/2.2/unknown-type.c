//@ exit: 1
//@ says: KMotionDef.h
void limits(CHAN *axis, int side) { axis = 0; } //~ error: CHAN

main() { }
