//@ exit: 3
//@ says: write_to_text.c:7
f() { return 1; }
main()
{
    int *code = (int *)f;
    *code = 0;
}
//@ cycles: 4
