//@ exit: 1
//@ snapshot
// Included by main programs of this folder, not compiled by itself.

int Debounce(int bit)
{
    return bit;
}
