//@ exit: 1
//@ says: unknown escape `\u`
//@ says: write `\\` for a backslash
main()
{
    fopen("C:\users\data.txt", "rt");
}
