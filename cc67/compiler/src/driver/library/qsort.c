// Heap sort: no recursion and no more memory, for a stack of two kilobytes.

//@ qsort
static void exchange(char *a, char *b, unsigned size)
{
    while (size-- > 0) {
        char kept = *a;
        *a++ = *b;
        *b++ = kept;
    }
}

// Moves the item at `root` down until both below it are no greater.
static void sift(char *items, unsigned root, unsigned count, unsigned size,
                 int (*compare)(const void *, const void *))
{
    unsigned child;
    while ((child = 2 * root + 1) < count) {
        if (child + 1 < count && compare(items + child * size, items + (child + 1) * size) < 0) {
            child++;
        }
        if (compare(items + root * size, items + child * size) >= 0) {
            return;
        }
        exchange(items + root * size, items + child * size, size);
        root = child;
    }
}

void qsort(void *base, unsigned count, unsigned size, int (*compare)(const void *, const void *))
{
    char *items = base;
    unsigned root = count / 2;
    while (root > 0) {
        sift(items, --root, count, size, compare);
    }
    while (count > 1) {
        exchange(items, items + --count * size, size);
        sift(items, 0, count, size, compare);
    }
}
