/* A program of the PC that drives a simulated board as it would drive a real one.
   Arguments: a program for the board, and one with an error. */

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cc67board.h"

static void on_line(const char *line, void *user)
{
    printf("console: %s\n", line);
    ++*(int *)user;
}

/* A call-back that calls clients of its board: the board is in use, and says so. */
static void on_line_again(const char *line, void *user)
{
    struct cc67_client *board = user, *other;
    char reply[80];
    int32_t value = 0;

    printf("again: %s\n", line);
    assert(cc67_write_line(board, "Version") == CC67_RESULT_IN_USE);
    assert(cc67_write_line_read_line(board, "Version", reply, sizeof reply) == CC67_RESULT_IN_USE);
    assert(cc67_run_for(board, 0.1) == CC67_RESULT_IN_USE);
    assert(cc67_user_data(board, 9, &value) == CC67_RESULT_IN_USE);
    assert(cc67_service_console(board, reply, sizeof reply) == -1);
    assert(cc67_set_console_callback(board, NULL, NULL) == CC67_RESULT_IN_USE);
    assert(cc67_another_client(board) == NULL);
    assert(cc67_kmotion_lock(board) == 1 && cc67_wait_token(board, -1) == 1);
    cc67_close(board);
    /* Another board is free. */
    other = cc67_open(NULL, NULL, reply, sizeof reply);
    assert(other && cc67_write_line_read_line(other, "Version", reply, sizeof reply) == CC67_RESULT_OK);
    cc67_close(other);
}

static void call_backs(struct cc67_client *board)
{
    struct cc67_client *other = cc67_another_client(board);
    char line[100];

    assert(cc67_set_console_callback(board, on_line_again, board) == CC67_RESULT_OK);
    assert(cc67_write_line(board, "Echo one") == CC67_RESULT_OK);
    assert(cc67_set_console_callback(board, on_line_again, other) == CC67_RESULT_OK);
    assert(cc67_write_line(board, "Echo two") == CC67_RESULT_OK);
    assert(cc67_run_for(board, 0.1) == CC67_RESULT_OK);
    assert(cc67_set_console_callback(board, NULL, NULL) == CC67_RESULT_OK);
    assert(cc67_write_line_read_line(other, "Version", line, sizeof line) == CC67_RESULT_OK);
    cc67_close(other);
}

static int is_counted(struct cc67_client *client, void *user)
{
    int32_t count = 0;
    assert(cc67_user_data(client, 9, &count) == CC67_RESULT_OK);
    return count >= *(int *)user;
}

static void programs(struct cc67_client *board, const char *good, const char *bad)
{
    char message[200], small[12], reply[80];
    int lines = 0, goal = 50, at_least;

    assert(cc67_set_console_callback(board, on_line, &lines) == CC67_RESULT_OK);
    assert(cc67_compile_and_load_coff_with_message(board, good, 1, message, sizeof message) == CC67_RESULT_OK);
    assert(message[0] == '\0');
    assert(cc67_write_line(board, "Execute1") == CC67_RESULT_OK);
    assert(cc67_run_until(board, 1.0, is_counted, &goal) == 1);
    assert(lines == 1);

    /* A program that does not compile: the other one goes on. */
    assert(cc67_compile_and_load_coff(board, bad, 1) == CC67_RESULT_FAILED);
    memset(small, 'x', sizeof small);
    assert(cc67_compile_and_load_coff_with_message(board, bad, 1, small, 8) == CC67_RESULT_FAILED);
    assert(strlen(small) == 7 && small[8] == 'x');
    assert(cc67_compile_and_load_coff_with_message(board, bad, 1, message, sizeof message) == CC67_RESULT_FAILED);
    printf("%s\n", strrchr(message, '/') ? strrchr(message, '/') + 1 : message);
    assert(cc67_write_line_read_line(board, "CheckThread1", reply, sizeof reply) == CC67_RESULT_OK);
    assert(strcmp(reply, "1") == 0);
    at_least = goal + 1;
    assert(cc67_run_until(board, 1.0, is_counted, &at_least) == 1);
    assert(cc67_write_line(board, "Kill1") == CC67_RESULT_OK);
    assert(cc67_set_console_callback(board, NULL, NULL) == CC67_RESULT_OK);
}

