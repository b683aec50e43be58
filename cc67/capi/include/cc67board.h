/* A KFLOP board, simulated or connected, as a library: the operations of the host interface under their names.

   Times are board time, which passes only in calls: an exchange takes as long as on the wire, cc67_run_for and
   cc67_run_until let more of it pass. So a test of a program of the PC does the same every time. The time of a connected
   controller passes by itself, and these calls wait.

       cc host.c -I cc67/capi/include -L target/release -lcc67board

   Texts are UTF-8 and end with a 0. Those that come back are cut to the size of the buffer and always ended. A call
   with a null pointer, or with another wrong argument, answers CC67_RESULT_ARGUMENT, -1 or null and does nothing.

   Made from the sources in cc67/capi/src; do not edit it. */

#ifndef CC67BOARD_H
#define CC67BOARD_H

#include <stddef.h>
#include <stdint.h>

/*
 The result of a call.
 */
enum cc67_result {
  /*
   The call succeeded.
   */
  CC67_RESULT_OK = 0,
  /*
   The call failed; where there is a message, it gives the reason.
   */
  CC67_RESULT_FAILED = 1,
  /*
   The board did not answer in time.
   */
  CC67_RESULT_TIMEOUT = 2,
  /*
   The connection was lost or closed.
   */
  CC67_RESULT_NOT_CONNECTED = 3,
  /*
   Another client has locked the board.
   */
  CC67_RESULT_IN_USE = 4,
  /*
   An argument is wrong: a null pointer, a text that is not UTF-8, a number out of range.
   */
  CC67_RESULT_ARGUMENT = 5,
  /*
   The library failed; the board is not to be used any more.
   */
  CC67_RESULT_INTERNAL = 6,
};

/*
 A client of a simulated board. One thread at a time may use it; clients of the same board may be used in
 different threads.
 */
struct cc67_client;

/*
 Receives a console line and what was registered with it. The board is in use meanwhile: calls of its clients return
 `CC67_RESULT_IN_USE`, or as a failure. It must not leave by `longjmp` or an exception.
 */
typedef void (*cc67_line_callback)(const char *line, void *user);

/*
 Says whether a run is over, by a number other than 0. It may use the client.
 */
typedef int (*cc67_end_callback)(struct cc67_client *client, void *user);

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 Makes a board at power-up, and its first client. `files` is the folder of the files that programs open on the PC, or
 null for none; `machine` is a machine file, what is connected to the board, or null for nothing. Null on failure,
 with the reason in `message`, which may be null.

 Requires:
 Texts end with a 0; `message` has room for `size` bytes.
 */
struct cc67_client *cc67_open(const char *files,
                              const char *machine,
                              char *message,
                              uintptr_t size);

/*
 Makes a board that runs your own firmware file, and its first client: programs are compiled for the processor, and
 the firmware answers. `firmware` is the name of the file; the other arguments and the result are those of
 `cc67_open`.

 Requires:
 Texts end with a 0; `message` has room for `size` bytes.
 */
struct cc67_client *cc67_open_firmware(const char *firmware,
                                       const char *files,
                                       const char *machine,
                                       char *message,
                                       uintptr_t size);

/*
 Connects to a controller, and makes its first client: programs are compiled for its processor and its firmware.
 `address` is `usb`, `usb:LOCATION`, `serial:PATH`, `server`, `kogna` or `tcp:HOST:PORT`, as with `cc67 run --on`;
 `files` is that of `cc67_open`. Connecting starts nothing, and programs that run already continue. Time passes by
 itself: cc67_run_for and cc67_run_until wait. Nothing of cc67 has been tried on a controller yet, only on the released
 firmware in emulation: switch the drives off for the first trials. Null on failure, with the reason in `message`.

 Requires:
 Texts end with a 0; `message` has room for `size` bytes.
 */
struct cc67_client *cc67_open_controller(const char *address,
                                         const char *files,
                                         char *message,
                                         uintptr_t size);

/*
 Makes one more client of the same board, for another thread or another part of the program. Null on failure, and in
 a call-back of the board.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
struct cc67_client *cc67_another_client(struct cc67_client *client);

/*
 Closes a client. It loses the token if it holds it, and its call-back is taken out; the last client of a board
 takes the board with it. Null is ignored, and so is any client of a board in its call-back.

 Requires:
 `client` is open, and is not used any more.
 */
void cc67_close(struct cc67_client *client);

/*
 Writes the identifiers of the boards that are connected to `list`, as many as fit, and returns how many there are;
 -1 if an argument is wrong, or in a call-back. `list` may be null if `capacity` is 0.

 Requires:
 `client` is open, and no other call uses it meanwhile; `list` has room for `capacity` numbers.
 */
int cc67_list_locations(struct cc67_client *client,
                        int *list,
                        uintptr_t capacity);

/*
 The generation of the board's firmware: 2, as of every board but the oldest; -1 if the client is null.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
int cc67_firmware_version(struct cc67_client *client);

/*
 Has console lines handed to a function as they come, in whatever call of whatever client of the board that is, and so
 in that call's thread; null lets them wait for `cc67_service_console` of this client again.

 Requires:
 `client` is open, and no other call uses it meanwhile; `callback` and `user` stay good until the client is closed or
 another function is registered.
 */
enum cc67_result cc67_set_console_callback(struct cc67_client *client,
                                           cc67_line_callback callback,
                                           void *user);

/*
 Takes at most one console line into `line`, without line end: 1 there was one, 0 there was none, or it went to the
 call-back, or another client has the token; -1 if an argument is wrong, or in a call-back.

 Requires:
 `client` is open, and no other call uses it meanwhile; `line` has room for `size` bytes.
 */
int cc67_service_console(struct cc67_client *client,
                         char *line,
                         uintptr_t size);

