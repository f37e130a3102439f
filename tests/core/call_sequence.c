#include "core/call_sequence.h"

#include <string.h>

#define COUNT_OF(array) ((uint32_t)(sizeof(array) / sizeof((array)[0])))

/* Relative frequency of each call. */
static const uint32_t base_weights[CALL_KIND_COUNT] = {
    [CALL_SET_CONFIG] = 2,
    [CALL_ADD_TEXTURE] = 6,
    [CALL_REMOVE_TEXTURE] = 2,
    [CALL_FEEDBACK] = 40,
    [CALL_MATCH_PRIMARY] = 5,
    [CALL_SET_PRIMARY] = 4,
    [CALL_TILES_TO_MAP] = 30,
    [CALL_MAPPED] = 25,
    [CALL_FAILED] = 8,
    [CALL_CANCELED] = 8,
    [CALL_RETRY] = 2,
    [CALL_GIVEN_UP] = 4,
    [CALL_TILES_TO_CANCEL] = 10,
    [CALL_TILES_TO_UNMAP] = 20,
    [CALL_COMPLETE] = 12,
    [CALL_TRIM] = 3,
    [CALL_DEFRAGMENT] = 4,
    [CALL_EMPTY_HEAPS] = 3,
    [CALL_RELEASE_HEAP] = 4,
    [CALL_MINMIP_UPDATES] = 10,
    [CALL_WRITE_MINMIP] = 2,
    [CALL_WRITE_RECT] = 2,
    [CALL_TILE_STATE] = 2,
    [CALL_LAYOUT] = 1,
    [CALL_TEXTURE_LAYOUT] = 1,
    [CALL_STATISTICS] = 1,
};

/* Last pointer of each call that may be NULL: the manager, the first, the second. */
static const enum call_null last_pointer[CALL_KIND_COUNT] = {
    [CALL_SET_CONFIG] = NULL_FIRST,       [CALL_ADD_TEXTURE] = NULL_SECOND,
    [CALL_REMOVE_TEXTURE] = NULL_MANAGER, [CALL_FEEDBACK] = NULL_FIRST,
    [CALL_MATCH_PRIMARY] = NULL_MANAGER,  [CALL_SET_PRIMARY] = NULL_MANAGER,
    [CALL_TILES_TO_MAP] = NULL_SECOND,    [CALL_MAPPED] = NULL_FIRST,
    [CALL_FAILED] = NULL_FIRST,           [CALL_CANCELED] = NULL_FIRST,
    [CALL_RETRY] = NULL_MANAGER,          [CALL_GIVEN_UP] = NULL_SECOND,
    [CALL_TILES_TO_CANCEL] = NULL_SECOND, [CALL_TILES_TO_UNMAP] = NULL_SECOND,
    [CALL_COMPLETE] = NULL_MANAGER,       [CALL_TRIM] = NULL_MANAGER,
    [CALL_EVACUATE] = NULL_MANAGER,       [CALL_DEFRAGMENT] = NULL_SECOND,
    [CALL_EMPTY_HEAPS] = NULL_SECOND,     [CALL_RELEASE_HEAP] = NULL_MANAGER,
    [CALL_MINMIP_UPDATES] = NULL_SECOND,  [CALL_WRITE_MINMIP] = NULL_FIRST,
    [CALL_WRITE_RECT] = NULL_SECOND,      [CALL_TILE_STATE] = NULL_SECOND,
    [CALL_LAYOUT] = NULL_SECOND,          [CALL_TEXTURE_LAYOUT] = NULL_FIRST,
    [CALL_STATISTICS] = NULL_FIRST,       [CALL_FORGET] = NULL_MANAGER,
    [CALL_EVICT] = NULL_MANAGER,
};

