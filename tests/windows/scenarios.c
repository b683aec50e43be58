/* The scenarios of the socket's tests over the named pipe of Windows: `scenarios.exe CC67.EXE`, in an empty folder.
   Each has a server of its own; one line says how it ended, and the exit code is 1 if one of them failed. */

#include "client.h"

#define VERSION "KFLOP 4.34 Build 16:07:06 Aug 14 2018"
#define HELLO \
    "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"hello\\n\");\n" \
    "  for (;;) { WaitNextTimeSlice(); persist.UserData[9]++; }\n}\n"
#define COUNTER \
    "#include \"KMotionDef.h\"\nmain()\n{\n  int i;\n  for (i = 0; i < 2000; i++) printf(\"line %d\\n\", i);\n" \
    "  persist.UserData[9] = 1;\n}\n"
#define ENDLESS \
    "#include \"KMotionDef.h\"\nmain()\n{\n  int i;\n" \
    "  for (i = 0; ; i++) { printf(\"line %d\\n\", i); persist.UserData[9] = i; }\n}\n"

static Client *a, *b;

static void a_line_has_an_answer(void) { CHECK(asks(a, "Version", VERSION)); }

static void console_lines_come_before_replies(void)
{
    CHECK(call(a, SET_CONSOLE) == 0);
    CHECK(asks(a, "Version", VERSION));
    CHECK(a->lines == 1 && has_line(a, 0, "hello"));
}

static void an_answer_of_several_lines_is_read_line_by_line(void)
{
    CHECK(write_line(a, "GetGatherHex 0 9"));
    CHECK(read_line(a, 100) == 0 && strlen(a->text) == 8 * 9 - 1 + 2);
    CHECK(read_line(a, 100) == 0 && strcmp(a->text, "00000000\r\n") == 0);
    CHECK(read_line(a, 100) == 2 && a->text[0] == 0);
}

static void a_missing_line_takes_its_time(void)
{
    DWORD begin = GetTickCount();
    CHECK(read_line(a, 300) == 2);
    CHECK(GetTickCount() - begin >= 290);
}

static void a_waiting_client_gets_the_line_of_another(void)
{
    int wait = 600000;
    CHECK(request(a, READ_LINE, 0, &wait, 4));
    CHECK(write_line(b, "Version"));
    CHECK(reply(a) == 0 && strcmp(a->text, VERSION "\r\n") == 0);
}

static void ready_comes_after_an_echo(void)
{
    CHECK(call_line(a, WRITE_WITH_ECHO, "ReadBit48") == 0);
    CHECK(call(a, READY) == 2);
    CHECK(call(a, READY) == 0);
}

static void ready_knows_an_error(void)
{
    CHECK(call(a, SET_CONSOLE) == 0);
    CHECK(call_line(a, WRITE_WITH_ECHO, "bogus") == 0);
    CHECK(call(a, READY) == 3);
    CHECK(has_line(a, a->lines - 1, "Ready"));
    CHECK(has_line(a, a->lines - 3, "error, invalid command"));
}

static void a_line_without_an_answer_fails(void)
{
    CHECK(call_line(a, ASK, "bogus") == 1);
    CHECK(asks(a, "Version", VERSION));
}

static void the_firmware_has_a_generation(void) { CHECK(call(a, FIRMWARE) == 2); }

static void the_boards_are_listed_by_location(void)
{
    int location = call(a, LOCATION), code = LIST, list[2];
    CHECK(location > 0);
    CHECK(send_message(a, &code, 4) && reply(a) == 0 && a->length == 8);
    memcpy(list, a->text, 8);
    CHECK(list[0] == 1 && list[1] == location);
    CHECK(request(a, ASK, location, "Version", 8) && reply(a) == 0 && strcmp(a->text, VERSION) == 0);
}

static void a_board_that_is_not_there_is_not_connected(void)
{
    CHECK(request(a, LOCK, -1, "", 1) && reply(a) == 2);
    CHECK(request(a, LOCATION, 4711, "", 0) && reply(a) == -1);
    CHECK(request(a, ASK, 4711, "Version", 8) && reply(a) == 1);
}

