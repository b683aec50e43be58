//@ prints: 2.500000 3
main()
{
    printf("%f %d\n", 2.5, 3); //~ implicit-declaration: printf
}
//@ cycles: 7031
