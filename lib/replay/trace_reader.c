#include "replay/trace_reader.h"

#include "base/log.h"
#include "replay/hash.h"

#include <inttypes.h>

SluiceResult slc_read_trace_header(struct slc_replay *replay, uint32_t newest, uint32_t *version,
                                   uint64_t *checksum, uint32_t words[SLC_TRACE_WORDS])
{
    struct slc_cursor *in = &replay->in;
    slc_get_bytes(in, 8);
    uint32_t found = slc_get_u32(in);
    uint32_t library = slc_get_u32(in);
    for (int i = 0; i < SLC_TRACE_WORDS; i++)
        words[i] = slc_get_u32(in);
    *checksum = slc_hash_bytes(SLC_HASH_EMPTY, in->data, in->pos);
    uint64_t stored = slc_get_u64(in);
    if (!in->why && stored != *checksum)
        slc_cursor_fail(in, 0, "the header's checksum is wrong");
    if (in->why)
        return slc_replay_check(replay, in);
    *version = found;
    if (found == 0 || found > newest) {
        slc_log(&replay->info->log, SLUICE_LOG_ERROR,
                "trace has version %" PRIu32 " of the format, this library reads 1 to %" PRIu32,
                found, newest);
        replay->out->errorOffset = 8;
        return SLUICE_ERROR_UNSUPPORTED;
    }
    slc_log(&replay->info->log, SLUICE_LOG_INFO,
            "trace was recorded with Sluice %" PRIu32 ".%" PRIu32 ".%" PRIu32, library >> 22,
            library >> 12 & 1023, library & 4095);
    return SLUICE_SUCCESS;
}

void slc_note_divergence(struct slc_replay *replay, uint64_t event, size_t offset,
                         const char *recorded, const char *got)
{
    if (replay->out->divergedEvent)
        return; /* report only the first; later differences follow from it */
    replay->out->divergedEvent = event;
    replay->out->divergedOffset = offset;
    slc_log(&replay->info->log, SLUICE_LOG_WARNING,
            "decisions differ from event %" PRIu64 " at byte %llu on: recorded %s, got %s", event,
            (unsigned long long)offset, recorded, got);
}

static SluiceResult read_end(struct slc_replay *replay, size_t start, uint64_t checksum,
                             const struct slc_trace_player *player)
{
    struct slc_cursor *in = &replay->in;
    uint64_t event_count = slc_get_u64(in);
    uint64_t hash = slc_get_u64(in);
    checksum = slc_hash_bytes(checksum, in->data + start, in->pos - start);
    uint64_t stored = slc_get_u64(in);
    if (!in->why && stored != checksum)
        slc_cursor_fail(in, start, "the end mark's checksum is wrong");
    if (!in->why && event_count != *player->event_count)
        slc_cursor_fail(in, start, "the end mark counts other events than there are");
    if (!in->why && in->pos != in->end)
        slc_cursor_fail(in, in->pos, "there is more behind the end mark");
    if (in->why)
        return slc_replay_check(replay, in);
    replay->out->recordedHash = hash;
    if (hash != *player->hash)
        slc_note_divergence(replay, *player->event_count, start, "another hash", "this one");
    return SLUICE_SUCCESS;
}

SluiceResult slc_read_block(struct slc_replay *replay, uint64_t *checksum, size_t *end)
{
    struct slc_cursor *in = &replay->in;
    size_t start = in->pos;
    uint32_t size = slc_get_u32(in);
    *checksum = slc_hash_bytes(*checksum, in->data + start, in->pos - start);
    uint64_t stored = slc_get_u64(in);
    size_t payload = in->pos;
    if (!in->why && size > in->end - payload)
        slc_cursor_fail(in, start, "the block that begins here is cut off");
    if (!in->why) {
        *checksum = slc_hash_bytes(*checksum, in->data + payload, size);
        if (stored != *checksum)
            slc_cursor_fail(in, start, "the checksum of the block that begins here is wrong");
    }
    if (in->why)
        return slc_replay_check(replay, in);
    in->pos = payload;
    *end = payload + size;
    return SLUICE_SUCCESS;
}

SluiceResult slc_read_next_block(struct slc_replay *replay, uint64_t *checksum,
                                 const struct slc_trace_player *player, size_t *end, bool *ended)
{
    struct slc_cursor *in = &replay->in;
    size_t start = in->pos;
    *end = start;
    *ended = slc_get_u32(in) == 0 && !in->why;
    if (*ended)
        return read_end(replay, start, *checksum, player);
    in->pos = in->why ? in->pos : start;
    return slc_read_block(replay, checksum, end);
}

SluiceResult slc_play_blocks(struct slc_replay *replay, uint64_t checksum,
                             const struct slc_trace_player *player)
{
    size_t end;
    bool ended = false;
    SluiceResult result = SLUICE_SUCCESS;
    while (result == SLUICE_SUCCESS && !ended) {
        result = slc_read_next_block(replay, &checksum, player, &end, &ended);
        if (result == SLUICE_SUCCESS && !ended)
            result = player->play_block(replay, end);
    }
    return result;
}