static void an_unknown_call_closes_its_pipe_alone(void)
{
    CHECK(call(a, 99) == -1000);
    CHECK(asks(b, "Version", VERSION));
}

static void the_token_is_taken_once(void)
{
    CHECK(call(a, LOCK) == 0);
    CHECK(call(b, LOCK) == 1);
    CHECK(call(a, LOCK) == 1);
    CHECK(says("client 1 asks for the token that it has itself"));
}

static void any_client_releases_the_token(void)
{
    CHECK(call(a, LOCK) == 0);
    CHECK(call(b, RELEASE) == 0);
    CHECK(call(b, LOCK) == 0);
    CHECK(call(a, LOCK) == 1);
}

static void recovery_asks_for_the_token_and_connects(void)
{
    CHECK(call(a, DISCONNECT) == 0);
    CHECK(call(a, RECOVERY) == 0);
    CHECK(call(b, RECOVERY) == 1);
    CHECK(call(a, LOCATION) > 0);
}

static void older_libraries_ask_for_the_token_without_a_name(void)
{
    CHECK(request(a, LOCK, 0, "", 0) && reply(a) == 0);
    CHECK(request(b, LOCK, 0, "", 0) && reply(b) == 1);
}

static void the_last_console_gets_at_most_ten_lines_before_a_reply(void)
{
    char line[32];
    CHECK(call(a, SET_CONSOLE) == 0 && call(b, SET_CONSOLE) == 0);
    for (int number = 0; number < 12; number++) {
        snprintf(line, sizeof line, "Echo %d", number);
        CHECK(write_line(a, line));
    }
    CHECK(asks(a, "Version", VERSION) && a->lines == 0);
    CHECK(call(b, LOCK) == 0 && b->lines == 10);
    CHECK(call(b, RELEASE) == 0 && b->lines == 13);
}

static void reading_the_console_takes_one_line(void)
{
    CHECK(call(a, SET_CONSOLE) == 0 && asks(a, "Version", VERSION) && a->lines == 1);
    CHECK(write_line(a, "Echo a") && write_line(a, "Echo b"));
    CHECK(call(a, LOCK) == 0 && call(a, SERVICE_CONSOLE) == 0 && a->lines == 1);
    CHECK(call(a, RELEASE) == 0);
    CHECK(call(a, SERVICE_CONSOLE) == 0 && a->lines == 2 && has_line(a, 1, "A"));
    CHECK(call(a, SERVICE_CONSOLE) == 0 && a->lines == 3 && has_line(a, 2, "B"));
}

static void every_console_line_comes_in_order(void)
{
    char line[32];
    CHECK(call(a, SET_CONSOLE) == 0);
    while (a->lines < 2000 && call(a, SERVICE_CONSOLE) == 0 && asks(a, "Version", VERSION)) {}
    for (int number = 0; number < a->lines; number++) {
        snprintf(line, sizeof line, "line %d", number);
        CHECK(has_line(a, number, line));
    }
    CHECK(a->lines == 2000);
}

static void without_a_console_lines_are_discarded(void)
{
    for (int asked = 0; asked < 20000 && strcmp(ask(a, "GetPersistDec 9"), "1") != 0; asked++) {}
    for (int asked = 0; asked < 20; asked++) CHECK(asks(a, "Version", VERSION));
    CHECK(call(a, SET_CONSOLE) == 0 && write_line(a, "Echo new") && asks(a, "Version", VERSION));
    CHECK(a->lines == 1 && has_line(a, 0, "NEW"));
}

static void a_program_waits_for_a_console_that_reads_nothing(void)
{
    CHECK(call(a, SET_CONSOLE) == 0);
    int printed = 0;
    while (printed < 10000) printed = atoi(ask(b, "GetPersistDec 9"));
    for (int asked = 0; asked < 300; asked++) printed = atoi(ask(b, "GetPersistDec 9"));
    CHECK(printed < 10600);
    CHECK(atoi(ask(b, "GetPersistDec 9")) == printed);
    while (a->lines < 11000 && asks(a, "Version", VERSION)) {}
    CHECK(has_line(a, 0, "line 0") && has_line(a, 10999, "line 10999"));
}

