//@ exit: 1
//@ says: cannot cast `double` to `union number`
union number { float f; int i; };
main()
{
    (union number)1.0;
}
