#include "vulkan/memory_budget.h"

#include "base/checked.h"

#include <assert.h>

bool slc_memory_is_for_tiles(SluiceDeviceMemoryPurpose purpose)
{
    return purpose == SLUICE_DEVICE_MEMORY_PURPOSE_IMAGE ||
           purpose == SLUICE_DEVICE_MEMORY_PURPOSE_HEAP ||
           purpose == SLUICE_DEVICE_MEMORY_PURPOSE_PAGES ||
           purpose == SLUICE_DEVICE_MEMORY_PURPOSE_BYTES;
}

SluiceResult slc_memory_budget_init(struct slc_memory_budget *budget)
{
    *budget = (struct slc_memory_budget){.limit = SLC_NO_MEMORY_LIMIT,
                                         .device_limit = SLC_NO_MEMORY_LIMIT};
    return slc_mutex_init(&budget->mutex) ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_memory_budget_finish(struct slc_memory_budget *budget)
{
    assert(!budget->clients && budget->block_count == 0);
    slc_mutex_finish(&budget->mutex);
}

void slc_memory_budget_set_limit(struct slc_memory_budget *budget, uint64_t limit)
{
    slc_mutex_lock(&budget->mutex);
    budget->limit = limit;
    slc_mutex_unlock(&budget->mutex);
}

void slc_memory_budget_set_device_limit(struct slc_memory_budget *budget, uint64_t limit)
{
    slc_mutex_lock(&budget->mutex);
    budget->device_limit = limit;
    slc_mutex_unlock(&budget->mutex);
}

static uint64_t tile_memory(const struct slc_memory_budget *budget)
{
    return budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_IMAGE] +
           budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_HEAP] +
           budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_PAGES] +
           budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_BYTES];
}

uint64_t slc_memory_budget_limit(struct slc_memory_budget *budget)
{
    slc_mutex_lock(&budget->mutex);
    uint64_t limit = slc_min_u64(budget->limit, budget->device_limit);
    slc_mutex_unlock(&budget->mutex);
    return limit;
}

uint64_t slc_memory_budget_tile_memory(struct slc_memory_budget *budget)
{
    slc_mutex_lock(&budget->mutex);
    uint64_t size = tile_memory(budget);
    slc_mutex_unlock(&budget->mutex);
    return size;
}

void slc_memory_budget_get(struct slc_memory_budget *budget,
                           SluiceVulkanContextStatistics *statistics)
{
    SluiceVulkanContextStatistics *s = statistics;
    slc_mutex_lock(&budget->mutex);
    s->memoryBudget = slc_min_u64(budget->limit, budget->device_limit);
    s->tileMemorySize = tile_memory(budget);
    s->heapMemorySize = budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_HEAP];
    s->pageMemorySize = budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_PAGES];
    s->byteMemorySize = budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_BYTES];
    s->imageMemorySize = budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_IMAGE];
    s->tableMemorySize = budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_TABLE];
    s->stagingMemorySize = budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_STAGING];
    s->readbackMemorySize = budget->used[SLUICE_DEVICE_MEMORY_PURPOSE_READBACK];
    s->memoryBlockCount = budget->block_count;
    s->refusedBlockCount = budget->refused_count;
    s->deviceMemoryBudget = budget->device_limit;
    slc_mutex_unlock(&budget->mutex);
}

void slc_memory_client_init(struct slc_memory_client *client, struct slc_memory_budget *budget)
{
    slc_mutex_lock(&budget->mutex);
    *client = (struct slc_memory_client){.budget = budget, .next = budget->clients};
    if (client->next)
        client->next->previous = client;
    budget->clients = client;
    slc_mutex_unlock(&budget->mutex);
}

void slc_memory_client_finish(struct slc_memory_client *client)
{
    struct slc_memory_budget *budget = client->budget;
    if (!budget)
        return;
    assert(client->device == 0 && client->host == 0);
    slc_mutex_lock(&budget->mutex);
    if (client->previous)
        client->previous->next = client->next;
    else
        budget->clients = client->next;
    if (client->next)
        client->next->previous = client->previous;
    slc_mutex_unlock(&budget->mutex);
    *client = (struct slc_memory_client){0};
}

/* Keeps the largest refused size, not the sum: a refused client asks again, for less. */
static void note_refusal(struct slc_memory_client *client, uint64_t size)
{
    if (client->refused < size)
        client->refused = size;
}

bool slc_memory_client_take(struct slc_memory_client *client, SluiceDeviceMemoryPurpose purpose,
                            bool mapped, uint64_t size)
{
    struct slc_memory_budget *budget = client->budget;
    bool tiles = slc_memory_is_for_tiles(purpose);
    slc_mutex_lock(&budget->mutex);
    uint64_t used = tile_memory(budget), limit = slc_min_u64(budget->limit, budget->device_limit);
    bool fits = !tiles || (used <= limit && size <= limit - used);
    if (fits) {
        budget->used[purpose] += size;
        budget->block_count++;
        *(mapped ? &client->host : &client->device) += size;
        client->tiles += tiles ? size : 0;
    } else {
        budget->refused_count++;
        note_refusal(client, size);
    }
    slc_mutex_unlock(&budget->mutex);
    return fits;
}

