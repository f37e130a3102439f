#include "base/system.h"

#include "support/few_descriptors.h"
#include "support/test.h"

#include <errno.h>
#include <fcntl.h>
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_passes_is_told_from_what_stays),
        cmocka_unit_test(inputs_leave_the_last_descriptors_to_others),
    };
    return RUN_TESTS(tests);
}
