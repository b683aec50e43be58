//@ exit: 1
//@ args: -Werror=lax-text
//@ says: unknown escape `\u`
//@ says: write `\\` for a backslash
main()
{
    fopen("C:\users\data.txt", "rt");
}