void call_sequence_start(struct call_sequence *s, struct choice choice)
{
    static const uint32_t capacities[] = {1, 2, 3, 4, 5, 8, 16, 64, 65, 200};
    static const uint32_t tiles[] = {6, 30, 80, 160, 160, 700};
    static const uint64_t times[] = {0, 1, (uint64_t)1 << 63, UINT64_MAX, UINT64_MAX - 100};
    static const uint64_t timeouts[] = {
        0, 1, 5, 12, 30, 60, 100, 200, 400, (uint64_t)1 << 40, UINT64_MAX};
    memset(s, 0, offsetof(struct call_sequence, last_map));
    s->choice = choice;
    struct choice *c = &s->choice;
    s->capacity = choice_once_in(c, 2) ? choice_range(c, 1, 40)
                                       : capacities[choice_below(c, COUNT_OF(capacities))];
    s->configured = choice_once_in(c, 2);
    s->visibility = choice_range(c, 1, 16);
    s->wandering = choice_range(c, 10, 150);
    s->favoring = choice_below(c, 5);
    s->always_packed = choice_once_in(c, 2);
    for (int k = 0; k < CALL_KIND_COUNT; k++)
        s->weights[k] = base_weights[k] * (1 + choice_below(c, 4));
    if (choice_once_in(c, 4)) /* a bad day: most loads fail */
        s->weights[CALL_FAILED] *= 6;
    if (choice_once_in(c, 4)) /* a fast camera: most loads are canceled */
        s->weights[CALL_CANCELED] *= 4;
    s->mistakes = choice_once_in(c, 4) ? 0 : choice_range(c, 8, 60);
    s->starving = choice_once_in(c, 2) ? 0 : choice_range(c, 3, 30);
    s->refusing = choice_once_in(c, 3) ? 0 : choice_range(c, 1, 8);
    s->max_tiles = tiles[choice_below(c, COUNT_OF(tiles))];
    s->max_textures = choice_range(c, 1, 8);
    s->small_rooms = choice_once_in(c, 3);
    s->time = choice_once_in(c, 3) ? choice_u64(c) : times[choice_below(c, COUNT_OF(times))];
    s->timeout = timeouts[choice_below(c, COUNT_OF(timeouts))];
    s->next_heap = choice_once_in(c, 2) ? 0 : (uint32_t)choice_u64(c);
    s->sets = s->visibility % 3 == 0; /* derived, so that files keep their meaning */
    if (s->sets) {
        s->weights[CALL_SET_PRIMARY] *= 6;
        s->max_textures = s->max_textures < 3 ? 3 : s->max_textures;
    }
}

static uint32_t count_textures(const struct naive_manager *n, uint32_t *tile_count)
{
    uint32_t count = 0;
    *tile_count = 0;
    for (uint32_t i = 0; i < n->texture_room; i++)
        if (n->textures[i]) {
            count++;
            *tile_count += n->textures[i]->layout.tileCount;
        }
    return count;
}

static bool mistake(struct call_sequence *s)
{
    return s->mistakes && choice_once_in(&s->choice, s->mistakes);
}

static struct naive_texture *any_texture(struct call_sequence *s, struct naive_manager *n)
{
    if (!n->texture_room)
        return NULL;
    uint32_t at = choice_below(&s->choice, n->texture_room);
    for (uint32_t i = 0; i < n->texture_room; i++) {
        struct naive_texture *t = n->textures[(at + i) % n->texture_room];
        if (t)
            return t;
    }
    return NULL;
}

/* Returns an id, mostly of a living texture. */
static SluiceTextureId any_id(struct call_sequence *s, struct naive_manager *n)
{
    struct choice *c = &s->choice;
    const struct naive_texture *t = any_texture(s, n);
    if (t && !mistake(s))
        return t->id;
    switch (choice_below(c, 5)) {
    case 0: return choice_u64(c);
    case 1: return (t ? t->id : 0) + ((uint64_t)choice_range(c, 1, 3) << 32);
    case 2: return SLUICE_NO_TEXTURE;
    case 3: return (t ? t->id : 0) + choice_range(c, 1, 20);
    default: return n->removed_count ? n->removed[choice_below(c, n->removed_count)] : 1;
    }
}

