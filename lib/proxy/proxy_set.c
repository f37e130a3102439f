/* Adding and removing proxies. */
#include "proxy/proxy_set.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/limits.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "proxy/proxy_box.h"

#define DEFAULT_COUNT (1u << 20)

static SluiceResult check(const SluiceProxySetCreateInfo *info)
{
    const struct slc_limit limits[] = {
        {"kind", (uint64_t)info->kind, SLUICE_PROXY_KIND_GEOMETRY, SLUICE_PROXY_KIND_MATERIAL},
        {"maxProxyCount", info->maxProxyCount, 1, INT32_MAX}};
    if (!slc_allocator_is_valid(info->pAllocator))
        return slc_log_refusal(&info->log, "pAllocator lacks a function");
    return slc_check_limits(&info->log, limits, sizeof limits / sizeof limits[0]);
}

SluiceResult sluiceCreateProxySet(const SluiceProxySetCreateInfo *pCreateInfo,
                                  SluiceProxySet **pSet)
{
    if (!pCreateInfo || !pSet)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceProxySetCreateInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceProxySetCreateInfo), &info, pCreateInfo, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    if (info.maxProxyCount == 0)
        info.maxProxyCount = DEFAULT_COUNT;
    result = check(&info);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceProxySet *set = slc_calloc(&cb, 1, sizeof *set);
    if (!set)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    set->cb = cb;
    set->log = info.log;
    set->kind = info.kind;
    set->max_count = info.maxProxyCount;
    set->first_removed = set->last_removed = set->first_fresh = SLC_NO_INDEX;
    *pSet = set;
    return SLUICE_SUCCESS;
}

void sluiceDestroyProxySet(SluiceProxySet *set)
{
    if (!set)
        return;
    SluiceAllocationCallbacks cb = set->cb;
    for (uint32_t i = 0; i < set->chunk_count; i++)
        slc_free(&cb, set->chunks[i], SLC_PROXY_CHUNK, sizeof **set->chunks);
    slc_free(&cb, set->chunks, set->chunk_capacity, sizeof(struct slc_proxy *));
    slc_bits_finish(&set->live, &cb);
    slc_bits_finish(&set->requested, &cb);
    slc_bits_finish(&set->free, &cb);
    slc_free(&cb, set->changed, set->group_capacity, sizeof *set->changed);
    slc_free(&cb, set, 1, sizeof *set);
}

SluiceResult slc_proxy_require_boxes(const SluiceProxySet *set, const char *function)
{
    if (set->kind == SLUICE_PROXY_KIND_GEOMETRY)
        return SLUICE_SUCCESS;
    return slc_log_refusal(&set->log, "%s: proxies of materials have no boxes", function);
}

/* Adds a chunk of slots, and grows all arrays per slot or group. */
static bool add_chunk(SluiceProxySet *set)
{
    uint32_t capacity = (set->chunk_count + 1) * SLC_PROXY_CHUNK; /* at most 2^31 */
    uint32_t groups = capacity / SLC_PROXY_GROUP;
    if (set->chunk_count == set->chunk_capacity) {
        uint32_t old = set->chunk_capacity, new = old ? 2 * old : 4;
        struct slc_proxy **chunks =
            slc_regrow(&set->cb, set->chunks, old, new, sizeof(struct slc_proxy *));
        if (!chunks)
            return false;
        set->chunks = chunks;
        set->chunk_capacity = new;
    }
    if (set->kind == SLUICE_PROXY_KIND_GEOMETRY && groups > set->group_capacity) {
        uint32_t new = slc_max_u32(groups, 2 * set->group_capacity);
        uint64_t *changed =
            slc_regrow(&set->cb, set->changed, set->group_capacity, new, sizeof *changed);
        if (!changed)
            return false;
        set->changed = changed;
        set->group_capacity = new;
    }
    if (!slc_bits_reserve(&set->live, &set->cb, capacity) ||
        !slc_bits_reserve(&set->requested, &set->cb, capacity) ||
        !slc_bits_reserve(&set->free, &set->cb, capacity))
        return false;
    struct slc_proxy *chunk = slc_calloc(&set->cb, SLC_PROXY_CHUNK, sizeof *chunk);
    if (!chunk)
        return false;
    set->chunks[set->chunk_count++] = chunk;
    return true;
}

/* Marks boxes up to a new last box as changed, because they become primitives. At their last
 * change, they may not have fitted in the caller's memory. The indices between were removed and are
 * not free, so each is visited at most once per removal. */
static void note_growth(SluiceProxySet *set, uint32_t index)
{
    uint32_t last = slc_bits_last(&set->live), first = last == SLC_BIT_NONE ? 0 : last + 1;
    if (set->kind != SLUICE_PROXY_KIND_GEOMETRY)
        return;
    for (uint32_t group = first / SLC_PROXY_GROUP; group < index / SLC_PROXY_GROUP; group++)
        set->changed[group] = set->version + 1; /* version of the new box */
}

