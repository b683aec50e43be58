//@ prints: 2.000000
main()
{
    printf("%f\n", sqrt(4)); //~ implicit-declaration: printf //~ implicit-declaration: sqrt
}
//@ cycles: 5346
