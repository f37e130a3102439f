/* Verification finds every error, and no other. */
#include "store/naive_store.h"
#include "store/stores.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

struct found {
    SluiceStoreDefect defects[64];
    uint32_t count, progress_calls, stop_at;
    uint64_t last_done, total;
};

static void note_defect(void *user, const SluiceStoreDefect *defect)
{
    struct found *found = user;
    assert_in_range(found->count, 0, 63);
    found->defects[found->count++] = *defect;
}

static bool note_progress(void *user, uint64_t done, uint64_t total)
{
    struct found *found = user;
    assert_true(found->progress_calls == 0 || done > found->last_done);
    found->last_done = done;
    found->total = total;
    return ++found->progress_calls != found->stop_at;
}

static SluiceResult verify(const char *path, struct found *found, SluiceStoreReport *report)
{
    SluiceStoreVerifyInfo info = {.structSize = sizeof info,
                                  .pPath = path,
                                  .pUserData = found,
                                  .pfnDefect = note_defect,
                                  .pfnProgress = note_progress};
    return sluiceVerifyStore(&info, report);
}

static void write_picture(const struct scratch *scratch, enum picture picture, uint32_t compression)
{
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .pPath = scratch->path,
                                  .width = 1300,
                                  .height = 900,
                                  .arrayLayerCount = 2,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .compressionLevel = compression};
    CHECK_OK(write_store(&info, picture));
}

/* Returns whether an earlier chunk has the same place, because tiles with equal bytes share it. */
static bool is_repeat(const struct naive_store *store, uint64_t number)
{
    for (uint64_t i = 0; i < number; i++)
        if (naive_store_chunk(store, i).offset == naive_store_chunk(store, number).offset)
            return true;
    return false;
}

static void a_sound_file_has_no_defects_and_its_sizes_add_up(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        struct scratch scratch;
        scratch_init(&scratch);
        write_picture(&scratch, PICTURE_MIXED, compression);
        struct found found = {0};
        SluiceStoreReport report = {.structSize = sizeof report};
        CHECK_OK(verify(scratch.path, &found, &report));
        assert_int_equal(found.count, 0);
        assert_true(found.progress_calls > 1);
        struct naive_store store;
        assert_null(naive_store_load(&store, scratch.path));
        uint64_t stored = 0, texels = 0, raw = 0, places = 0;
        for (uint64_t i = 0; i < store.chunks; i++) {
            struct naive_chunk chunk = naive_store_chunk(&store, i);
            stored += chunk.size;
            places += is_repeat(&store, i) ? 0 : chunk.size;
            texels += chunk.texel_size;
            raw += chunk.size == chunk.texel_size;
        }
        assert_int_equal(found.total, store.chunks);
        assert_int_equal(report.tileCount, store.chunks);
        assert_int_equal(report.defectCount, 0);
        assert_int_equal(report.storedSize, stored);
        assert_int_equal(report.texelSize, texels);
        assert_int_equal(report.rawTileCount, raw);
        if (compression > 0)
            assert_int_equal(store.data + places, store.size);
        naive_store_finish(&store);
        scratch_finish(&scratch);
    }
}

static void every_damaged_tile_is_named_with_its_place(void **state)
{
    (void)state;
    static const uint64_t bad[] = {0, 17, 118, 230}; /* 117 and 235 are the tails */
    struct scratch scratch;
    scratch_init(&scratch);
    write_picture(&scratch, PICTURE_SMOOTH, 3);
    struct naive_store store;
    assert_null(naive_store_load(&store, scratch.path));
    uint64_t damaged[16];
    uint32_t count = 0;
    for (uint64_t i = 0; i < store.chunks; i++)
        for (size_t j = 0; j < 4; j++) /* tiles with equal bytes share a place */
            if (naive_store_chunk(&store, i).offset == naive_store_chunk(&store, bad[j]).offset) {
                assert_true(count < 16);
                damaged[count++] = i;
            }
    for (size_t i = 0; i < 4; i++)
        store.bytes[naive_store_chunk(&store, bad[i]).offset + 5] ^= 0x10;
    write_bytes(scratch.path, store.bytes, store.size);
    struct found found = {0};
    SluiceStoreReport report = {.structSize = sizeof report};
    CHECK_RESULT(verify(scratch.path, &found, &report), SLUICE_ERROR_CORRUPT_DATA);
    assert_int_equal(found.count, count);
    assert_int_equal(report.defectCount, count);
    assert_int_equal(report.tileCount, store.chunks);
    for (uint32_t i = 0; i < count; i++) {
        const SluiceStoreDefect *defect = &found.defects[i];
        assert_int_equal(defect->offset, naive_store_chunk(&store, damaged[i]).offset);
        assert_int_equal(defect->result, SLUICE_ERROR_CORRUPT_DATA);
        if (damaged[i] >= 88) /* level 0 has 11 x 8 tiles */
            continue;
        const uint32_t place[] = {0, 0, (uint32_t)damaged[i] % 11, (uint32_t)damaged[i] / 11};
        const uint32_t got[] = {defect->arrayLayer, defect->mipLevel, defect->tileX, defect->tileY};
        assert_memory_equal(got, place, sizeof got);
    }
    naive_store_finish(&store);
    scratch_finish(&scratch);
}

static void a_damaged_block_of_the_index_costs_its_tiles_and_no_others(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    write_picture(&scratch, PICTURE_SMOOTH, 3);
    size_t size;
    unsigned char *bytes = read_bytes(scratch.path, &size);
    bytes[8192 + 7] ^= 1;
    write_bytes(scratch.path, bytes, size);
    struct found found = {0};
    SluiceStoreReport report = {.structSize = sizeof report};
    CHECK_RESULT(verify(scratch.path, &found, &report), SLUICE_ERROR_CORRUPT_DATA);
    assert_int_equal(report.defectCount, report.tileCount - 204);
    for (uint32_t i = 0; i < found.count; i++)
        assert_int_equal(found.defects[i].offset, 8192);
    free(bytes);
    scratch_finish(&scratch);
}

static void verifying_stops_when_it_is_told_to(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    write_picture(&scratch, PICTURE_SMOOTH, 3);
    struct found found = {.stop_at = 3};
    SluiceStoreReport report = {.structSize = sizeof report};
    CHECK_RESULT(verify(scratch.path, &found, &report), SLUICE_ERROR_CANCELED);
    assert_int_equal(report.tileCount, found.last_done);
    scratch_finish(&scratch);
}

static void what_cannot_be_opened_cannot_be_verified(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    struct found found = {0};
    SluiceStoreReport report = {.structSize = sizeof report};
    CHECK_RESULT(verify(scratch.path, &found, &report), SLUICE_ERROR_FILE_NOT_FOUND);
    assert_int_equal(report.tileCount, 0);
    write_bytes(scratch.path, "text", 4);
    CHECK_RESULT(verify(scratch.path, &found, NULL), SLUICE_ERROR_CORRUPT_DATA);
    CHECK_RESULT(sluiceVerifyStore(NULL, NULL), SLUICE_ERROR_NULL_POINTER);
    assert_int_equal(found.count, 0);
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sound_file_has_no_defects_and_its_sizes_add_up),
        cmocka_unit_test(every_damaged_tile_is_named_with_its_place),
        cmocka_unit_test(a_damaged_block_of_the_index_costs_its_tiles_and_no_others),
        cmocka_unit_test(verifying_stops_when_it_is_told_to),
        cmocka_unit_test(what_cannot_be_opened_cannot_be_verified),
    };
    return RUN_TESTS(tests);
}