/* Returns the first texture that follows none: the primary of most sets. */
static const struct naive_texture *head_of_sets(const struct naive_manager *n)
{
    for (uint32_t i = 0; i < n->texture_room; i++)
        if (n->textures[i] && n->textures[i]->primary == SLUICE_NO_TEXTURE)
            return n->textures[i];
    return NULL;
}

/* Returns NULL in a sequence without sets, and sometimes otherwise. */
static const struct naive_texture *usual_primary(struct call_sequence *s,
                                                 const struct naive_manager *n)
{
    return s->sets && choice_below(&s->choice, 5) > 0 ? head_of_sets(n) : NULL;
}

static uint32_t any_room(struct call_sequence *s)
{
    struct choice *c = &s->choice;
    switch (choice_below(c, s->small_rooms ? 5 : 12)) {
    case 0: return 0;
    case 1: return 1;
    case 2:
    case 3: return choice_range(c, 2, 8);
    case 4: return choice_range(c, 9, 40);
    default: return CALL_MAX_ROOM;
    }
}

static uint64_t any_step(struct choice *c)
{
    switch (choice_below(c, 16)) {
    case 0: return choice_below(c, 300);
    case 1:
        return choice_once_in(c, 8) ? (UINT64_MAX >> 1) - choice_below(c, 2)
                                    : (uint64_t)1 << choice_below(c, 45);
    case 2:
    case 3:
    case 4:
    case 5: return 0;
    default: return choice_range(c, 1, 8);
    }
}

static uint64_t any_time(struct call_sequence *s, const struct naive_manager *n)
{
    struct choice *c = &s->choice;
    const uint64_t now = n->has_time ? n->time : s->time;
    if (mistake(s)) /* earlier: a little, a lot, and just not yet too much to be later */
        switch (choice_below(c, 3)) {
        case 0: return now - choice_range(c, 1, 100);
        case 1: return now - ((uint64_t)1 << choice_below(c, 63));
        default: return now + ((uint64_t)1 << 63) + choice_below(c, 2);
        }
    const uint64_t step = any_step(c);
    if (step > UINT64_MAX - s->time_spent) /* a history may not span 2^64 */
        return now;
    s->time_spent += step;
    return now + step;
}

static uint64_t any_timeout(struct call_sequence *s)
{
    struct choice *c = &s->choice;
    switch (choice_below(c, 16)) {
    case 0: return 0;
    case 1: return choice_range(c, 1, 20);
    case 2: return (uint64_t)1 << choice_below(c, 64);
    default: return s->timeout;
    }
}

static uint64_t any_retire(struct call_sequence *s, const struct naive_manager *n)
{
    struct choice *c = &s->choice;
    if (choice_once_in(c, 5))
        return 0;
    if (mistake(s))
        return n->last_retire - choice_below(c, 4);
    if (choice_once_in(c, 200))
        return n->last_retire + (n->last_retire < UINT64_MAX / 2 ? UINT64_MAX / 4 : 0);
    return n->last_retire < UINT64_MAX - 4 ? n->last_retire + choice_below(c, 3) : n->last_retire;
}

static void make_config(struct call_sequence *s, struct call *call)
{
    struct choice *c = &s->choice;
    static const uint64_t delays[] = {
        0, 1, 2, 3, 5, 9, 20, (uint64_t)1 << 40, (uint64_t)1 << 61, (uint64_t)1 << 62, UINT64_MAX};
    SluiceStreamedTextureManagerConfig *config = &call->config;
    config->numExtraStandbyTiles = choice_once_in(c, 3)   ? 0
                                   : choice_once_in(c, 6) ? UINT32_MAX
                                                          : choice_range(c, 1, 40);
    config->maxHeapCount = choice_once_in(c, 2) ? 0 : choice_range(c, 1, 6);
    config->maxLoadAttempts = choice_below(c, 4);
    config->missesToExpire = choice_once_in(c, 3) ? 0 : choice_below(c, 6);
    config->prefetchLevels = choice_below(c, 4);
    config->retryDelayTicks = delays[choice_below(c, COUNT_OF(delays))];
    config->givenUpRetryDelayTicks = delays[choice_below(c, COUNT_OF(delays))];
    config->targetHeapCount = choice_once_in(c, 4) ? choice_range(c, 1, 3) : 0;
    config->noEviction = choice_once_in(c, 8);
    config->noMipBias = choice_once_in(c, 8);
    config->separatePackedTiles = choice_once_in(c, 2);
}

