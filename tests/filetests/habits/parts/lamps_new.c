Lamp(int n) //~ redeclared: defined twice
{
    printf("lamp %d new\n", n);
}
