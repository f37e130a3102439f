#include "replay/record.h"

#include "base/alloc.h"
#include "replay/runs.h"
#include "support/test.h"

#include <stddef.h>
#include <string.h>

#define KIND_COUNT 25

static uint64_t next_random(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    uint64_t bits = *seed >> 11 ^ *seed << 40;
    return bits >> (*seed >> 58); /* any magnitude */
}

#define DESC_NUMBERS (offsetof(SluiceStreamedTextureDesc, packedTilesOutside) / sizeof(uint32_t))

struct example {
    struct slc_call call;
    uint64_t hash;
    SluiceStreamedTextureManagerConfig config;
    SluiceStreamedTextureDesc desc;
    SluiceFeedbackDesc feedback;
    SluiceUvTransform uv;
    uint8_t map[64];
    uint32_t indices[16];
};

static void fill_inputs(struct example *e, uint64_t *seed)
{
    uint64_t r = next_random(seed);
    uint32_t *desc = (uint32_t *)&e->desc;
    for (size_t i = 0; i < DESC_NUMBERS; i++)
        desc[i] = (uint32_t)next_random(seed);
    e->desc.packedTilesOutside = next_random(seed) & 1;
    e->config.numExtraStandbyTiles = (uint32_t)next_random(seed);
    e->config.maxHeapCount = (uint32_t)next_random(seed);
    e->config.maxLoadAttempts = (uint32_t)next_random(seed);
    e->config.retryDelayTicks = next_random(seed);
    e->config.missesToExpire = next_random(seed) % 2 ? 0 : (uint32_t)next_random(seed);
    e->config.prefetchLevels = next_random(seed) % 2 ? 0 : (uint32_t)next_random(seed);
    e->config.givenUpRetryDelayTicks = next_random(seed);
    e->config.targetHeapCount = next_random(seed) % 2 ? 0 : (uint32_t)next_random(seed);
    e->config.noEviction = next_random(seed) % 4 == 0;
    e->config.noMipBias = next_random(seed) % 4 == 0;
    e->config.separatePackedTiles = next_random(seed) % 4 == 0;
    e->feedback.width = 1 + next_random(seed) % 8;
    e->feedback.height = 1 + next_random(seed) % 8;
    e->feedback.mipBias = (int32_t)next_random(seed);
    e->feedback.streamedMipLevels = (uint32_t)next_random(seed);
    e->feedback.pMinMip = r & 1 ? e->map : NULL;
    for (int i = 0; i < 64; i++)
        e->map[i] = (uint8_t)next_random(seed);
    for (int i = 0; i < 16; i++)
        e->indices[i] = (uint32_t)next_random(seed);
    e->uv = (SluiceUvTransform){.scaleU = (float)(int64_t)next_random(seed),
                                .scaleV = (float)(int64_t)next_random(seed) / 3,
                                .offsetU = (float)(int64_t)next_random(seed) / 5,
                                .offsetV = (float)(int64_t)next_random(seed) / 7,
                                .wrapU = (SluiceUvWrap)(next_random(seed) % 4),
                                .wrapV = (SluiceUvWrap)(next_random(seed) % 4)};
    e->call.uv = r & 32 ? &e->uv : NULL;
    e->call.config = r & 2 ? &e->config : NULL;
    e->call.desc = r & 4 ? &e->desc : NULL;
    e->call.feedback = r & 8 ? &e->feedback : NULL;
    e->call.tile_indices = r & 16 ? e->indices : NULL;
}

static void make_example(struct example *e, uint32_t kind, uint64_t *seed)
{
    static const SluiceResult results[] = {SLUICE_SUCCESS, SLUICE_INCOMPLETE,
                                           SLUICE_ERROR_STALE_TEXTURE, SLUICE_ERROR_UNKNOWN_TILE,
                                           SLUICE_ERROR_OUT_OF_HOST_MEMORY};
    memset(e, 0, sizeof *e);
    fill_inputs(e, seed);
    e->hash = next_random(seed);
    e->call.kind = (enum slc_call_kind)kind;
    e->call.result = results[next_random(seed) % 5];
    e->call.texture_id = next_random(seed);
    e->call.primary_id = next_random(seed);
    e->call.time_stamp = next_random(seed);
    e->call.timeout = next_random(seed);
    e->call.retire_value = next_random(seed);
    e->call.keep_count = (uint32_t)next_random(seed);
    e->call.heap_id = (uint32_t)next_random(seed);
    e->call.room = (uint32_t)next_random(seed);
    e->call.priority = (int32_t)next_random(seed);
    e->call.query = next_random(seed) & 1;
    e->call.count = next_random(seed) % 16;
}

