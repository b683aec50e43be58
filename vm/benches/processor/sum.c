// A sum of integers, at least one of them (c67x.md 7.1).
int sum(int *a, int n)
{
    int s = 0;

    do
        s += *a++;
    while (--n);
    return s;
}
