/* Ctrl-C in the console of Windows: `interrupts.exe CC67.EXE`, in an empty folder.
   Each command has a console of its own, to which the event is sent; one line says how it ended, and the exit code is 1 if one of
   them failed. */

#include "client.h"

#define KEPT "SetPersistDec 7 77\nFlash\nwait 0.1\nGetPersistDec 7\n"
#define WAITING \
    "#include \"KMotionDef.h\"\n\nmain()\n{\n    printf(\"ready\\n\");\n" \
    "    while (!ReadBit(136)) WaitNextTimeSlice();\n}\n"

/* True for the exit code of a process without a handler of the event; Wine has 0. */
static int is_by_ctrl_c(int code) { return code == (int)0xC000013A || code == 0; }

/* A process with its input in a pipe that stays open. */
typedef struct {
    PROCESS_INFORMATION process;
    HANDLE input;
} Started;

static Started start_words(const char *words)
{
    char line[1024];
    Started started;
    HANDLE read;
    SECURITY_ATTRIBUTES inherited = { sizeof inherited, NULL, TRUE };
    HANDLE output = create_file("said.txt", &inherited);
    if (!CreatePipe(&read, &started.input, &inherited, 4096)) stop("no pipe");
    SetHandleInformation(started.input, HANDLE_FLAG_INHERIT, 0);
    STARTUPINFOA how;
    memset(&how, 0, sizeof how);
    how.cb = sizeof how;
    how.dwFlags = STARTF_USESTDHANDLES;
    how.hStdInput = read;
    how.hStdOutput = how.hStdError = output;
    snprintf(line, sizeof line, "\"%s\" %s", command, words);
    if (!CreateProcessA(NULL, line, NULL, NULL, TRUE, CREATE_NO_WINDOW, NULL, NULL, &how, &started.process)) stop(line);
    CloseHandle(output);
    CloseHandle(read);
    return started;
}

/* This process sees the event too, as it is attached to the same console. */
static BOOL WINAPI ignore(DWORD event)
{
    (void)event;
    return TRUE;
}

/* Presses Ctrl-C in the console of a process; its exit code. */
static int interrupted(Started started)
{
    FreeConsole();
    if (!AttachConsole(started.process.dwProcessId)) stop("no console");
    SetConsoleCtrlHandler(ignore, TRUE);
    CHECK(GenerateConsoleCtrlEvent(CTRL_C_EVENT, 0));
    int code = ends(started.process);
    FreeConsole();
    CloseHandle(started.input);
    return code;
}

static void a_run_says_what_its_threads_wait_for(void)
{
    Started run = start_words("run --realtime --for 100000 a.c");
    CHECK(says("ready"));
    CHECK(interrupted(run) == 130);
    CHECK(says("cc67: interrupted after ") && says("a.c:6") && says("bit 136"));
}

static void a_console_has_kept_what_it_acknowledged(void)
{
    DWORD written;
    Started console = start_words("console --flash board.flash");
    CHECK(WriteFile(console.input, KEPT, sizeof KEPT - 1, &written, NULL));
    CHECK(says("Program Flash Image Complete"));
    CHECK(is_by_ctrl_c(interrupted(console)));
    Started again = start_words("console --flash board.flash");
    CHECK(WriteFile(again.input, "GetPersistDec 7\n", 16, &written, NULL));
    CloseHandle(again.input);
    CHECK(ends(again.process) == 0 && says("77"));
}

static void a_page_leaves_its_port(void)
{
    char words[128], *address;
    Started live = start_words("live --no-open --port 0 a.c");
    CHECK(says("http://127.0.0.1:") || says("http://localhost:"));
    address = strstr(read_file("said.txt"), "http://");
    int port = address == NULL ? 0 : atoi(strchr(address + 7, ':') + 1);
    CHECK(port > 0);
    CHECK(is_by_ctrl_c(interrupted(live)));
    snprintf(words, sizeof words, "live --no-open --port %d a.c", port);
    live = start_words(words);
    snprintf(words, sizeof words, ":%d/", port);
    CHECK(says(words));
    CHECK(is_by_ctrl_c(interrupted(live)));
}

static void a_server_ends_cleanly(void)
{
    char words[256];
    snprintf(pipe_path, sizeof pipe_path, "\\\\.\\pipe\\cc67-interrupt-%lu", GetCurrentProcessId());
    snprintf(words, sizeof words, "serve --listen %s --log log.txt --flash board.flash a.c", pipe_path);
    Started started = start_words(words);
    CHECK(says("a board is served"));
    Client *client = connect_client();
    CHECK(asks(client, "ProgFlashImage", "Program Flash Image Complete"));
    CHECK(write_line(client, "SetPersistDec 7 11"));
    CHECK(interrupted(started) == 0);
    CHECK(strstr(read_file("log.txt"), "\nSETPERSISTDEC 7 11\n") != NULL);
    leave(client);
}

int main(int count, char **words)
{
    static const struct { const char *name; void (*run)(void); } SCENARIOS[] = {
#define SCENARIO(name) { #name, name }
        SCENARIO(a_run_says_what_its_threads_wait_for),
        SCENARIO(a_console_has_kept_what_it_acknowledged),
        SCENARIO(a_page_leaves_its_port),
        SCENARIO(a_server_ends_cleanly),
    };
    int total = sizeof SCENARIOS / sizeof *SCENARIOS, failed = 0;
    if (count != 2) return 2;
    snprintf(command, sizeof command, "%s", words[1]);
    write_file("a.c", WAITING);
    for (int i = 0; i < total; i++) {
        int before = failures;
        scenario = SCENARIOS[i].name;
        SCENARIOS[i].run();
        failed += failures > before;
        printf("%s %s\n", failures > before ? "FAILED" : "ok", scenario);
        fflush(stdout);
    }
    printf("%d passed, %d failed\n", total - failed, failed);
    return failed > 0;
}
