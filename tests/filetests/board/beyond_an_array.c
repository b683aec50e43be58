// An access outside the map says what lies nearby; one inside the program's own memory is not seen.
//@ exit: 3
//@ says: 0x91001000
main()
{
    int *p = (int *)0x91001000;
    return *p;
}
//@ cycles: 3
