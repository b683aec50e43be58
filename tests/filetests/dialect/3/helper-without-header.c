//@ exit: 1
//@ says: KMotionDef.h
int request(int n)
{
    persist.UserData[10] = n; //~ error: persist
    return chan[0].Dest; //~ error: chan
}

main() { request(1); }