static void a_closed_link_is_reopened_by_the_next_line(void)
{
    CHECK(write_line(a, "SetGatherHex 0 8"));
    CHECK(call(a, DISCONNECT) == 0);
    CHECK(call(a, LOCATION) == -1 && call(b, LOCATION) == -1);
    CHECK(write_line(a, "SetPersistDec 7 5"));
    CHECK(call(b, LOCATION) > 0);
    CHECK(asks(a, "GetPersistDec 7", "5") && a->errors == 0);
}

static void a_failure_is_reported_once(void)
{
    CHECK(call(a, FAILED) == 0 && a->errors == 1);
    CHECK(strcmp(a->error, "Read Failed - Auto Disconnect") == 0);
    CHECK(call(a, FAILED) == 0 && a->errors == 1);
    CHECK(asks(a, "Version", VERSION));
    CHECK(call(a, FAILED) == 0 && a->errors == 2);
}

static void starting_an_empty_thread_is_reported(void)
{
    CHECK(write_line(a, "Execute3"));
    CHECK(asks(a, "CheckThread3", "0"));
    CHECK(says("no program is loaded in thread 3"));
}

static void any_bytes_go_to_the_board(void)
{
    char line[4001];
    CHECK(call_line(a, ASK, "Version;\xFF\xFE") == 0);
    memset(line, 'x', 4000);
    line[4000] = 0;
    CHECK(write_line(a, line));
    CHECK(call(a, DISCONNECT) == 0 && asks(a, "Version", VERSION));
}

static void impossible_messages_harm_nobody_else(void)
{
    static char bytes[LONGEST + 1];
    const int lengths[] = { 1, 3, 5, LONGEST, LONGEST + 1 };
    for (int row = 0; row < 5; row++) {
        Client *hostile = connect_client();
        memset(bytes, 0xFF, sizeof bytes);
        CHECK(send_bytes(hostile, bytes, lengths[row]));
        CHECK(reply(hostile) == -1000);
        leave(hostile);
        CHECK(asks(a, "Version", VERSION));
    }
}

static void a_client_that_reads_nothing_blocks_itself_alone(void)
{
    CHECK(call(a, SET_CONSOLE) == 0);
    for (int asked = 0; asked < 100; asked++) request(a, ASK, 0, "Echo x;Version", 15);
    for (int asked = 0; asked < 20; asked++) CHECK(asks(b, "Version", VERSION));
}

static void the_later_library_sends_lengths_as_messages(void)
{
    a->has_lengths = 1;
    CHECK(call(a, SET_CONSOLE) == 0);
    CHECK(asks(a, "Version", VERSION));
    CHECK(a->lines == 1 && has_line(a, 0, "hello"));
    CHECK(asks(b, "Version", VERSION));
}

/* One of ten clients at the same time. */
static DWORD WINAPI work(void *number_of)
{
    int number = (int)(INT_PTR)number_of, wrong = 0;
    char line[64], answer[32];
    Client *client = connect_client();
    for (int round = 0; round < 20; round++) {
        while (call(client, LOCK) != 0) {}
        snprintf(line, sizeof line, "SetPersistDec %d %d", 20 + number, 1000 * number + round);
        write_line(client, line);
        snprintf(line, sizeof line, "GetPersistDec %d", 20 + number);
        snprintf(answer, sizeof answer, "%d", 1000 * number + round);
        wrong += strcmp(ask(client, line), answer) != 0;
        call(client, RELEASE);
    }
    leave(client);
    return (DWORD)wrong;
}

static void ten_clients_at_once_get_their_own_answers(void)
{
    HANDLE threads[10];
    DWORD wrong = 1;
    for (INT_PTR number = 0; number < 10; number++) threads[number] = CreateThread(NULL, 0, work, (void *)number, 0, NULL);
    for (int number = 0; number < 10; number++) {
        CHECK(WaitForSingleObject(threads[number], 60000) == WAIT_OBJECT_0);
        CHECK(GetExitCodeThread(threads[number], &wrong) && wrong == 0);
    }
}

