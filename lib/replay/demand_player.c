#include "replay/demand_player.h"

#include "base/alloc.h"
#include "demand/page_snapshot.h"
#include "replay/demand_dump.h"
#include "replay/demand_record.h"
#include "replay/hash.h"

#include <inttypes.h>

/* Statistics of the calls ------------------------------------------------------------------ */

static void count_call(SluiceDemandReplayStatistics *counts, const struct slc_page_call *call)
{
    switch (call->kind) {
    case SLC_PAGE_CALL_BEGIN: counts->launchCount++; break;
    case SLC_PAGE_CALL_USE: counts->useCount++; break;
    case SLC_PAGE_CALL_REQUEST:
        counts->requestCount++;
        counts->loadCount += call->request_answer == SLC_REQUEST_LOAD;
        counts->refusalCount += call->request_answer == SLC_REQUEST_REFUSED;
        counts->postponedCount += call->request_answer == SLC_REQUEST_POSTPONED;
        break;
    case SLC_PAGE_CALL_FAILED: counts->failureCount++; break;
    default: break;
    }
}

static void note(void *user, const struct slc_page_call *call)
{
    struct slc_demand_player *player = user;
    player->hash = slc_hash_page_call(player->hash, call);
    count_call(&player->counts, call);
    slc_dump_page_call(&player->dump, call);
    if (player->recorder.notify)
        player->recorder.notify(player->recorder.user, call);
}

static const struct slc_page_call *next_answer(struct slc_demand_player *player,
                                               enum slc_page_call_kind kind)
{
    if (player->answers_used < player->answer_count &&
        player->answers[player->answers_used].kind == kind)
        return &player->answers[player->answers_used++];
    player->answers_differ = true;
    return NULL;
}

static uint32_t take(void *user, uint32_t kind)
{
    (void)kind;
    const struct slc_page_call *answer = next_answer(user, SLC_PAGE_CALL_TAKE);
    return answer ? answer->place : SLC_NO_PLACE;
}

/* Ignores returned places: free places follow from the recorded answers. */
static void give(void *user, uint32_t place, uint32_t page)
{
    (void)user;
    (void)place;
    (void)page;
}

static bool retake(void *user, uint32_t place, uint32_t page)
{
    (void)place;
    (void)page;
    const struct slc_page_call *answer = next_answer(user, SLC_PAGE_CALL_RETAKE);
    return answer && answer->answer;
}

/* The player ------------------------------------------------------------------------------- */

SluiceResult slc_demand_player_init(struct slc_demand_player *player,
                                    const SluiceAllocationCallbacks *cb,
                                    const struct slc_page_residency_create_info *info)
{
    *player = (struct slc_demand_player){
        .cb = *cb, .class_count = info->class_count, .hash = SLC_HASH_EMPTY};
    struct slc_page_residency_create_info own = *info;
    own.cb = &player->cb;
    return slc_residency_create(&own, &player->residency);
}

static struct slc_page_memory player_memory(struct slc_demand_player *player)
{
    return (struct slc_page_memory){player, take, give, retake};
}

static void dump_snapshot(struct slc_demand_player *player)
{
    SluiceDemandReplayStatistics s = {0};
    slc_demand_player_statistics(player, &s);
    slc_dump_line(&player->dump,
                  "snapshot launch=%" PRIu64 " resident=%" PRIu64 " loading=%" PRIu64
                  " refused=%" PRIu64,
                  player->begun, s.residentCount, s.loadingCount, s.refusedCount);
}

void slc_demand_player_restore(void *user, struct slc_snapshot_io *io)
{
    struct slc_demand_player *player = user;
    const struct slc_page_memory memory = player_memory(player);
    slc_residency_read_snapshot(player->residency, &memory, io);
    slc_residency_get_launches(player->residency, &player->begun, &player->prepared);
    if (slc_snapshot_is_good(io))
        dump_snapshot(player);
}

