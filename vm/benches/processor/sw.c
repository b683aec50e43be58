// A switch of eight cases (c67x.md 7.4).
int sw(int k)
{
    switch (k) {
        case 0: return 10;
        case 1: return 11;
        case 2: return 12;
        case 3: return 13;
        case 4: return 14;
        case 5: return 15;
        case 6: return 16;
        case 7: return 17;
    }
    return k + 1000;
}
