Lamp(int n)
{
    printf("lamp %d old\n", n);
}

OldStart()
{
    Lamp(5);
}
