#define _POSIX_C_SOURCE 200809L

#include "base/system.h"

#include "platform/pipe_signal.h"
#include "support/few_descriptors.h"
#include "support/test.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

static void what_passes_is_told_from_what_stays(void **state)
{
    (void)state;
    static const int later[] = {EMFILE, ENFILE, EAGAIN, EWOULDBLOCK, EINTR};
    for (size_t i = 0; i < sizeof later / sizeof *later; i++)
        CHECK_RESULT(slc_system_result(later[i]), SLUICE_NOT_READY);
    CHECK_RESULT(slc_system_result(ENOMEM), SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    CHECK_RESULT(slc_system_result(ENOENT), SLUICE_ERROR_FILE_NOT_FOUND);
    CHECK_RESULT(slc_system_result(ENOTDIR), SLUICE_ERROR_FILE_NOT_FOUND);
    CHECK_RESULT(slc_system_result(EIO), SLUICE_ERROR_IO);
    CHECK_RESULT(slc_system_result(EACCES), SLUICE_ERROR_IO);
}

static void inputs_leave_the_last_descriptors_to_others(void **state)
{
    (void)state;
    struct few_descriptors few;
    few_descriptors_begin(&few, SLC_RESERVED_DESCRIPTORS + 3);
    int inputs[4], count = 0;
    while (count < 4 && (inputs[count] = slc_open_input("/dev/null")) >= 0)
        count++;
    int error = errno;
    int output = open("/dev/null", O_WRONLY);
    for (int i = 0; i < count; i++)
        close(inputs[i]);
    int again = slc_open_input("/dev/null");
    few_descriptors_end(&few);
    assert_int_equal(count, 3);
    assert_int_equal(error, EMFILE);
    assert_true(output >= 0);
    assert_true(again >= 0);
    close(output);
    close(again);
}

static volatile sig_atomic_t signal_count;

static void count_signal(int number)
{
    (void)number;
    signal_count++;
}

static void write_to_closed_pipe(void)
{
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    close(ends[0]);
    assert_int_equal(write(ends[1], "x", 1), -1);
    assert_int_equal(errno, EPIPE);
    close(ends[1]);
}

static void closed_pipes_raise_no_signal_while_it_is_blocked(void **state)
{
    (void)state;
    struct slc_pipe_signal outer, inner;
    const struct sigaction action = {.sa_handler = count_signal};
    struct sigaction before;
    assert_int_equal(sigaction(SIGPIPE, &action, &before), 0);
    slc_pipe_signal_block(&outer);
    write_to_closed_pipe();
    slc_pipe_signal_restore(&outer);
    assert_int_equal(signal_count, 0);
    write_to_closed_pipe();
    assert_int_equal(signal_count, 1);
    /* Whoever blocked the signal before finds his own one, and it is still blocked. */
    slc_pipe_signal_block(&outer);
    write_to_closed_pipe();
    slc_pipe_signal_block(&inner);
    write_to_closed_pipe();
    slc_pipe_signal_restore(&inner);
    sigset_t pending;
    sigpending(&pending);
    assert_int_equal(sigismember(&pending, SIGPIPE), 1);
    slc_pipe_signal_restore(&outer);
    write_to_closed_pipe();
    assert_int_equal(signal_count, 2);
    sigaction(SIGPIPE, &before, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_passes_is_told_from_what_stays),
        cmocka_unit_test(closed_pipes_raise_no_signal_while_it_is_blocked),
        cmocka_unit_test(inputs_leave_the_last_descriptors_to_others),
    };
    return RUN_TESTS(tests);
}
