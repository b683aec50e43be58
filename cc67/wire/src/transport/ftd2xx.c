/* A library with the functions of ftd2xx that cc67 uses, in place of FTDI's: its one chip is a connection to the TCP port
   in the environment variable FTD2XX_PORT, at which `cc67 serve --listen tcp-raw:PORT` serves a board.

       x86_64-w64-mingw32-gcc -shared -o ftd2xx.dll cc67/wire/src/transport/ftd2xx.c -lws2_32 */

#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <winsock2.h>
#define EXPORT __declspec(dllexport)
#define CALL __stdcall
typedef SOCKET Socket;
#define pending(socket, count) ioctlsocket(socket, FIONREAD, count)
typedef u_long Count;
#else
#include <arpa/inet.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>
#define EXPORT
#define CALL
typedef int Socket;
#define closesocket close
#define pending(socket, count) ioctl(socket, FIONREAD, count)
typedef int Count;
#endif

typedef unsigned int Dword;
typedef Dword Status;

enum { OK = 0, INVALID_HANDLE = 1, NOT_FOUND = 2, NOT_OPENED = 3, IO_ERROR = 4, BY_LOCATION = 4, LOCATION = 0x214 };

static Socket chip;
static int is_open;

EXPORT Status CALL FT_CreateDeviceInfoList(Dword *count)
{
    *count = 2;
    return OK;
}

EXPORT Status CALL FT_GetDeviceInfoDetail(Dword index, Dword *flags, Dword *type, Dword *id, Dword *location, void *serial,
                                          void *description, void **handle)
{
    /* The first device is of somebody else. */
    *flags = index == 1 && is_open;
    *type = 5;
    *id = index == 1 ? 0x0403F231 : 0x04036001;
    *location = index == 1 ? LOCATION : 0x213;
    strcpy(serial, index == 1 ? "KF0001" : "A50285BI");
    strcpy(description, index == 1 ? "KFLOP - Motion Controller" : "FT232R USB UART");
    *handle = 0;
    return OK;
}

EXPORT Status CALL FT_OpenEx(void *argument, Dword flags, void **handle)
{
    struct sockaddr_in address = {0};
    const char *port = getenv("FTD2XX_PORT");

    if (flags != BY_LOCATION || (size_t)argument != LOCATION || !port) return NOT_FOUND;
    if (is_open) return NOT_OPENED;
#ifdef _WIN32
    WSADATA data;
    WSAStartup(MAKEWORD(2, 2), &data);
#endif
    address.sin_family = AF_INET;
    address.sin_port = htons((unsigned short)atoi(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    chip = socket(AF_INET, SOCK_STREAM, 0);
    if (connect(chip, (struct sockaddr *)&address, sizeof address) != 0) {
        closesocket(chip);
        return NOT_OPENED;
    }
    is_open = 1;
    *handle = &chip;
    return OK;
}

EXPORT Status CALL FT_SetLatencyTimer(void *handle, unsigned char milliseconds)
{
    return handle == &chip && milliseconds == 2 ? OK : INVALID_HANDLE;
}

EXPORT Status CALL FT_SetChars(void *handle, unsigned char event, unsigned char has_event, unsigned char error,
                               unsigned char has_error)
{
    return handle == &chip && event == '\n' && has_event == 1 && error == 0 && has_error == 0 ? OK : INVALID_HANDLE;
}

EXPORT Status CALL FT_SetTimeouts(void *handle, Dword read, Dword write)
{
    return handle == &chip && read > 0 && write > 0 ? OK : INVALID_HANDLE;
}

EXPORT Status CALL FT_Purge(void *handle, Dword mask)
{
    return handle == &chip && mask == 3 ? OK : INVALID_HANDLE;
}

EXPORT Status CALL FT_GetStatus(void *handle, Dword *received, Dword *sent, Dword *event)
{
    Count count = 0;
    char byte;
    fd_set ready;
    struct timeval none = {0, 0};

    if (handle != &chip || pending(chip, &count) != 0) return INVALID_HANDLE;
    FD_ZERO(&ready);
    FD_SET(chip, &ready);
    /* Ready without a byte: the other end is gone, as when the cable is pulled. */
    if (count == 0 && select((int)chip + 1, &ready, 0, 0, &none) == 1 && recv(chip, &byte, 1, MSG_PEEK) <= 0) return IO_ERROR;
    *received = (Dword)count;
    *sent = *event = 0;
    return OK;
}

EXPORT Status CALL FT_Read(void *handle, void *buffer, Dword wanted, Dword *count)
{
    int taken = handle == &chip ? (int)recv(chip, buffer, (int)wanted, 0) : -1;

    *count = taken > 0 ? (Dword)taken : 0;
    return taken > 0 ? OK : IO_ERROR;
}

EXPORT Status CALL FT_Write(void *handle, void *buffer, Dword wanted, Dword *count)
{
    int given = handle == &chip ? (int)send(chip, buffer, (int)wanted, 0) : -1;

    *count = given > 0 ? (Dword)given : 0;
    return given > 0 ? OK : IO_ERROR;
}

EXPORT Status CALL FT_Close(void *handle)
{
    if (handle != &chip || !is_open) return INVALID_HANDLE;
    closesocket(chip);
    is_open = 0;
    return OK;
}