static void make_add(struct call_sequence *s, const struct naive_manager *n, struct call *call)
{
    uint32_t tiles;
    SluiceStreamedTextureLayout l = {.structSize = sizeof l};
    if (mistake(s))
        call_sequence_bad_desc(s, &call->desc);
    else
        call_sequence_desc(s, &call->desc);
    const struct naive_texture *head = usual_primary(s, n);
    if (head)
        call->desc = head->layout.desc;
    const bool full = count_textures(n, &tiles) >= s->max_textures;
    if (naive_layout(&call->desc, &l) != SLUICE_SUCCESS)
        return;
    if (full || l.tileCount > 1000 || (uint64_t)l.feedbackWidth * l.feedbackHeight > 1000 ||
        tiles + l.tileCount > CALL_MAX_ROOM)
        call->kind = CALL_LAYOUT;
}

static void make_layout(struct call_sequence *s, struct call *call)
{
    struct choice *c = &s->choice;
    if (choice_once_in(c, 2))
        call_sequence_bad_desc(s, &call->desc);
    else
        call_sequence_desc(s, &call->desc);
    if (choice_once_in(c, 6)) /* the largest description, or one tile more */
        call->desc = (SluiceStreamedTextureDesc){
            1u << 20, 1u << 20, 2, 1, choice_range(c, 1, 2), 1u << 10, 2, 1u << 10, 1};
    if (choice_once_in(c, 6))
        call->desc = (SluiceStreamedTextureDesc){1u << 20, 1, 21, 21, 0, 1, 1, 0, 0};
}

/* Chooses tiles to answer: tiles of one texture in one state in flight, some or all. */
static void make_answer(struct call_sequence *s, struct naive_manager *n, struct call *call)
{
    struct choice *c = &s->choice;
    const struct naive_texture *t = any_texture(s, n);
    call->texture = any_id(s, n);
    call->time = any_time(s, n);
    call->retire = any_retire(s, n);
    if (t && call->texture != t->id && !mistake(s))
        call->texture = t->id;
    const uint32_t some = choice_once_in(c, 2) ? 1 : choice_range(c, 1, 5);
    const bool only_canceled = call->kind == CALL_CANCELED && !choice_once_in(c, 4);
    for (uint32_t i = 0; t && i < t->layout.tileCount; i++) {
        SluiceTileState state = t->tiles[i].state;
        if ((state == SLUICE_TILE_STATE_CANCELED ||
             (state == SLUICE_TILE_STATE_ALLOCATED && !only_canceled)) &&
            choice_below(c, some) == 0)
            call->indices[call->count++] = i;
    }
    for (uint32_t i = call->count; i > 1; i--) { /* in any order */
        uint32_t k = choice_below(c, i), index = call->indices[k];
        call->indices[k] = call->indices[i - 1];
        call->indices[i - 1] = index;
    }
    if (!t || !mistake(s) || call->count + 1 >= CALL_MAX_INDICES)
        return;
    uint32_t at = choice_below(c, call->count + 1);
    switch (choice_below(c, 4)) {
    case 0: /* a second time */
        call->indices[call->count] =
            call->count ? call->indices[at % call->count] : t->layout.tileCount;
        break;
    case 1: call->indices[call->count] = t->layout.tileCount; break;
    case 2: call->indices[call->count] = UINT32_MAX - choice_below(c, 2); break;
    default: call->indices[call->count] = choice_below(c, t->layout.tileCount); break;
    }
    uint32_t index = call->indices[at];
    call->indices[at] = call->indices[call->count];
    call->indices[call->count++] = index;
}