static void flash_is_kept_by_a_server_that_is_killed(void)
{
    CHECK(write_line(a, "SetPersistDec 7 77"));
    CHECK(asks(a, "Flash", "Program Flash Image Complete"));
    leave(a);
    end_server();
    serve(HELLO, "--flash board.flash");
    a = connect_client();
    CHECK(asks(a, "GetPersistDec 7", "77"));
}

static void the_log_has_every_request(void)
{
    CHECK(call(a, LOCK) == 0);
    CHECK(write_line(a, "SetPersistDec 7 11"));
    const char *log = read_file("log.txt");
    CHECK(strstr(log, "client 1: KMotionLock\n") != NULL);
    CHECK(strstr(log, "SETPERSISTDEC 7 11\n") != NULL);
}

static void the_last_client_ends_a_server_of_once(void)
{
    CHECK(asks(b, "Version", VERSION));
    leave(a);
    CHECK(asks(b, "Version", VERSION));
    leave(b);
    CHECK(ends(server) == 0);
    a = b = NULL;
}

static void a_pipe_has_one_server(void)
{
    char words[256];
    snprintf(words, sizeof words, "serve --listen %s", pipe_path);
    CHECK(run(words) == 2);
    CHECK(strstr(read_file("output.txt"), "another server listens there") != NULL);
    CHECK(asks(a, "Version", VERSION));
}

static void a_program_is_downloaded_and_started(void)
{
    write_file("b.c", "#include \"KMotionDef.h\"\nmain()\n{\n  printf(\"again %d\\n\", 6 * 7);\n}\n");
    CHECK(run("build b.c --thread 3 --emit download") == 0);
    CHECK(call(a, SET_CONSOLE) == 0);
    char *line = strtok(_strdup(read_file("b(3).kmd")), "\r\n");
    for (; line != NULL; line = strtok(NULL, "\r\n")) CHECK(write_line(a, line));
    CHECK(write_line(a, "Execute3"));
    while (strcmp(ask(a, "CheckThread3"), "0") != 0) {}
    CHECK(asks(a, "Version", VERSION) && has_line(a, a->lines - 1, "again 42"));
}

static void board_time_passes_in_exchanges_only(void)
{
    char first[32];
    CHECK(asks(a, "Version", VERSION));
    snprintf(first, sizeof first, "%s", ask(a, "GetPersistDec 9"));
    leave(a);
    leave(b);
    end_server();
    serve(HELLO, "");
    a = connect_client();
    b = connect_client();
    CHECK(asks(a, "Version", VERSION));
    Sleep(200);
    CHECK(atoi(first) > 0 && asks(a, "GetPersistDec 9", first));
}

/* Starts this program as a client that dies at some point, and waits for its death. */
static void let_die(const char *how)
{
    char line[2 * MAX_PATH], own[MAX_PATH];
    GetModuleFileNameA(NULL, own, sizeof own);
    snprintf(line, sizeof line, "\"%s\" --die %s %s", own, how, pipe_path);
    CHECK(ends(start(line, NULL)) == 7);
}

static void die(const char *how)
{
    int wait = 600000;
    call(a, LOCK);
    if (strcmp(how, "command") == 0) write_line(a, "SetGatherHex 0 8");
    if (strcmp(how, "question") == 0) request(a, ASK, 0, "Version", 8);
    if (strcmp(how, "wait") == 0) request(a, READ_LINE, 0, &wait, 4);
    if (strcmp(how, "length") == 0) send_bytes(a, "\x10", 2);
    if (strcmp(how, "console") == 0) {
        call(a, SET_CONSOLE);
        write_line(a, "Echo x");
        request(a, ASK, 0, "Version", 8);
        /* The console line has come, and is not acknowledged. */
        receive(a, (char[LONGEST_REPLY]){ 0 });
    }
    TerminateProcess(GetCurrentProcess(), 7);
}

