#include "damage.h"

#include <stdlib.h>
#include <string.h>

static void *allocate(void *user, size_t size, size_t alignment)
{
    struct limited_memory *memory = user;
    if (size > memory->left)
        return NULL;
    void *block = alignment <= _Alignof(max_align_t)
                      ? malloc(size)
                      : aligned_alloc(alignment, (size + alignment - 1) & ~(alignment - 1));
    if (block)
        memory->left -= size;
    return block;
}

static void release(void *user, void *block, size_t size)
{
    struct limited_memory *memory = user;
    memory->left += size;
    free(block);
}

void limited_memory_init(struct limited_memory *memory, uint64_t limit)
{
    *memory = (struct limited_memory){limit, limit, {memory, allocate, release}};
}

/* Written from docs/replay.md, without the library's functions. */
static uint64_t fnv(uint64_t hash, const uint8_t *data, size_t size)
{
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ data[i]) * UINT64_C(0x100000001B3);
    return hash;
}

static void put_u64(uint8_t *out, uint64_t value)
{
    for (int i = 0; i < 8; i++)
        out[i] = (uint8_t)(value >> (8 * i));
}

void reseal_trace(uint8_t *data, size_t size)
{
    if (size < 40)
        return;
    uint64_t hash = fnv(UINT64_C(0xCBF29CE484222325), data, 32);
    put_u64(data + 32, hash);
    bool snapshot = data[8] == 2; /* a snapshot ends with an empty block */
    for (size_t at = 40; size - at >= 12;) {
        uint8_t *block = data + at;
        uint64_t length = block[0] | (uint64_t)block[1] << 8 | (uint64_t)block[2] << 16 |
                          (uint64_t)block[3] << 24;
        if (length == 0 && !snapshot) {
            if (size - at >= 28)
                put_u64(block + 20, fnv(hash, block, 20));
            return;
        }
        if (length > size - at - 12)
            return;
        hash = fnv(fnv(hash, block, 4), block + 12, (size_t)length);
        put_u64(block + 4, hash);
        at += 12 + (size_t)length;
        snapshot = snapshot && length > 0;
    }
}

static void ignore_line(void *user, const char *line)
{
    size_t *total = user;
    *total += strlen(line);
}

struct kept_bytes {
    uint8_t *data;
    size_t size;
};

static SluiceResult keep(void *user, const void *data, size_t size)
{
    struct kept_bytes *kept = user;
    uint8_t *grown = realloc(kept->data, kept->size + size + 1);
    if (!grown)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    kept->data = grown;
    memcpy(kept->data + kept->size, data, size);
    kept->size += size;
    return SLUICE_SUCCESS;
}

/* Continues from a checkpoint after every 16th call. */
static SluiceResult play_on(SluiceTracePlayer *player)
{
    SluiceTraceCall call = {.structSize = sizeof call};
    SluiceResult result = sluiceGetNextTraceCall(player, &call);
    for (uint32_t i = 1; result == SLUICE_SUCCESS && call.kind != SLUICE_TRACE_CALL_NONE; i++) {
        struct kept_bytes kept = {NULL, 0};
        const SluiceRecordWriter writer = {&kept, keep};
        result = sluicePlayTraceCall(player);
        if (result == SLUICE_SUCCESS && i % 16 == 0)
            result = sluiceWriteTraceCheckpoint(player, &writer);
        if (result == SLUICE_SUCCESS && i % 16 == 0)
            result = sluiceReadTraceCheckpoint(player, kept.data, kept.size);
        free(kept.data);
        if (result == SLUICE_SUCCESS)
            result = sluiceGetNextTraceCall(player, &call);
    }
    return result;
}

SluiceResult play_damaged_by_calls(const void *data, size_t size, SluiceTracePlayerState *state)
{
    struct limited_memory memory;
    limited_memory_init(&memory, UINT64_C(12) << 20); /* two managers, and a checkpoint */
    const SluiceTracePlayerCreateInfo info = {
        .structSize = sizeof info, .pData = data, .size = size, .pAllocator = &memory.callbacks};
    SluiceTracePlayer *player;
    SluiceResult result = sluiceCreateTracePlayer(&info, &player);
    if (result == SLUICE_SUCCESS) {
        result = play_on(player);
        if (sluiceGetTracePlayerState(player, state) != SLUICE_SUCCESS)
            abort();
    }
    sluiceDestroyTracePlayer(player);
    if (memory.left != memory.limit)
        abort();
    return result;
}

SluiceResult play_damaged(const void *data, size_t size, SluiceReplayResult *result)
{
    struct limited_memory memory;
    size_t total = 0;
    limited_memory_init(&memory, UINT64_C(4) << 20);
    const SluiceReplayInfo info = {.structSize = sizeof info,
                                   .pData = data,
                                   .size = size,
                                   .pAllocator = &memory.callbacks,
                                   .pUserData = &total,
                                   .pfnLine = ignore_line,
                                   .heapTileCapacity = 16,
                                   .maxHeapCount = 8,
                                   .numExtraStandbyTiles = 8,
                                   .tilesPerFrame = 8,
                                   .latency = 1};
    SluiceResult status = sluiceReplay(&info, result);
    if (memory.left != memory.limit)
        abort();
    return status;
}