/* Makes a rectangle empty, or larger than the map. */
static void spoil_rect(struct choice *c, SluiceMinMipRect *r)
{
    const uint32_t value = choice_once_in(c, 2) ? UINT32_MAX : r->width + r->height + 1000;
    switch (choice_below(c, 6)) {
    case 0: r->width = 0; break;
    case 1: r->height = 0; break;
    case 2: r->width = value; break;
    case 3: r->height = value; break;
    case 4: r->x = value; break;
    default: r->y = value; break;
    }
}

static void make_write(struct call_sequence *s, struct naive_manager *n, struct call *call)
{
    struct choice *c = &s->choice;
    const struct naive_texture *t = any_texture(s, n);
    SluiceMinMipRect r = {any_id(s, n), 0, 0, 1, 1};
    call->texture = r.textureId;
    SluiceResult ignored;
    t = naive_find(n, r.textureId, &ignored);
    if (t) {
        r.width = t->layout.minMipWidth;
        r.height = t->layout.minMipHeight;
    }
    if (call->kind == CALL_WRITE_RECT) {
        r.x = choice_below(c, r.width);
        r.y = choice_below(c, r.height);
        r.width = choice_range(c, 1, r.width - r.x);
        r.height = choice_range(c, 1, r.height - r.y);
        if (mistake(s))
            spoil_rect(c, &r);
    }
    call->rect = r;
    call->pitch = r.width + (choice_once_in(c, 2) ? 0 : choice_below(c, 5));
    call->size = (r.height - 1) * call->pitch + r.width;
    if (choice_once_in(c, 2))
        call->size += choice_below(c, 8);
    if (mistake(s))
        switch (choice_below(c, 3)) {
        case 0: call->pitch = r.width - 1; break;
        case 1: call->size = (r.height - 1) * call->pitch + r.width - 1; break;
        default: call->pitch = r.height > 1 ? SIZE_MAX : call->pitch; break;
        }
}

static void make_heap(struct call_sequence *s, const struct naive_manager *n, struct call *call)
{
    struct choice *c = &s->choice;
    call->heap = n->heap_count ? n->heaps[choice_below(c, n->heap_count)].id : 0;
    for (uint32_t i = 0; i < n->heap_count && choice_below(c, 4) > 0; i++)
        if (naive_count_slots(n, &n->heaps[i], NAIVE_SLOT_FREE) == n->capacity)
            call->heap = n->heaps[i].id;
    if (mistake(s))
        call->heap = (uint32_t)choice_u64(c);
}

static enum call_kind any_kind(struct call_sequence *s)
{
    uint32_t sum = 0;
    for (int k = 0; k < CALL_KIND_COUNT; k++)
        sum += s->weights[k];
    uint32_t at = (uint32_t)(choice_bits(&s->choice, 2) % sum);
    int k = 0;
    while (at >= s->weights[k])
        at -= s->weights[k++];
    return (enum call_kind)k;
}

static void make_feedback(struct call_sequence *s, struct naive_manager *n, struct call *call)
{
    struct choice *c = &s->choice;
    SluiceResult ignored;
    call->texture = any_id(s, n);
    if (choice_below(c, 4) < s->favoring && naive_find(n, s->favorite, &ignored))
        call->texture = s->favorite;
    const struct naive_texture *head = usual_primary(s, n);
    if (head)
        call->texture = head->id;
    call->time = any_time(s, n);
    call->timeout = any_timeout(s);
    const struct naive_texture *t = naive_find(n, call->texture, &ignored);
    if (t)
        call_sequence_map(s, &t->layout, call);
    if (!mistake(s))
        return;
    switch (choice_below(c, 4)) {
    case 0: call->map_width++; break;
    case 1: call->map_height--; break;
    case 2: call->map_width = 0; break;
    default: call->null_map = true; break;
    }
}

