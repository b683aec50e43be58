// What `exit` calls before the thread ends, the last registered first. A return from `main` is no `exit`: the
// image stays alive behind it.

//@ atexit + exit
void ThreadDone(void);

static void (*registered[32])(void);
static int registrations;

int atexit(void (*function)(void))
{
    if (registrations == 32) {
        return -1;
    }
    registered[registrations++] = function;
    return 0;
}

void exit(int status)
{
    (void)status;
    while (registrations > 0) {
        registered[--registrations]();
    }
    ThreadDone();
}