void slc_demand_player_begin(struct slc_demand_player *player)
{
    player->recorder = slc_residency_observer(player->residency);
    slc_residency_set_observer(player->residency, (struct slc_page_observer){player, note});
}

void slc_demand_player_finish(struct slc_demand_player *player)
{
    slc_residency_destroy(player->residency);
    slc_free(&player->cb, player->answers, player->answer_capacity, sizeof *player->answers);
    slc_free(&player->cb, player->entries, player->entries_size, 1);
    *player = (struct slc_demand_player){.cb = player->cb};
}

SluiceResult slc_demand_player_add_answer(struct slc_demand_player *player,
                                          const struct slc_page_call *answer)
{
    if (player->answer_count == player->answer_capacity) {
        size_t capacity = player->answer_capacity ? 2 * player->answer_capacity : 4;
        struct slc_page_call *answers = slc_regrow(
            &player->cb, player->answers, player->answer_capacity, capacity, sizeof *answers);
        if (!answers)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        player->answers = answers;
        player->answer_capacity = capacity;
    }
    player->answers[player->answer_count++] = *answer;
    return SLUICE_SUCCESS;
}

/* Allocates room for a list, but never more than its possible entries. */
static void *make_room(struct slc_demand_player *player, uint32_t room, size_t size)
{
    uint32_t most = slc_residency_most_entries(player->residency);
    size_t need = (most < room ? most : room) * size;
    if (need == 0)
        need = size;
    if (need <= player->entries_size)
        return player->entries;
    slc_free(&player->cb, player->entries, player->entries_size, 1);
    player->entries_size = 2 * need;
    player->entries = slc_alloc(&player->cb, player->entries_size, 1);
    if (!player->entries)
        player->entries_size = 0;
    return player->entries;
}

/* Returns the misuse in a call, or NULL for a call that users of the residency may make. */
static const char *find_misuse(const struct slc_demand_player *player,
                               const struct slc_page_call *call)
{
    bool had_memory;
    switch (call->kind) {
    case SLC_PAGE_CALL_SET_CLASS:
        if (call->class_index >= player->class_count)
            return "there is no such class";
        slc_residency_get_class(player->residency, call->class_index, &had_memory);
        /* only an empty class may change between with and without memory */
        return had_memory != call->flag &&
                       !slc_residency_class_is_empty(player->residency, call->class_index)
                   ? "a class that has pages gets memory or loses it"
                   : NULL;
    case SLC_PAGE_CALL_BEGIN:
        return call->launch <= player->begun || call->launch == UINT64_MAX
                   ? "launches are not numbered in order"
                   : NULL;
    case SLC_PAGE_CALL_PREPARE:
        return call->launch <= player->begun || call->launch < player->prepared ||
                       call->launch == UINT64_MAX
                   ? "launches are not prepared in order"
                   : NULL;
    case SLC_PAGE_CALL_ABANDON:
        return call->launch <= player->begun ? "a launch that was begun is abandoned" : NULL;
    case SLC_PAGE_CALL_REQUEST:
        return call->request.class_index >= player->class_count ? "there is no such class" : NULL;
    case SLC_PAGE_CALL_SETTLE:
        return call->value > UINT32_MAX ? "more pages are missing than there are" : NULL;
    case SLC_PAGE_CALL_LOADED:
    case SLC_PAGE_CALL_FAILED:
        return slc_residency_is_loading(player->residency, call->page) ? NULL
                                                                       : "the page is not loading";
    case SLC_PAGE_CALL_FORGET:
        return call->count > (uint64_t)UINT32_MAX + 1 ? "more pages are forgotten than there are"
                                                      : NULL;
    default: return NULL;
    }
}

