//@ exit: 1
//@ says: an alignment of 12 is not possible
//@ says: use a power of two up to 4096
_Alignas(12) char a;
main()
{
}
