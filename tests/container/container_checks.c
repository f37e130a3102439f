#define _XOPEN_SOURCE 700

#include "container/container_checks.h"

#include "support/test.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const struct picture picture_shapes[] = {
    {NULL, 1, 1},          {NULL, 2, 1},      {NULL, 1, 5},    {NULL, 5, 3},
    {NULL, 3, 3},          {NULL, 13, 1},     {NULL, 64, 64},  {NULL, 1023, 2},
    {NULL, 129, 255},      {NULL, 20, 12, 3}, {NULL, 9, 9, 1}, {NULL, 16, 16, 0, true},
    {NULL, 7, 7, 2, true},
};
const uint32_t picture_shapes_count = sizeof picture_shapes / sizeof picture_shapes[0];

void check_file(struct file_bytes file, const struct picture *picture, open_function *open)
{
    struct scratch scratch;
    scratch_init(&scratch, &file);
    SluiceImageSource *source = open(scratch.path, SLUICE_FORMAT_UNDEFINED, NULL);
    check_picture(source, picture);
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
    free(file.bytes);
}

static void check_refusal(const char *path, open_function *open, const struct refusal *refusal,
                          size_t number)
{
    struct log_tally tally;
    SluiceImageSource *source = open(path, SLUICE_FORMAT_UNDEFINED, &tally);
    SluiceResult result = read_everything(source);
    if (result != refusal->result || tally.errors != 1 || !strstr(tally.last, refusal->message))
        fail_msg("%zu: %s, %d errors: %s", number, sluiceGetResultName(result), tally.errors,
                 tally.last);
    sluiceDestroyImageSource(source);
}

static void write_number(const struct scratch *scratch, uint32_t at, uint32_t value)
{
    const uint8_t bytes[4] = {(uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16),
                              (uint8_t)(value >> 24)};
    assert_int_equal(pwrite(scratch->descriptor, bytes, sizeof bytes, at), sizeof bytes);
}

void check_refusals(struct file_bytes file, open_function *open, const struct refusal *refusals,
                    size_t count)
{
    struct scratch scratch;
    scratch_init(&scratch, &file);
    for (size_t i = 0; i < count; i++) {
        const struct refusal *r = &refusals[i];
        scratch_replace(&scratch, file.bytes, file.size);
        write_number(&scratch, r->at, r->value);
        if (r->at2)
            write_number(&scratch, r->at2, r->value2);
        check_refusal(scratch.path, open, r, i);
    }
    scratch_finish(&scratch);
    free(file.bytes);
}

void check_renaming(struct file_bytes file, const struct picture *picture, open_function *open,
                    SluiceFormat other, SluiceFormat foreign)
{
    struct format_names names = *picture->format;
    struct picture renamed = *picture;
    struct scratch scratch;
    struct log_tally tally;
    names.format = other;
    renamed.format = &names;
    scratch_init(&scratch, &file);
    SluiceImageSource *source = open(scratch.path, other, NULL);
    check_picture(source, &renamed);
    sluiceDestroyImageSource(source);
    source = open(scratch.path, foreign, &tally);
    CHECK_RESULT(read_everything(source), SLUICE_ERROR_UNSUPPORTED);
    assert_non_null(strstr(tally.last, sluiceGetFormatName(foreign)));
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
    free(file.bytes);
}

struct reader {
    SluiceImageSource *source;
    const struct picture *picture;
};

static void *read_picture(void *argument)
{
    const struct reader *reader = argument;
    check_picture(reader->source, reader->picture);
    return NULL;
}

void check_on_threads(SluiceImageSource *source, const struct picture *picture, int count)
{
    struct reader reader = {source, picture};
    pthread_t *threads = calloc((size_t)count, sizeof *threads);
    assert_non_null(threads);
    for (int i = 0; i < count; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, read_picture, &reader), 0);
    for (int i = 0; i < count; i++)
        pthread_join(threads[i], NULL);
    free(threads);
}
