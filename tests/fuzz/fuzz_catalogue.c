/*
 * Any bytes as a catalogue: it is refused, or its stores are found by a name, and then by their own
 * names. Bytes up to the first end of line are the name, the rest are rows, or the whole file if
 * the name is empty. With clang:
 *
 *     CC=clang meson setup BUILD -Db_sanitize=address,undefined -Db_lundef=false \
 *         -Dc_args=-fsanitize=fuzzer-no-link
 *     ninja -C BUILD tests/open/fuzz_catalogue_libfuzzer
 *     BUILD/tests/open/fuzz_catalogue_libfuzzer -max_len=600 tests/fuzz/corpus/catalogue
 *
 * In the ordinary test run standalone.c plays the corpus.
 */
#include "base/alloc.h"
#include "open/catalogue.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char head[] =
    "sluice catalogue 1\nhash\tformat\twidth\theight\tlayers\tbytes\tpicture\tstore\n";

static void note_refusal(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)severity;
    *(bool *)user = strstr(message, "has no picture and no store") != NULL;
}

static void find(const struct slc_catalogue *catalogue, const struct slc_catalogue_place *place,
                 const char *name, bool *is_missing)
{
    struct slc_catalogue_entry entry = {0}, again = {0};
    if (slc_catalogue_find(catalogue, place, name, &entry) != SLUICE_SUCCESS)
        return;
    if (!entry.store[0])
        abort();
    *is_missing = false;
    if (slc_catalogue_find(catalogue, place, entry.store, &again) == SLUICE_SUCCESS
            ? strcmp(again.store, entry.store) != 0 && strstr(again.store, entry.store) == NULL
            : *is_missing)
        abort();
    slc_catalogue_entry_finish(&entry, place->allocator);
    slc_catalogue_entry_finish(&again, place->allocator);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint8_t *end = size ? memchr(data, '\n', size) : NULL;
    const size_t name_size = end ? (size_t)(end - data) : 0, rest = end ? size - name_size - 1 : 0;
    const size_t head_size = name_size ? sizeof head - 1 : 0;
    char *name = calloc(name_size + 1, 1), *text = malloc(head_size + rest + 1);
    if (rest == 0 || !name || !text) {
        free(name);
        free(text);
        return 0;
    }
    memcpy(name, data, name_size);
    memcpy(text, head, head_size);
    memcpy(text + head_size, end + 1, rest);
    bool is_missing = false;
    const SluiceAllocationCallbacks allocator = slc_allocator(NULL);
    const SluiceLogCallback log = {&is_missing, note_refusal};
    const SluiceInput input = {
        .structSize = sizeof input, .pBytes = text, .size = head_size + rest};
    const struct slc_catalogue_place place = {
        .path = "x", .shown = "x", .input = &input, .allocator = &allocator, .log = &log};
    struct slc_catalogue *catalogue = NULL;
    if (slc_catalogue_read(&place, &catalogue) == SLUICE_SUCCESS) {
        find(catalogue, &place, name, &is_missing);
        find(catalogue, &place, NULL, &is_missing);
    }
    slc_catalogue_destroy(catalogue, &allocator);
    free(name);
    free(text);
    return 0;
}