static void check_map(const struct example *e, struct slc_record *back)
{
    const SluiceFeedbackDesc *a = e->call.feedback, *b = back->call.feedback;
    assert_true(!a == !b);
    if (!a)
        return;
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->mipBias, b->mipBias);
    assert_int_equal(a->streamedMipLevels, b->streamedMipLevels);
    bool kept = a->pMinMip && e->call.result >= 0;
    assert_int_equal(back->contents, kept         ? SLC_INPUT_PRESENT
                                     : a->pMinMip ? SLC_INPUT_ABSENT
                                                  : SLC_INPUT_NULL);
    if (!kept)
        return;
    uint8_t map[64];
    slc_get_runs(&back->encoded, map, (size_t)a->width * a->height);
    assert_null(back->encoded.why);
    assert_memory_equal(map, e->map, (size_t)a->width * a->height);
}

static void check_indices(const struct example *e, struct slc_record *back)
{
    bool kept = e->call.tile_indices &&
                (e->call.result >= 0 || e->call.result == SLUICE_ERROR_UNKNOWN_TILE);
    assert_int_equal(back->call.count, e->call.count);
    assert_int_equal(back->contents, kept                   ? SLC_INPUT_PRESENT
                                     : e->call.tile_indices ? SLC_INPUT_ABSENT
                                                            : SLC_INPUT_NULL);
    uint32_t indices[16];
    if (!kept)
        return;
    slc_get_tile_indices(back, indices);
    assert_memory_equal(indices, e->indices, e->call.count * sizeof *indices);
}

static void check_same(const struct example *e, struct slc_record *back)
{
    const struct slc_call *a = &e->call, *b = &back->call;
    uint32_t fields = slc_call_fields(a->kind);
    assert_int_equal(a->kind, b->kind);
    assert_int_equal(a->result, b->result);
    if (fields & SLC_FIELD_TEXTURE)
        assert_true(a->texture_id == b->texture_id);
    if (fields & SLC_FIELD_PRIMARY)
        assert_true(a->primary_id == b->primary_id);
    if (fields & SLC_FIELD_TIME)
        assert_true(a->time_stamp == b->time_stamp);
    if (fields & SLC_FIELD_TIMEOUT)
        assert_true(a->timeout == b->timeout);
    if (fields & SLC_FIELD_RETIRE)
        assert_true(a->retire_value == b->retire_value);
    if (fields & SLC_FIELD_KEEP)
        assert_int_equal(a->keep_count, b->keep_count);
    if (fields & SLC_FIELD_HEAP)
        assert_int_equal(a->heap_id, b->heap_id);
    if (fields & SLC_FIELD_CONFIG) {
        assert_true(!a->config == !b->config);
        if (a->config) {
            assert_int_equal(a->config->numExtraStandbyTiles, b->config->numExtraStandbyTiles);
            assert_int_equal(a->config->maxHeapCount, b->config->maxHeapCount);
            assert_int_equal(a->config->maxLoadAttempts, b->config->maxLoadAttempts);
            assert_true(a->config->retryDelayTicks == b->config->retryDelayTicks);
            assert_int_equal(a->config->missesToExpire, b->config->missesToExpire);
            assert_int_equal(a->config->prefetchLevels, b->config->prefetchLevels);
            assert_true(a->config->givenUpRetryDelayTicks == b->config->givenUpRetryDelayTicks);
            assert_int_equal(a->config->targetHeapCount, b->config->targetHeapCount);
            assert_int_equal(a->config->noEviction, b->config->noEviction);
            assert_int_equal(a->config->noMipBias, b->config->noMipBias);
            assert_int_equal(a->config->separatePackedTiles, b->config->separatePackedTiles);
        }
    }
    if (fields & SLC_FIELD_DESC) {
        assert_true(!a->desc == !b->desc);
        if (a->desc)
            assert_memory_equal(a->desc, b->desc, DESC_NUMBERS * sizeof(uint32_t));
        if (a->desc)
            assert_int_equal(a->desc->packedTilesOutside, b->desc->packedTilesOutside);
        if (a->desc && a->result >= 0)
            assert_true(a->texture_id == b->texture_id);
    }
    if (fields & SLC_FIELD_FEEDBACK)
        check_map(e, back);
    if (fields & SLC_FIELD_INDICES)
        check_indices(e, back);
    if (fields & SLC_FIELD_PRIORITY)
        assert_int_equal(a->priority, b->priority);
    if (fields & SLC_FIELD_UV) {
        assert_true(!a->uv == !b->uv);
        if (a->uv)
            assert_memory_equal(a->uv, b->uv, sizeof *a->uv);
    }
    if (fields & SLC_FIELD_LIST) {
        assert_int_equal(a->query, b->query);
        assert_int_equal(a->room, b->room);
        assert_int_equal(a->count, b->count);
        assert_true(e->hash == back->hash);
    }
}

