/* Writing in turns: several threads write tiles in the order of a single thread. */
#include "store/store_writer.h"

#include "base/log.h"

#include <string.h>

#define MAX_WAITING 16u /* chunks of later turns in memory, 128 KiB each */

/* Inserts a waiting chunk, with the lock held. */
static void insert_waiting(SluiceStoreWriter *writer, struct slc_store_bench *bench)
{
    struct slc_store_bench **at = &writer->waiting;
    while (*at && (*at)->turn < bench->turn)
        at = &(*at)->next;
    bench->next = *at;
    *at = bench;
    writer->waiting_count++;
}

/* Takes the waiting chunk of the earliest turn, if there is one. With the lock held. */
static struct slc_store_bench *take_waiting(SluiceStoreWriter *writer)
{
    struct slc_store_bench *bench = writer->waiting;
    if (!bench || bench->turn != writer->turn)
        return NULL;
    writer->waiting = bench->next;
    writer->waiting_count--;
    return bench;
}

/* Ends the earliest turn: writes the chunk of `bench` (NULL: a turn without a tile), and all
 * waiting chunks that follow without a gap. Only the thread with the earliest turn calls it. */
static SluiceResult end_turns(SluiceStoreWriter *writer, struct slc_store_bench *bench,
                              SluiceResult result)
{
    for (bool is_first = true; is_first || bench; is_first = false) {
        SluiceResult written = bench ? slc_store_writer_write(writer, bench) : SLUICE_SUCCESS;
        if (bench)
            slc_store_writer_give_bench(writer, bench);
        slc_mutex_lock(&writer->mutex);
        if (written != SLUICE_SUCCESS && writer->state == SLC_STORE_WRITING)
            writer->state = SLC_STORE_BROKEN; /* the call of a waiting tile may have returned */
        writer->turn++;
        bench = take_waiting(writer);
        slc_condition_broadcast(&writer->turn_changed);
        slc_mutex_unlock(&writer->mutex);
        result = result == SLUICE_SUCCESS ? written : result;
    }
    return result;
}

static SluiceResult end_turn(SluiceStoreWriter *writer, uint64_t turn,
                             struct slc_store_bench *bench, SluiceResult result)
{
    slc_mutex_lock(&writer->mutex);
    while (turn != writer->turn && (!bench || writer->waiting_count >= MAX_WAITING))
        slc_condition_wait(&writer->turn_changed, &writer->mutex);
    bool waits = turn != writer->turn;
    if (waits) {
        bench->turn = turn;
        insert_waiting(writer, bench);
    }
    slc_mutex_unlock(&writer->mutex);
    return waits ? result : end_turns(writer, bench, result);
}

/* Copies bytes of the caller, which are valid during the call only. */
static void keep_bytes(struct slc_store_bench *bench)
{
    if (bench->bytes == bench->texels || bench->bytes == bench->stored)
        return;
    memcpy(bench->texels, bench->bytes, bench->size);
    bench->bytes = bench->texels;
}

static SluiceResult check_turn(SluiceStoreWriter *writer, uint64_t turn)
{
    slc_mutex_lock(&writer->mutex);
    uint64_t earliest = writer->turn;
    slc_mutex_unlock(&writer->mutex);
    if (turn >= earliest)
        return SLUICE_SUCCESS;
    return slc_log_refusal(&writer->file.log, "turn is %llu; all turns before %llu have ended",
                           (unsigned long long)turn, (unsigned long long)earliest);
}

SluiceResult sluiceWriteStoreTileInTurn(SluiceStoreWriter *writer, uint64_t turn,
                                        uint32_t arrayLayer, uint32_t mipLevel, uint32_t tileX,
                                        uint32_t tileY, const void *pTexels, size_t rowPitch)
{
    if (!writer)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = check_turn(writer, turn);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!pTexels)
        return end_turn(writer, turn, NULL, SLUICE_SUCCESS);
    struct slc_store_place place;
    struct slc_store_bench *bench = NULL;
    result =
        slc_store_writer_check_tile(writer, arrayLayer, mipLevel, tileX, tileY, rowPitch, &place);
    if (result == SLUICE_SUCCESS)
        result = slc_store_writer_take_bench(writer, &bench);
    if (result != SLUICE_SUCCESS)
        return end_turn(writer, turn, NULL, result);
    result = slc_store_writer_compress(writer, &place, pTexels, rowPitch, bench);
    if (result != SLUICE_SUCCESS) {
        slc_store_writer_give_bench(writer, bench);
        return end_turn(writer, turn, NULL, result);
    }
    keep_bytes(bench);
    return end_turn(writer, turn, bench, SLUICE_SUCCESS);
}