/*
 Takes the oldest remark of the simulation into `text`, such as a trap with its source line: 1 there was one, 0 there
 was none; -1 if an argument is wrong, or in a call-back.

 Requires:
 `client` is open, and no other call uses it meanwhile; `text` has room for `size` bytes.
 */
int cc67_take_remark(struct cc67_client *client,
                     char *text,
                     uintptr_t size);

/*
 Sends a line of script commands and waits for no reply.

 Requires:
 `client` is open, and no other call uses it meanwhile; the text ends with a 0.
 */
enum cc67_result cc67_write_line(struct cc67_client *client, const char *line);

/*
 Sends a line that the board echoes, and after which it says `Ready`.

 Requires:
 `client` is open, and no other call uses it meanwhile; the text ends with a 0.
 */
enum cc67_result cc67_write_line_with_echo(struct cc67_client *client, const char *line);

/*
 Sends a line and reads a line of its reply into `reply`, without line end; waits for the token before, and 3 s of
 board time for the reply.

 Requires:
 `client` is open, and no other call uses it meanwhile; the text ends with a 0; `reply` has room for `size` bytes.
 */
enum cc67_result cc67_write_line_read_line(struct cc67_client *client,
                                           const char *line,
                                           char *reply,
                                           uintptr_t size);

/*
 The next line of a reply, with its line end, if it comes within this many milliseconds of board time.

 Requires:
 `client` is open, and no other call uses it meanwhile; `reply` has room for `size` bytes.
 */
enum cc67_result cc67_read_line_timeout(struct cc67_client *client,
                                        char *reply,
                                        uintptr_t size,
                                        uint32_t milliseconds);

/*
 Reads lines until `Ready` comes, or none for 0.1 s: 0 nothing came, 1 a part of a line, 2 `Ready`, 3 `Ready` after an
 error; -1 without a connection.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
int cc67_check_for_ready(struct cc67_client *client);

/*
 Reads the status record, `MAIN_STATUS` of `PC-DSP.h`, 464 bytes, into `record`, or as much of it as fits.

 Requires:
 `client` is open, and no other call uses it meanwhile; `record` has room for `size` bytes.
 */
enum cc67_result cc67_get_status(struct cc67_client *client, void *record, uintptr_t size);

/*
 Adds a folder in which included files are searched, for what this client compiles from now on.

 Requires:
 `client` is open, and no other call uses it meanwhile; the text ends with a 0.
 */
enum cc67_result cc67_include_dir(struct cc67_client *client, const char *folder);

/*
 Compiles a source, links it for a thread, 1 to 7, and loads it there; it does not start. If it fails, what was in the
 thread is still there and running.

 Requires:
 `client` is open, and no other call uses it meanwhile; the text ends with a 0.
 */
enum cc67_result cc67_compile_and_load_coff(struct cc67_client *client,
                                            const char *file,
                                            int thread);

/*
 Compiles a source and loads it, with the reason of a failure in `message`: the compiler's messages, lines of
 `file:line: message`, cut to fit and always ended; empty on success.

 Requires:
 `client` is open, and no other call uses it meanwhile; the text ends with a 0; `message` has room for `size` bytes.
 */
enum cc67_result cc67_compile_and_load_coff_with_message(struct cc67_client *client,
                                                         const char *file,
                                                         int thread,
                                                         char *message,
                                                         uintptr_t size);

/*
 Loads an image, as `cc67 build` writes it, into a thread. If it fails, what was in the thread is still there.

 Requires:
 `client` is open, and no other call uses it meanwhile; the text ends with a 0.
 */
enum cc67_result cc67_load_coff(struct cc67_client *client, int thread, const char *file);

/*
 Lets this many seconds of board time pass.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
enum cc67_result cc67_run_for(struct cc67_client *client, double seconds);

/*
 Lets board time pass until `is_over` says so after a tick, at most this many seconds: 1 it said so, 0 the time has passed, -1
 an argument is wrong, or in a call-back for console lines.

 Requires:
 `client` is open, and no other thread uses it meanwhile; `is_over` does not close it.
 */
int cc67_run_until(struct cc67_client *client,
                   double seconds,
                   cc67_end_callback is_over,
                   void *user);

/*
 Reads an element of `persist.UserData`, 0 to 199, without a command and without board time.

 Requires:
 `client` is open, and no other call uses it meanwhile; `value` is a place for the number.
 */
enum cc67_result cc67_user_data(struct cc67_client *client, int element, int32_t *value);

/*
 Stores an element of `persist.UserData`, 0 to 199, without a command and without board time.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
enum cc67_result cc67_set_user_data(struct cc67_client *client, int element, int32_t value);

/*
 Drives an input bit, 0 to 2047, from outside: 0 low, any other number high.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
enum cc67_result cc67_drive_input(struct cc67_client *client, int bit, int level);

/*
 Asks for the token once; connects first if necessary: 0 this client has the board to itself, 1 another client has
 it, or a call-back of the board is in progress in this thread; 2 there is no connection.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
int cc67_kmotion_lock(struct cc67_client *client);

/*
 Waits for the token until another client releases it, at most this many milliseconds by the clock, or 2000 s for a
 negative number. The result is that of `cc67_kmotion_lock`.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
int cc67_wait_token(struct cc67_client *client,
                    int milliseconds);

/*
 Gives the token back; without it nothing happens.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
void cc67_release_token(struct cc67_client *client);

/*
 Gives the connection up, as after a failure; `cc67_kmotion_lock` connects again.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
void cc67_failed(struct cc67_client *client);

/*
 Gives the connection up.

 Requires:
 `client` is open, and no other call uses it meanwhile.
 */
void cc67_disconnect(struct cc67_client *client);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* CC67BOARD_H */