static SluiceResult make_request(struct slc_demand_player *player, struct slc_page_call *call)
{
    if (call->result == SLUICE_ERROR_OUT_OF_HOST_MEMORY) {
        call->request_answer = SLC_REQUEST_POSTPONED;
        note(player, call);
        return SLUICE_SUCCESS;
    }
    call->request_answer = slc_residency_request(player->residency, &call->request, &call->result);
    return call->result;
}

static SluiceResult take_list(struct slc_demand_player *player, struct slc_page_call *call)
{
    bool changes = call->kind == SLC_PAGE_CALL_TAKE_CHANGES;
    void *entries =
        make_room(player, call->capacity, changes ? sizeof *call->changes : sizeof *call->evicted);
    if (!entries)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    call->count = changes ? slc_residency_take_changes(player->residency, entries, call->capacity)
                          : slc_residency_take_evicted(player->residency, entries, call->capacity);
    return SLUICE_SUCCESS;
}

static SluiceResult make_call(struct slc_demand_player *player, struct slc_page_call *call)
{
    const struct slc_page_memory memory = player_memory(player);
    struct slc_demand_residency *r = player->residency;
    switch (call->kind) {
    case SLC_PAGE_CALL_SET_CLASS:
        return slc_residency_set_class(r, call->class_index, call->value,
                                       call->flag ? &memory : NULL);
    case SLC_PAGE_CALL_BEGIN:
        player->begun = call->launch;
        slc_residency_begin(r, call->launch);
        break;
    case SLC_PAGE_CALL_USE: slc_residency_use(r, call->page); break;
    case SLC_PAGE_CALL_REQUEST: return make_request(player, call);
    case SLC_PAGE_CALL_SETTLE: slc_residency_settle(r, call->value); break;
    case SLC_PAGE_CALL_PREPARE:
        player->prepared = call->launch;
        slc_residency_prepare(r, call->launch);
        break;
    case SLC_PAGE_CALL_ABANDON:
        if (player->prepared >= call->launch)
            player->prepared = call->launch - 1;
        slc_residency_abandon(r, call->launch);
        break;
    case SLC_PAGE_CALL_LOADED: slc_residency_loaded(r, call->page, call->value); break;
    case SLC_PAGE_CALL_FAILED: slc_residency_failed(r, call->page, call->flag); break;
    case SLC_PAGE_CALL_RETRY: call->answer = slc_residency_retry(r, call->page); break;
    case SLC_PAGE_CALL_FORGET: slc_residency_forget(r, call->page, call->count); break;
    case SLC_PAGE_CALL_TAKE_CHANGES:
    case SLC_PAGE_CALL_TAKE_EVICTED: return take_list(player, call);
    case SLC_PAGE_CALL_SET_SWITCHES: slc_residency_set_switches(r, call->flag, call->answer); break;
    case SLC_PAGE_CALL_TAKE:
    case SLC_PAGE_CALL_RETAKE:
    case SLC_PAGE_CALL_GIVE:
    case SLC_PAGE_CALL_KINDS: break; /* no calls of the residency */
    }
    return SLUICE_SUCCESS;
}

SluiceResult slc_demand_player_call(struct slc_demand_player *player, struct slc_page_call *call,
                                    const char **why)
{
    *why = find_misuse(player, call);
    if (*why)
        return SLUICE_ERROR_CORRUPT_DATA;
    player->dump.event = ++player->event_count;
    return make_call(player, call);
}

void slc_demand_player_statistics(const struct slc_demand_player *player,
                                  SluiceDemandReplayStatistics *statistics)
{
    *statistics = player->counts;
    for (uint32_t i = 0; i < player->class_count; i++) {
        struct slc_residency_counts counts;
        slc_residency_get_counts(player->residency, i, &counts);
        statistics->residentCount += counts.resident;
        statistics->loadingCount += counts.loading;
        statistics->refusedCount += counts.refused;
        statistics->evictedCount += counts.evicted;
        statistics->restoredCount += counts.restored;
    }
    statistics->lodBias = slc_residency_lod_bias(player->residency);
}