static void calls_of_every_kind_come_back(void **state)
{
    (void)state;
    uint64_t seed = 3;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    for (int round = 0; round < 2000; round++) {
        for (uint32_t kind = 1; kind <= KIND_COUNT; kind++) {
            struct example example;
            make_example(&example, kind, &seed);
            struct slc_bytes bytes;
            slc_bytes_init(&bytes, &cb);
            slc_put_record(&bytes, &example.call, example.hash);
            assert_false(bytes.failed);
            struct slc_cursor in = {bytes.data, 0, bytes.size, NULL};
            struct slc_record back;
            slc_get_record(&in, &back);
            assert_null(in.why);
            assert_int_equal(in.pos, in.end);
            check_same(&example, &back);
            slc_bytes_finish(&bytes);
        }
    }
}

static void record_cut_anywhere_fails_inside_of_it(void **state)
{
    (void)state;
    uint64_t seed = 4;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    for (int round = 0; round < 100; round++) {
        for (uint32_t kind = 1; kind <= KIND_COUNT; kind++) {
            struct example example;
            make_example(&example, kind, &seed);
            struct slc_bytes bytes;
            slc_bytes_init(&bytes, &cb);
            slc_put_record(&bytes, &example.call, example.hash);
            for (size_t cut = 0; cut < bytes.size; cut++) {
                struct slc_cursor in = {bytes.data, 0, cut, NULL};
                struct slc_record back;
                slc_get_record(&in, &back);
                assert_non_null(in.why);
                assert_true(in.pos <= cut);
            }
            slc_bytes_finish(&bytes);
        }
    }
}

static void unknown_kinds_are_refused(void **state)
{
    (void)state;
    for (uint32_t kind = 0; kind < 256; kind++) {
        uint8_t data[64] = {(uint8_t)kind};
        struct slc_cursor in = {data, 0, sizeof data, NULL};
        struct slc_record record;
        slc_get_record(&in, &record);
        if (kind < 1 || kind > KIND_COUNT) {
            assert_non_null(in.why);
            assert_int_equal(in.pos, 0);
        }
    }
}

static void check_stored_id(enum slc_call_kind kind, SluiceTextureId id, size_t size,
                            const uint8_t *bytes)
{
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    const struct slc_call call = {.kind = kind, .texture_id = id};
    struct slc_bytes out;
    slc_bytes_init(&out, &cb);
    slc_put_record(&out, &call, 0);
    assert_memory_equal(out.data + 2, bytes, size); /* after kind and result */
    struct slc_cursor in = {out.data, 0, out.size, NULL};
    struct slc_record back;
    slc_get_record(&in, &back);
    assert_true(back.call.texture_id == id);
    slc_bytes_finish(&out);
}

static void all_textures_are_stored_as_0(void **state)
{
    (void)state;
    static const uint8_t zero[2] = {0, 0};
    static const uint8_t ones[10] = {255, 255, 255, 255, 15, 255, 255, 255, 255, 15};
    static const uint8_t one[2] = {1, 1};
    static const enum slc_call_kind kinds[] = {SLC_CALL_GET_TILES_TO_MAP, SLC_CALL_RETRY_FAILED,
                                               SLC_CALL_GET_TILES_TO_CANCEL,
                                               SLC_CALL_GET_TILES_TO_UNMAP};
    for (size_t i = 0; i < 4; i++) {
        check_stored_id(kinds[i], SLUICE_ALL_TEXTURES, 2, zero);
        check_stored_id(kinds[i], SLUICE_NO_TEXTURE, 10, ones);
        check_stored_id(kinds[i], 0x100000001, 2, one);
    }
    check_stored_id(SLC_CALL_SET_PRIMARY, SLUICE_NO_TEXTURE, 2, zero);
    check_stored_id(SLC_CALL_UPDATE_MAPPING, UINT64_MAX, 10, ones);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_of_every_kind_come_back),
        cmocka_unit_test(record_cut_anywhere_fails_inside_of_it),
        cmocka_unit_test(all_textures_are_stored_as_0),
        cmocka_unit_test(unknown_kinds_are_refused),
    };
    return RUN_TESTS(tests);
}