/* Returns the first idle texture from `at` on, or NULL. */
static const struct naive_texture *texture_to_forget(const struct naive_manager *n, uint32_t at)
{
    const struct naive_texture *any = NULL;
    for (uint32_t i = 0; i < n->texture_room; i++) {
        const struct naive_texture *t = n->textures[(at + i) % n->texture_room];
        if (t && naive_is_idle(t))
            return t;
        any = t && !any ? t : any;
    }
    return any;
}

/* Evicts the first texture that holds anything, or any texture. */
static void make_evict(const struct naive_manager *n, struct call *call)
{
    const struct naive_texture *any = NULL;
    for (uint32_t i = 0; i < n->texture_room; i++) {
        const struct naive_texture *t = n->textures[(n->stamp + i) % n->texture_room];
        any = t && (!any || (naive_holds_anything(t) && !naive_holds_anything(any))) ? t : any;
    }
    call->kind = CALL_EVICT;
    call->texture = any ? any->id : SLUICE_NO_TEXTURE;
    call->keep = call->keep == 14 ? 0 : call->keep == 20 ? 3 : UINT32_MAX;
}

static void make_trim(struct call_sequence *s, const struct naive_manager *n, struct call *call)
{
    call->keep = choice_once_in(&s->choice, 3) ? 0 : choice_below(&s->choice, 30);
    if (call->keep % 3 == 1) /* derived, so that files keep their meaning */
        call->kind = CALL_EVACUATE;
    if (call->keep % 6 == 2 && call->keep > 8)
        make_evict(n, call);
    if (call->keep % 6 != 5 || call->kind == CALL_EVICT)
        return;
    const struct naive_texture *t = texture_to_forget(n, call->keep);
    call->kind = CALL_FORGET;
    call->texture = t ? t->id : SLUICE_NO_TEXTURE;
    call->retire = call->keep == 29 ? 0 : n->last_retire + call->keep % 3;
}

static uint32_t any_tile(struct call_sequence *s, struct naive_manager *n, SluiceTextureId id)
{
    SluiceResult ignored;
    const struct naive_texture *t = naive_find(n, id, &ignored);
    uint32_t count = t ? t->layout.tileCount : 1;
    if (mistake(s))
        return choice_once_in(&s->choice, 2) ? count : UINT32_MAX;
    return choice_below(&s->choice, count);
}

static void use_usual_primary(struct call_sequence *s, struct naive_manager *n, struct call *call)
{
    const struct naive_texture *head = usual_primary(s, n);
    if (!head)
        return;
    call->primary = head->id;
    for (int i = 0; i < 4 && call->texture == head->id; i++)
        call->texture = any_id(s, n);
}

