/* A client of the named pipe of `cc67 serve`, which speaks the protocol from its description alone (host-protocol.md
   section 8, wire.md section 7), and the server that it talks to. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

enum {
    ASK, WRITE, WRITE_WITH_ECHO, READ_LINE, LIST, FAILED, DISCONNECT, FIRMWARE, READY, LOCK, LOCATION, RECOVERY, RELEASE,
    SERVICE_CONSOLE, SET_CONSOLE
};

#define LONGEST 4096
#define LONGEST_REPLY 2561
#define LINES 12000

static const char *scenario;
static int failures;
/* The server under test, if it has been started. */
static PROCESS_INFORMATION server;

#define CHECK(condition) check((condition) != 0, #condition, __LINE__)

static void check(int holds, const char *condition, int line)
{
    if (!holds) {
        printf("  line %d: %s does not hold\n", line, condition);
        failures++;
    }
}

static void stop(const char *reason)
{
    printf("  %s (error %lu)\nFAILED %s\n", reason, GetLastError(), scenario);
    fflush(stdout);
    TerminateProcess(server.hProcess, 9);
    ExitProcess(1);
}

/* A connection, and what came over it. */
typedef struct {
    HANDLE pipe;
    /* Whether the length of each message is sent before it, as the later library does. */
    int has_lengths;
    char *console[LINES];
    int lines;
    char error[256];
    int errors;
    char text[LONGEST_REPLY];
    int length;
} Client;

/* Opens a pipe as the library does: 100 times, 100 ms apart. */
static HANDLE open_pipe(const char *path)
{
    for (int attempt = 0; attempt < 100; attempt++) {
        HANDLE pipe = CreateFileA(path, GENERIC_READ | GENERIC_WRITE, 0, NULL, OPEN_EXISTING, 0, NULL);
        if (pipe != INVALID_HANDLE_VALUE) return pipe;
        Sleep(100);
    }
    stop("nobody listens");
    return NULL;
}

static int send_bytes(Client *client, const void *bytes, int length)
{
    DWORD sent;
    return WriteFile(client->pipe, bytes, (DWORD)length, &sent, NULL) && (int)sent == length;
}

static int send_message(Client *client, const void *bytes, int length)
{
    WORD prefix = (WORD)length;
    if (client->has_lengths && !send_bytes(client, &prefix, 2)) return 0;
    return send_bytes(client, bytes, length);
}

/* The next message; 0 if the server has closed the pipe. */
static int receive(Client *client, char *message)
{
    DWORD length;
    if (client->has_lengths) {
        WORD prefix;
        if (!ReadFile(client->pipe, &prefix, 2, &length, NULL) || length != 2) return 0;
        if (!ReadFile(client->pipe, message, prefix, &length, NULL) || length != prefix) return 0;
        return (int)length;
    }
    return ReadFile(client->pipe, message, LONGEST_REPLY, &length, NULL) ? (int)length : 0;
}

/* Receives messages until a reply; its result, or -1000 if the pipe is closed. */
static int reply(Client *client)
{
    char message[LONGEST_REPLY + 1] = { 0 };
    for (;;) {
        int length = receive(client, message), result;
        if (length == 0) return -1000;
        message[length] = 0;
        if (message[0] == 0) {
            memcpy(&result, message + 1, 4);
            client->length = length - 5;
            memcpy(client->text, message + 5, (size_t)client->length);
            return result;
        }
        if (message[0] == 1 && client->lines < LINES) {
            CHECK(length > 3 && strcmp(message + length - 3, "\r\n") == 0);
            message[length - 3] = 0;
            client->console[client->lines++] = _strdup(message + 1);
        } else if (message[0] == 2) {
            snprintf(client->error, sizeof client->error, "%.200s", message + 1);
            client->errors++;
        } else {
            stop("a message of no known kind");
        }
        CHECK(send_bytes(client, "\xAA", 1));
    }
}

static int request(Client *client, int code, int board, const void *arguments, int length)
{
    char message[LONGEST];
    memcpy(message, &code, 4);
    memcpy(message + 4, &board, 4);
    memcpy(message + 8, arguments, (size_t)length);
    return send_message(client, message, 8 + length);
}

static int call(Client *client, int code)
{
    const char *name = code == LOCK ? "a test" : "";
    return request(client, code, 0, name, code == LOCK ? 7 : 0) ? reply(client) : -1000;
}

static int call_line(Client *client, int code, const char *line)
{
    return request(client, code, 0, line, (int)strlen(line) + 1) ? reply(client) : -1000;
}

