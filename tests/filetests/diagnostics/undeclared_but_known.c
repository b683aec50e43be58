//@ exit: 0
//@ prints: 5
//@ snapshot

main()
{
    printf("%d\n", strlen("hello"));
}
//@ cycles: 2561