static void give(struct slc_memory_client *client, SluiceDeviceMemoryPurpose purpose, bool mapped,
                 uint64_t size)
{
    struct slc_memory_budget *budget = client->budget;
    uint64_t *counter = mapped ? &client->host : &client->device;
    assert(budget->used[purpose] >= size && *counter >= size && budget->block_count > 0);
    budget->used[purpose] -= size;
    budget->block_count--;
    *counter -= size;
    client->tiles -= slc_memory_is_for_tiles(purpose) ? size : 0;
}

void slc_memory_client_give(struct slc_memory_client *client, SluiceDeviceMemoryPurpose purpose,
                            bool mapped, uint64_t size)
{
    slc_mutex_lock(&client->budget->mutex);
    give(client, purpose, mapped, size);
    slc_mutex_unlock(&client->budget->mutex);
}

void slc_memory_client_refuse(struct slc_memory_client *client, SluiceDeviceMemoryPurpose purpose,
                              bool mapped, uint64_t size)
{
    slc_mutex_lock(&client->budget->mutex);
    give(client, purpose, mapped, size);
    if (slc_memory_is_for_tiles(purpose))
        note_refusal(client, size);
    slc_mutex_unlock(&client->budget->mutex);
}

void slc_memory_client_move(struct slc_memory_client *from, struct slc_memory_client *to,
                            SluiceDeviceMemoryPurpose purpose, bool mapped, uint64_t size)
{
    slc_mutex_lock(&from->budget->mutex);
    uint64_t tiles = slc_memory_is_for_tiles(purpose) ? size : 0;
    *(mapped ? &from->host : &from->device) -= size;
    *(mapped ? &to->host : &to->device) += size;
    from->tiles -= tiles;
    to->tiles += tiles;
    slc_mutex_unlock(&from->budget->mutex);
}

void slc_memory_client_set_source(struct slc_memory_client *client,
                                  struct slc_memory_client *source)
{
    if (!client || !client->budget)
        return;
    slc_mutex_lock(&client->budget->mutex);
    client->source = source;
    slc_mutex_unlock(&client->budget->mutex);
}

void slc_memory_client_blame(struct slc_memory_client *source, struct slc_memory_client *client)
{
    if (!source->budget)
        return;
    slc_mutex_lock(&source->budget->mutex);
    if (client)
        note_refusal(client, source->refused);
    source->refused = 0;
    slc_mutex_unlock(&source->budget->mutex);
}

/* Returns amount * own / all, rounded up, so that the shares of all clients reach `amount`. */
static uint64_t share_of(uint64_t amount, uint64_t own, uint64_t all)
{
    const uint64_t unit = 1 << 16; /* products of bytes could be beyond 64 bits */
    if (own >= all || amount == 0)
        return amount;
    uint64_t share = (amount / unit + 1) * (own / unit + 1) / (all / unit + 1) * unit + unit;
    return slc_min_u64(slc_min_u64(share, amount), own);
}

/* A refusal stays visible until the client has begun twice. In between, every other client has
 * begun. */
struct slc_memory_pressure slc_memory_client_begin(struct slc_memory_client *client)
{
    struct slc_memory_budget *budget = client->budget;
    slc_mutex_lock(&budget->mutex);
    uint64_t used = tile_memory(budget), limit = slc_min_u64(budget->limit, budget->device_limit);
    uint64_t own = client->tiles + (client->source ? client->source->tiles : 0);
    struct slc_memory_pressure pressure = {.beyond = used > limit ? used - limit : 0};
    for (const struct slc_memory_client *other = budget->clients; other; other = other->next)
        if (other != client)
            pressure.refused +=
                other->refused > other->refused_before ? other->refused : other->refused_before;
    client->refused_before = client->refused;
    client->refused = 0;
    pressure.refused = slc_min_u64(pressure.refused, own);
    pressure.beyond = share_of(pressure.beyond, own, used);
    slc_mutex_unlock(&budget->mutex);
    return pressure;
}

uint64_t slc_memory_client_tiles(struct slc_memory_client *client)
{
    if (!client->budget)
        return 0;
    slc_mutex_lock(&client->budget->mutex);
    uint64_t tiles = client->tiles;
    slc_mutex_unlock(&client->budget->mutex);
    return tiles;
}

void slc_memory_client_get(struct slc_memory_client *client, uint64_t *device, uint64_t *host)
{
    if (!client->budget) {
        if (device)
            *device = 0;
        if (host)
            *host = 0;
        return;
    }
    slc_mutex_lock(&client->budget->mutex);
    if (device)
        *device = client->device;
    if (host)
        *host = client->host;
    slc_mutex_unlock(&client->budget->mutex);
}