/* A line and the first line of its answer, which is empty if there is none. */
static const char *ask(Client *client, const char *line)
{
    return call_line(client, ASK, line) == 0 ? client->text : "";
}

static int asks(Client *client, const char *line, const char *answer)
{
    int is_same = strcmp(ask(client, line), answer) == 0;
    if (!is_same) printf("  %s: `%s` is not `%s`\n", line, client->text, answer);
    return is_same;
}

static int write_line(Client *client, const char *line)
{
    return call_line(client, WRITE, line) == 0;
}

/* The next line of an answer with its end; the result is 2 if none comes in time. */
static int read_line(Client *client, int milliseconds)
{
    return request(client, READ_LINE, 0, &milliseconds, 4) ? reply(client) : -1000;
}

static int has_line(const Client *client, int number, const char *line)
{
    return number < client->lines && strcmp(client->console[number], line) == 0;
}

static void leave(Client *client)
{
    CloseHandle(client->pipe);
    free(client);
}

/* The server under test, in a folder of its own. */
static char command[MAX_PATH];
static char pipe_path[64];

static Client *connect_client(void)
{
    Client *client = calloc(1, sizeof *client);
    if (client == NULL) stop("no memory");
    client->pipe = open_pipe(pipe_path);
    return client;
}

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(name, "wb");
    if (file == NULL || fputs(text, file) < 0 || fclose(file) != 0) stop(name);
}

/* What a file has; it may grow. */
static const char *read_file(const char *name)
{
    static char text[1 << 20];
    FILE *file = fopen(name, "rb");
    size_t length = file == NULL ? 0 : fread(text, 1, sizeof text - 1, file);
    text[length] = 0;
    if (file != NULL) fclose(file);
    return text;
}

/* A new file for the output of a process; the console of the process before may hold it for a moment. */
static HANDLE create_file(const char *name, SECURITY_ATTRIBUTES *inherited)
{
    for (int attempt = 0; attempt < 100; attempt++) {
        HANDLE file = CreateFileA(name, GENERIC_WRITE, FILE_SHARE_READ, inherited, CREATE_ALWAYS, 0, NULL);
        if (file != INVALID_HANDLE_VALUE) return file;
        Sleep(50);
    }
    stop(name);
    return NULL;
}

/* Starts a process with its output in a file, or in a pipe that nobody reads if there is no name of one. */
static PROCESS_INFORMATION start(char *line, const char *file)
{
    SECURITY_ATTRIBUTES inherited = { sizeof inherited, NULL, TRUE };
    HANDLE output, unread = NULL;
    if (file == NULL) {
        CreatePipe(&unread, &output, &inherited, 4096);
    } else {
        output = create_file(file, &inherited);
    }
    STARTUPINFOA how;
    memset(&how, 0, sizeof how);
    how.cb = sizeof how;
    how.dwFlags = STARTF_USESTDHANDLES;
    how.hStdOutput = how.hStdError = output;
    PROCESS_INFORMATION process;
    if (!CreateProcessA(NULL, line, NULL, NULL, TRUE, CREATE_NO_WINDOW, NULL, NULL, &how, &process)) stop(line);
    CloseHandle(output);
    return process;
}

/* The exit code of a process; it has ten seconds. */
static int ends(PROCESS_INFORMATION process)
{
    DWORD code = 999;
    if (WaitForSingleObject(process.hProcess, 10000) != WAIT_OBJECT_0) return 1000;
    GetExitCodeProcess(process.hProcess, &code);
    CloseHandle(process.hProcess);
    CloseHandle(process.hThread);
    return (int)code;
}

/* Runs the command under test to its end, with its output in `output.txt`. */
static int run(const char *words)
{
    char line[1024];
    snprintf(line, sizeof line, "\"%s\" %s", command, words);
    return ends(start(line, "output.txt"));
}

/* Starts a server of a program, whose board time passes in exchanges only. */
static void serve(const char *source, const char *options)
{
    static int count;
    char line[1024];
    write_file("a.c", source);
    snprintf(pipe_path, sizeof pipe_path, "\\\\.\\pipe\\cc67-client-%lu-%d", GetCurrentProcessId(), count++);
    snprintf(line, sizeof line, "\"%s\" serve --pace fast --listen %s %s a.c", command, pipe_path, options);
    server = start(line, "said.txt");
}

static void end_server(void)
{
    TerminateProcess(server.hProcess, 9);
    ends(server);
}

/* Waits until the server has said something. */
static int says(const char *text)
{
    for (int attempt = 0; attempt < 100; attempt++) {
        if (strstr(read_file("said.txt"), text) != NULL) return 1;
        Sleep(50);
    }
    return 0;
}