/* What a dead client had is free, and the board is there for the others. */
static void others_continue(void)
{
    for (int attempt = 0; attempt < 200 && call(b, LOCK) != 0; attempt++) Sleep(10);
    CHECK(call(b, LOCK) == 1);
    CHECK(call(b, DISCONNECT) == 0);
    CHECK(asks(b, "Version", VERSION));
    CHECK(call(b, RELEASE) == 0);
    CHECK(call(b, SET_CONSOLE) == 0);
    CHECK(write_line(b, "Echo here"));
    CHECK(asks(b, "Version", VERSION) && has_line(b, b->lines - 1, "HERE"));
}

static void a_client_dies_with_the_token(void) { let_die("token"); others_continue(); }
static void a_client_dies_within_a_command(void) { let_die("command"); others_continue(); }
static void a_client_dies_after_a_question(void) { let_die("question"); others_continue(); }
static void a_client_dies_while_it_waits(void) { let_die("wait"); others_continue(); }
static void a_client_dies_after_a_length(void) { let_die("length"); others_continue(); }
static void a_client_dies_before_it_acknowledges(void) { let_die("console"); others_continue(); }

/* As the library does where it finds no server: by its bare name, hidden, with output that nobody reads. */
static void the_library_starts_the_server(void)
{
    char words[256], name[] = "KMotionServer.exe";
    snprintf(words, sizeof words, "serve --home home --for 0 --pace fast --listen %s a.c", pipe_path);
    leave(a);
    leave(b);
    end_server();
    CHECK(run(words) == 0);
    char *options = _strdup(read_file("home\\serve.options")), *limit = strstr(options, "--for\n0\n");
    CHECK(limit != NULL);
    if (limit != NULL) memmove(limit, limit + 8, strlen(limit + 8) + 1);
    write_file("home\\serve.options", options);
    CHECK(SetCurrentDirectoryA("home\\KMotion\\Release"));
    server = start(name, NULL);
    CHECK(SetCurrentDirectoryA("..\\..\\.."));
    a = connect_client();
    /* Each of these is reported, and all together are longer than the pipe of its output. */
    for (int number = 0; number < 200; number++) CHECK(write_line(a, "Execute3"));
    CHECK(asks(a, "CheckThread1", "1"));
    CHECK(strstr(read_file("home\\server.log"), "a board is served on") != NULL);
    leave(a);
    CHECK(ends(server) == 0);
    a = b = NULL;
}

static void the_library_starts_the_compiler(void)
{
    char line[] = "home\\KMotion\\Release\\TCC67.exe -text 80060000 -g -nostdinc -I \"home\\DSP_KFLOP\" -I \".\" "
                  "-o \"a(2).out\" \"a.c\" \"home\\DSP_KFLOP\\DSPKFLOP.out\"";
    char wrong[] = "home\\KMotion\\Release\\TCC67.exe -text 80060000 -g -nostdinc -I \"home\\DSP_KFLOP\" -I \".\" "
                   "-o \"w(2).out\" \"wrong.c\" \"home\\DSP_KFLOP\\DSPKFLOP.out\"";
    CHECK(ends(start(line, "output.txt")) == 0 && read_file("output.txt")[0] == 0);
    CHECK(GetFileAttributesA("a(2).out") != INVALID_FILE_ATTRIBUTES);
    char *many = calloc(1, 1 << 16);
    for (int number = 0; number < 500; number++) sprintf(many + strlen(many), "int f%d() { return unknown%d; }\n", number, number);
    write_file("wrong.c", many);
    CHECK(ends(start(wrong, NULL)) == 1);
}

