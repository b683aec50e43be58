//@ exit: 1
//@ snapshot

main()
{
    persist.UserData[1] = 5;
    CHAN *axis = 0;
}
