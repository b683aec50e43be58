/* A program of the PC that drives a controller at a link.
   Arguments: the address of the controller, and a program for it. */

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "cc67board.h"

static void on_line(const char *line, void *user)
{
    (void)user;
    printf("console: %s\n", line);
}

static int counts(struct cc67_client *board, void *user)
{
    int32_t count = 0;
    assert(cc67_user_data(board, 9, &count) == CC67_RESULT_OK);
    return count >= *(int *)user;
}

static void refusals(void)
{
    char message[400];

    assert(!cc67_open_controller(NULL, NULL, message, sizeof message));
    assert(!strcmp(message, "the controller has no address"));
    assert(!cc67_open_controller("lpt1", NULL, message, sizeof message));
    printf("no address: %.*s\n", (int)strcspn(message, ":"), message);
    assert(!cc67_open_controller("tcp:127.0.0.1:1", NULL, message, sizeof message));
    printf("nobody there: %s\n", strstr(message, "refused") ? "connection refused" : message);
}

int main(int argc, char **argv)
{
    char message[400];
    struct cc67_client *board;
    int32_t first = 0, second = 0;
    int goal = 20;

    assert(argc == 3);
    refusals();
    board = cc67_open_controller(argv[1], NULL, message, sizeof message);
    if (!board) {
        printf("not connected: %s\n", message);
        return 1;
    }
    assert(cc67_write_line_read_line(board, "Version", message, sizeof message) == CC67_RESULT_OK);
    puts(message);
    assert(cc67_set_console_callback(board, on_line, NULL) == CC67_RESULT_OK);

    /* Time passes by itself: a program counts while the PC waits. */
    assert(cc67_set_user_data(board, 9, 0) == CC67_RESULT_OK);
    assert(cc67_compile_and_load_coff(board, argv[2], 1) == CC67_RESULT_OK);
    assert(cc67_write_line(board, "Execute1") == CC67_RESULT_OK);
    assert(cc67_run_until(board, 10.0, counts, &goal) == 1);
    assert(cc67_write_line(board, "Kill1") == CC67_RESULT_OK);
    assert(cc67_user_data(board, 9, &first) == CC67_RESULT_OK && first >= goal);
    assert(cc67_run_for(board, 0.1) == CC67_RESULT_OK);
    assert(cc67_user_data(board, 9, &second) == CC67_RESULT_OK && second == first);

    /* A controller echoes nothing. */
    assert(cc67_write_line_with_echo(board, "Version") == CC67_RESULT_FAILED);
    puts("loaded, started, stopped");
    cc67_close(board);
    return 0;
}