static void lines(struct cc67_client *board)
{
    char line[100];
    unsigned char status[464];

    assert(cc67_write_line(board, "Echo hello") == CC67_RESULT_OK);
    assert(cc67_service_console(board, line, sizeof line) == 1 && strcmp(line, "HELLO") == 0);
    assert(cc67_service_console(board, line, sizeof line) == 0 && line[0] == '\0');
    assert(cc67_write_line(board, "GetGatherHex 0 9") == CC67_RESULT_OK);
    assert(cc67_read_line_timeout(board, line, sizeof line, 100) == CC67_RESULT_OK);
    assert(strcmp(line + 63, "00000000\r\n") == 0);
    assert(cc67_read_line_timeout(board, line, sizeof line, 100) == CC67_RESULT_OK);
    assert(cc67_read_line_timeout(board, line, sizeof line, 100) == CC67_RESULT_TIMEOUT);
    assert(cc67_write_line_with_echo(board, "Version") == CC67_RESULT_OK);
    assert(cc67_check_for_ready(board) == 2 && cc67_check_for_ready(board) == 0);
    assert(cc67_set_user_data(board, 103, 77) == CC67_RESULT_OK);
    assert(cc67_get_status(board, status, sizeof status) == CC67_RESULT_OK);
    assert(status[0] == 0x74 && status[424 + 3 * 4] == 77);
    assert(cc67_drive_input(board, 136, 1) == CC67_RESULT_OK);
    assert(cc67_write_line_read_line(board, "ReadBit136", line, sizeof line) == CC67_RESULT_OK);
    assert(strcmp(line, "1") == 0);
    assert(cc67_write_line_read_line(board, "Version", line, sizeof line) == CC67_RESULT_OK);
    printf("%s\n", line);
    assert(cc67_write_line(board, "Move0=5") == CC67_RESULT_OK);
    assert(cc67_take_remark(board, line, sizeof line) == 1);
    printf("remark: %s\n", line);
}

static void tokens(struct cc67_client *first)
{
    struct cc67_client *second = cc67_another_client(first);
    char line[20];

    assert(cc67_kmotion_lock(first) == 0);
    assert(cc67_kmotion_lock(second) == 1);
    assert(cc67_wait_token(second, 1) == 1);
    cc67_release_token(first);
    assert(cc67_wait_token(second, -1) == 0);
    /* A client that is gone has lost the token. */
    cc67_close(second);
    assert(cc67_kmotion_lock(first) == 0);
    cc67_release_token(first);
    cc67_failed(first);
    assert(cc67_write_line(first, "Zero0") == CC67_RESULT_NOT_CONNECTED);
    assert(cc67_kmotion_lock(first) == 0);
    cc67_release_token(first);
    cc67_disconnect(first);
    assert(cc67_write_line_read_line(first, "Version", line, sizeof line) == CC67_RESULT_OK);
    assert(strcmp(line, "KFLOP 4.34 Build 16") == 0);
}

static void wrong_arguments(struct cc67_client *board)
{
    char text[40];
    int32_t value;

    assert(cc67_write_line(NULL, "Zero0") == CC67_RESULT_ARGUMENT);
    assert(cc67_write_line(board, NULL) == CC67_RESULT_ARGUMENT);
    assert(cc67_write_line(board, "\xff") == CC67_RESULT_ARGUMENT);
    assert(cc67_write_line_read_line(board, "Version", NULL, 10) == CC67_RESULT_ARGUMENT);
    assert(cc67_write_line_read_line(board, "Version", text, 0) == CC67_RESULT_ARGUMENT);
    assert(cc67_read_line_timeout(board, text, (size_t)-1, 0) == CC67_RESULT_ARGUMENT);
    assert(cc67_get_status(board, NULL, 464) == CC67_RESULT_ARGUMENT);
    assert(cc67_compile_and_load_coff(board, "nosuch.c", 1) == CC67_RESULT_FAILED);
    assert(cc67_compile_and_load_coff(board, "nosuch.c", 8) == CC67_RESULT_ARGUMENT);
    assert(cc67_compile_and_load_coff_with_message(board, "nosuch.c", 1, NULL, 0) == CC67_RESULT_FAILED);
    assert(cc67_load_coff(board, 1, "nosuch.out") == CC67_RESULT_FAILED);
    assert(cc67_include_dir(NULL, ".") == CC67_RESULT_ARGUMENT);
    assert(cc67_run_for(board, -1.0) == CC67_RESULT_ARGUMENT);
    assert(cc67_run_until(board, 1.0, NULL, NULL) == -1);
    assert(cc67_user_data(board, 200, &value) == CC67_RESULT_ARGUMENT);
    assert(cc67_user_data(board, -1, &value) == CC67_RESULT_ARGUMENT);
    assert(cc67_user_data(board, 0, NULL) == CC67_RESULT_ARGUMENT);
    assert(cc67_set_user_data(board, 200, 0) == CC67_RESULT_ARGUMENT);
    assert(cc67_drive_input(board, 2048, 1) == CC67_RESULT_ARGUMENT);
    assert(cc67_service_console(NULL, text, sizeof text) == -1);
    assert(cc67_another_client(NULL) == NULL);
    assert(cc67_open(NULL, "nosuch.toml", text, sizeof text) == NULL);
    assert(strncmp(text, "cannot read nosuch.toml", 23) == 0);
    cc67_close(NULL);
    cc67_release_token(NULL);
}

int main(int argc, char **argv)
{
    int location;
    struct cc67_client *board = cc67_open(NULL, NULL, NULL, 0);

    assert(argc == 3 && board != NULL);
    assert(cc67_list_locations(board, &location, 1) == 1 && cc67_list_locations(board, NULL, 0) == 1);
    assert(cc67_firmware_version(board) == 2);
    assert(cc67_include_dir(board, ".") == CC67_RESULT_OK);
    assert(cc67_run_for(board, 0.1) == CC67_RESULT_OK);
    programs(board, argv[1], argv[2]);
    lines(board);
    call_backs(board);
    tokens(board);
    wrong_arguments(board);
    cc67_close(board);
    puts("done");
    return EXIT_SUCCESS;
}
