extern volatile int Parts;
extern double Length;

void Count(double length)
{
    Parts++;
    Length += length;
}