static SluiceResult take_index(SluiceProxySet *set, uint32_t *index)
{
    *index = slc_bits_next(&set->free, 0);
    if (*index == SLC_BIT_NONE) {
        if (set->index_count == set->max_count)
            return SLUICE_ERROR_LIMIT_EXCEEDED;
        if (set->index_count == set->chunk_count * SLC_PROXY_CHUNK && !add_chunk(set))
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        *index = set->index_count++;
    }
    note_growth(set, *index);
    slc_bits_remove(&set->free, *index);
    slc_bits_add(&set->live, *index);
    slc_proxy_at(set, *index)->generation++;
    return SLUICE_SUCCESS;
}

static void note_change(SluiceProxySet *set, uint32_t index)
{
    if (set->kind == SLUICE_PROXY_KIND_GEOMETRY)
        set->changed[index / SLC_PROXY_GROUP] = ++set->version;
}

SluiceResult sluiceAddGeometryProxy(SluiceProxySet *set, const SluiceProxyBox *pBox,
                                    SluiceProxyId *pProxyId)
{
    uint32_t index;
    SluiceProxyBox box;
    if (!set || !pBox || !pProxyId)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_proxy_require_boxes(set, __func__);
    if (result == SLUICE_SUCCESS)
        result = slc_proxy_box_widen(pBox, &box, &set->log);
    if (result == SLUICE_SUCCESS)
        result = take_index(set, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_proxy_at(set, index)->is.box = box;
    note_change(set, index);
    *pProxyId = slc_proxy_id(set, index);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceAddMaterialProxy(SluiceProxySet *set, SluiceProxyId *pProxyId)
{
    uint32_t index;
    if (!set || !pProxyId)
        return SLUICE_ERROR_NULL_POINTER;
    if (set->kind != SLUICE_PROXY_KIND_MATERIAL)
        return slc_log_refusal(&set->log, "%s: proxies of geometry have boxes", __func__);
    SluiceResult result = take_index(set, &index);
    if (result == SLUICE_SUCCESS)
        *pProxyId = slc_proxy_id(set, index);
    return result;
}

SluiceResult slc_proxy_find(const SluiceProxySet *set, SluiceProxyId id, uint32_t *index)
{
    uint32_t generation = (uint32_t)(id >> 32);
    *index = (uint32_t)id;
    if (*index >= set->index_count || generation == 0 ||
        generation > slc_proxy_at(set, *index)->generation)
        return SLUICE_ERROR_UNKNOWN_TEXTURE;
    bool live =
        generation == slc_proxy_at(set, *index)->generation && slc_bits_has(&set->live, *index);
    return live ? SLUICE_SUCCESS : SLUICE_ERROR_STALE_TEXTURE;
}

SluiceResult sluiceRemoveProxy(SluiceProxySet *set, SluiceProxyId proxyId)
{
    uint32_t index;
    if (!set)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_proxy_find(set, proxyId, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_bits_remove(&set->live, index);
    slc_bits_remove(&set->requested, index);
    note_change(set, index);
    slc_proxy_at(set, index)->is.removed.next = SLC_NO_INDEX;
    if (set->removed_count++)
        slc_proxy_at(set, set->last_removed)->is.removed.next = index;
    else
        set->first_removed = index;
    set->last_removed = index;
    if (set->first_fresh == SLC_NO_INDEX)
        set->first_fresh = index;
    return SLUICE_SUCCESS;
}

void slc_proxy_release(SluiceProxySet *set, uint64_t begun, uint64_t processed)
{
    while (set->first_fresh != SLC_NO_INDEX) {
        struct slc_proxy *proxy = slc_proxy_at(set, set->first_fresh);
        proxy->is.removed.launch[0] = (uint32_t)begun;
        proxy->is.removed.launch[1] = (uint32_t)(begun >> 32);
        set->first_fresh = proxy->is.removed.next;
    }
    while (set->removed_count) {
        uint32_t index = set->first_removed;
        const struct slc_proxy *proxy = slc_proxy_at(set, index);
        uint64_t launch = (uint64_t)proxy->is.removed.launch[1] << 32 | proxy->is.removed.launch[0];
        if (launch > processed)
            return;
        set->first_removed = proxy->is.removed.next;
        set->removed_count--;
        if (proxy->generation < UINT32_MAX) /* otherwise the slot has no more ids */
            slc_bits_add(&set->free, index);
    }
}

SluiceResult sluiceGetProxySetInfo(const SluiceProxySet *set, SluiceProxySetInfo *pInfo)
{
    if (!set || !pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceProxySetInfo), pInfo, &set->log);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t last = slc_bits_last(&set->live);
    const SluiceProxySetInfo info = {
        .structSize = sizeof info,
        .kind = set->kind,
        .maxProxyCount = set->max_count,
        .proxyCount = set->live.count,
        .requestedCount = set->requested.count,
        .removedCount = set->removed_count,
        .indexCount = last == SLC_BIT_NONE ? 0 : last + 1,
        .hostMemorySize = sizeof *set + slc_bits_size(&set->live) + slc_bits_size(&set->requested) +
                          slc_bits_size(&set->free) +
                          (uint64_t)set->group_capacity * sizeof *set->changed +
                          (uint64_t)set->chunk_capacity * sizeof(struct slc_proxy *) +
                          (uint64_t)set->chunk_count * SLC_PROXY_CHUNK * sizeof(struct slc_proxy)};
    slc_struct_write(SLC_STRUCT(SluiceProxySetInfo), pInfo, &info);
    return SLUICE_SUCCESS;
}