static void fill_in(struct call_sequence *s, struct naive_manager *n, struct call *call)
{
    struct choice *c = &s->choice;
    switch (call->kind) {
    case CALL_SET_CONFIG: make_config(s, call); break;
    case CALL_ADD_TEXTURE: make_add(s, n, call); break;
    case CALL_LAYOUT: make_layout(s, call); break;
    case CALL_FEEDBACK: make_feedback(s, n, call); break;
    case CALL_MATCH_PRIMARY:
    case CALL_SET_PRIMARY:
        call->texture = any_id(s, n);
        call->primary = any_id(s, n);
        for (int i = 0; i < 4 && call->primary == call->texture && !mistake(s); i++)
            call->primary = any_id(s, n);
        if (call->kind == CALL_SET_PRIMARY && choice_once_in(c, s->sets ? 20 : 6))
            call->primary = SLUICE_NO_TEXTURE;
        else if (call->kind == CALL_SET_PRIMARY)
            use_usual_primary(s, n, call);
        call->time = any_time(s, n);
        call->timeout = any_timeout(s);
        break;
    case CALL_MAPPED:
    case CALL_FAILED:
    case CALL_CANCELED: make_answer(s, n, call); break;
    case CALL_WRITE_MINMIP:
    case CALL_WRITE_RECT: make_write(s, n, call); break;
    case CALL_RELEASE_HEAP: make_heap(s, n, call); break;
    case CALL_TRIM: make_trim(s, n, call); break;
    case CALL_COMPLETE: {
        uint64_t ahead = n->last_retire > n->completed ? n->last_retire - n->completed : 0;
        call->retire = n->completed + choice_below(c, ahead < 8 ? (uint32_t)ahead + 1 : 8);
        if (ahead >= 8 && choice_once_in(c, 4))
            call->retire = n->last_retire;
        if (mistake(s))
            call->retire = choice_once_in(c, 2) ? 0 : n->completed - 1;
        break;
    }
    default: /* list calls, and calls with at most a texture and a retire value */
        call->texture = any_id(s, n);
        if (choice_once_in(c, 2) && ((call_is_list(call->kind) && call->kind != CALL_DEFRAGMENT) ||
                                     call->kind == CALL_RETRY))
            call->texture = SLUICE_ALL_TEXTURES;
        call->retire = any_retire(s, n);
        call->room = any_room(s);
        call->tile = any_tile(s, n, call->texture);
        break;
    }
}

void call_sequence_next(struct call_sequence *s, struct naive_manager *n, struct call *call)
{
    struct choice *c = &s->choice;
    memset(call, 0, offsetof(struct call, map));
    call->kind = any_kind(s);
    uint32_t tiles;
    const uint32_t textures = count_textures(n, &tiles);
    if ((textures == 0 && choice_below(c, 4) > 0) ||
        (textures < s->max_textures && choice_once_in(c, 6)))
        call->kind = CALL_ADD_TEXTURE;
    if (choice_once_in(c, s->wandering)) {
        s->camera++;
        s->favorite = any_id(s, n);
    }
    if (s->configured) {
        s->configured = false;
        call->kind = CALL_SET_CONFIG;
    }
    call->refuse_after = UINT64_MAX;
    fill_in(s, n, call);
    if (s->starving && choice_once_in(c, s->starving))
        call->refuse_after = 0;
    if (call_is_list(call->kind) && call->kind != CALL_DEFRAGMENT && choice_once_in(c, 8))
        call->null = NULL_SECOND;
    else if (mistake(s) && choice_once_in(c, 4))
        call->null = (enum call_null)choice_range(c, 1, last_pointer[call->kind]);
    if (call->kind == CALL_LAYOUT && call->null == NULL_MANAGER) /* the call has no manager */
        call->null = NULL_NONE;
    if (call->null == NULL_FIRST && call->kind >= CALL_MAPPED && call->kind <= CALL_CANCELED &&
        call->count == 0)
        call->indices[call->count++] = 0; /* NULL is allowed for no tiles */
}

struct heap_answer call_sequence_heap_answer(struct call_sequence *s, const uint32_t *living,
                                             uint32_t living_count)
{
    struct choice *c = &s->choice;
    struct heap_answer answer = {SLUICE_SUCCESS, s->next_heap};
    if (living_count >= 400 || (s->refusing && choice_once_in(c, s->refusing))) {
        answer.result = choice_once_in(c, 2) ? SLUICE_ERROR_OUT_OF_DEVICE_MEMORY
                                             : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        return answer;
    }
    if (living_count && choice_once_in(c, 24)) {
        answer.id = living[choice_below(c, living_count)];
        return answer;
    }
    for (uint32_t i = 0; i < living_count; i++) /* ids may repeat, but not those of living heaps */
        if (living[i] == answer.id) {
            answer.id++;
            i = UINT32_MAX;
        }
    s->next_heap = answer.id + (choice_once_in(c, 8) ? 0 : 1);
    return answer;
}
