// Requests to the PC; included by programs, has no main.
#define REQUEST_AT 62 // free here

int RequestSpeed(int code, double value)
{
    persist.UserData[REQUEST_AT] = code;
    *(float *)&persist.UserData[REQUEST_AT + 1] = value;
}