static const struct {
    const char *name;
    void (*run)(void);
    const char *source, *options;
} scenarios[] = {
#define ROW(name, source, options) { #name, name, source, options }
    ROW(a_line_has_an_answer, HELLO, ""),
    ROW(console_lines_come_before_replies, HELLO, ""),
    ROW(an_answer_of_several_lines_is_read_line_by_line, HELLO, ""),
    ROW(a_missing_line_takes_its_time, HELLO, ""),
    ROW(a_waiting_client_gets_the_line_of_another, HELLO, ""),
    ROW(ready_comes_after_an_echo, HELLO, ""),
    ROW(ready_knows_an_error, HELLO, ""),
    ROW(a_line_without_an_answer_fails, HELLO, ""),
    ROW(the_firmware_has_a_generation, HELLO, ""),
    ROW(the_boards_are_listed_by_location, HELLO, ""),
    ROW(a_board_that_is_not_there_is_not_connected, HELLO, ""),
    ROW(an_unknown_call_closes_its_pipe_alone, HELLO, ""),
    ROW(the_token_is_taken_once, HELLO, ""),
    ROW(any_client_releases_the_token, HELLO, ""),
    ROW(recovery_asks_for_the_token_and_connects, HELLO, ""),
    ROW(older_libraries_ask_for_the_token_without_a_name, HELLO, ""),
    ROW(the_last_console_gets_at_most_ten_lines_before_a_reply, HELLO, ""),
    ROW(reading_the_console_takes_one_line, HELLO, ""),
    ROW(every_console_line_comes_in_order, COUNTER, ""),
    ROW(without_a_console_lines_are_discarded, COUNTER, ""),
    ROW(a_program_waits_for_a_console_that_reads_nothing, ENDLESS, ""),
    ROW(a_closed_link_is_reopened_by_the_next_line, HELLO, ""),
    ROW(a_failure_is_reported_once, HELLO, ""),
    ROW(starting_an_empty_thread_is_reported, HELLO, ""),
    ROW(any_bytes_go_to_the_board, HELLO, ""),
    ROW(impossible_messages_harm_nobody_else, HELLO, ""),
    ROW(a_client_that_reads_nothing_blocks_itself_alone, HELLO, ""),
    ROW(the_later_library_sends_lengths_as_messages, HELLO, ""),
    ROW(ten_clients_at_once_get_their_own_answers, HELLO, ""),
    ROW(flash_is_kept_by_a_server_that_is_killed, HELLO, "--flash board.flash"),
    ROW(the_log_has_every_request, HELLO, "--log log.txt"),
    ROW(the_last_client_ends_a_server_of_once, HELLO, "--once"),
    ROW(a_pipe_has_one_server, HELLO, ""),
    ROW(a_program_is_downloaded_and_started, HELLO, "--engine dsp"),
    ROW(board_time_passes_in_exchanges_only, HELLO, ""),
    ROW(a_client_dies_with_the_token, HELLO, ""),
    ROW(a_client_dies_within_a_command, HELLO, ""),
    ROW(a_client_dies_after_a_question, HELLO, ""),
    ROW(a_client_dies_while_it_waits, HELLO, ""),
    ROW(a_client_dies_after_a_length, HELLO, ""),
    ROW(a_client_dies_before_it_acknowledges, HELLO, ""),
    ROW(the_library_starts_the_server, HELLO, ""),
    ROW(the_library_starts_the_compiler, HELLO, ""),
};

int main(int count, char **words)
{
    int passed = 0, chosen = 0, total = (int)(sizeof scenarios / sizeof scenarios[0]);
    if (count == 4 && strcmp(words[1], "--die") == 0) {
        snprintf(pipe_path, sizeof pipe_path, "%s", words[3]);
        a = connect_client();
        a->has_lengths = strcmp(words[2], "length") == 0;
        die(words[2]);
    }
    if (count < 2 || GetFullPathNameA(words[1], sizeof command, command, NULL) == 0) {
        puts("usage: scenarios CC67.EXE [NAME]");
        return 2;
    }
    for (int row = 0; row < total; row++) {
        scenario = scenarios[row].name;
        if (count > 2 && strstr(scenario, words[2]) == NULL) continue;
        chosen++;
        failures = 0;
        serve(scenarios[row].source, scenarios[row].options);
        a = connect_client();
        b = connect_client();
        scenarios[row].run();
        if (a != NULL) end_server();
        if (a != NULL) leave(a);
        if (b != NULL) leave(b);
        passed += failures == 0;
        printf("%s %s\n", failures == 0 ? "ok" : "FAILED", scenario);
        fflush(stdout);
    }
    printf("%d of %d scenarios passed\n", passed, chosen);
    return passed == chosen && chosen > 0 ? 0 : 1;
}
