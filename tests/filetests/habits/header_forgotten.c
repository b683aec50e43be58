// A helper that was compiled alone and lacks the header.
//@ args: check
//@ exit: 1
//@ says: is `KMotionDef.h` included?
SaveOffset(int n)
{
    persist.UserData[n] = chan[0].Dest; //~ error: persist //~ error: chan
}

main()
{
    SaveOffset(5);
}
