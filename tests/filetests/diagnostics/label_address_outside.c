//@ exit: 1
//@ says: the address of a label cannot be taken outside a function
//@ says: `goto *` needs the address of a label, not `int`
//@ says: label `nowhere` is used but not defined
void *p = &&here;
main()
{
    int i = 1;
    goto *i;
    p = &&nowhere;
}
