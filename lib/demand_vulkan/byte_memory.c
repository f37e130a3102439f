#include "demand_vulkan/byte_memory.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

#define SLOT_SHIFT 17u /* a place is slab << SLOT_SHIFT | slot */
#define SLOT_MASK ((1u << SLOT_SHIFT) - 1)
#define CHUNK_SHIFT 9u /* a slab's number is chunk << CHUNK_SHIFT | index in the chunk */
#define MAX_SLABS (1u << CHUNK_SHIFT)
#define IDLE_TICKS 60u    /* ticks for which an empty chunk is kept */
#define REFUSED_TICKS 60u /* ticks until the device is asked for memory again */

static struct slc_byte_slab *slab_at(struct slc_byte_memory *m, uint32_t index)
{
    struct slc_byte_chunk *chunk = &m->chunks[index >> CHUNK_SHIFT];
    uint32_t slab = index & (MAX_SLABS - 1);
    return chunk->state == SLC_BYTE_CHUNK_LIVE && slab < chunk->slab_count ? &chunk->slabs[slab]
                                                                           : NULL;
}

void slc_byte_memory_init(struct slc_byte_memory *memory, const struct slc_vk *vk,
                          const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                          uint64_t budget, bool addresses)
{
    *memory = (struct slc_byte_memory){
        .vk = vk, .caps = caps, .cb = *cb, .budget = budget, .generation = 1};
    if (addresses)
        memory->get_address = (PFN_vkGetBufferDeviceAddress)vk->GetDeviceProcAddr(
            vk->device, "vkGetBufferDeviceAddress");
}

static void free_slots(struct slc_byte_memory *m, struct slc_byte_slab *slab)
{
    slc_free(&m->cb, slab->slots, slab->slot_count + 1, sizeof *slab->slots);
    *slab = (struct slc_byte_slab){0};
}

static void destroy_chunk(struct slc_byte_memory *m, struct slc_byte_chunk *chunk)
{
    for (uint32_t i = 0; chunk->slabs && i < chunk->slab_count; i++)
        if (chunk->slabs[i].slots)
            free_slots(m, &chunk->slabs[i]);
    slc_free(&m->cb, chunk->slabs, chunk->slab_count, sizeof *chunk->slabs);
    if (chunk->buffer)
        m->vk->DestroyBuffer(m->vk->device, chunk->buffer, NULL);
    slc_memory_free(m->vk, &chunk->memory);
    *chunk = (struct slc_byte_chunk){0};
}

void slc_byte_memory_finish(struct slc_byte_memory *memory)
{
    if (!memory->vk)
        return;
    for (uint32_t i = 0; i < SLUICE_DEMAND_BYTE_CHUNKS; i++)
        destroy_chunk(memory, &memory->chunks[i]);
    *memory = (struct slc_byte_memory){0};
}

static VkResult allocate_buffer(struct slc_byte_memory *m, struct slc_byte_chunk *chunk)
{
    const struct slc_vk *vk = m->vk;
    VkMemoryRequirements needs;
    vk->GetBufferMemoryRequirements(vk->device, chunk->buffer, &needs);
    const struct slc_memory_request request = {
        .size = needs.size,
        .alignment = needs.alignment,
        .type = slc_find_memory_type(&m->caps->memory, needs.memoryTypeBits, 0,
                                     VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT),
        .purpose = SLUICE_DEVICE_MEMORY_PURPOSE_BYTES,
        .device_address = m->get_address != NULL,
        .name = "byte pages"};
    if (needs.size > m->budget - m->size || request.type == UINT32_MAX)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    VkResult result = slc_memory_allocate(vk, &request, &chunk->memory);
    if (result != VK_SUCCESS)
        return result;
    return vk->BindBufferMemory(vk->device, chunk->buffer, chunk->memory.memory,
                                chunk->memory.offset);
}

/* Failure is not logged: a smaller chunk is tried, or pages are evicted. */
static bool create_chunk(struct slc_byte_memory *m, struct slc_byte_chunk *chunk, uint32_t slabs)
{
    const struct slc_vk *vk = m->vk;
    VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = (uint64_t)slabs * SLC_BYTE_SLAB_SIZE,
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 (m->get_address ? VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT : 0),
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE};
    SLC_VK_SHARE(vk, &info);
    *chunk = (struct slc_byte_chunk){.slab_count = slabs};
    chunk->slabs = slc_calloc(&m->cb, slabs, sizeof *chunk->slabs);
    VkResult result = VK_ERROR_OUT_OF_HOST_MEMORY;
    if (chunk->slabs)
        result = vk->CreateBuffer(vk->device, &info, NULL, &chunk->buffer);
    if (result != VK_SUCCESS)
        chunk->buffer = VK_NULL_HANDLE;
    else
        result = allocate_buffer(m, chunk);
    if (result != VK_SUCCESS) {
        destroy_chunk(m, chunk);
        return false;
    }
    slc_vk_name(vk, VK_OBJECT_TYPE_BUFFER, (uint64_t)chunk->buffer, "byte pages");
    const VkBufferDeviceAddressInfo address = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, .buffer = chunk->buffer};
    if (m->get_address)
        chunk->address = m->get_address(vk->device, &address);
    return true;
}

static uint32_t find_free_chunk(const struct slc_byte_memory *m)
{
    uint32_t at = 0;
    while (at < SLUICE_DEMAND_BYTE_CHUNKS && m->chunks[at].state != SLC_BYTE_CHUNK_FREE)
        at++;
    return at;
}

static uint32_t slabs_left(const struct slc_byte_memory *m)
{
    uint64_t left = (m->budget - m->size) / SLC_BYTE_SLAB_SIZE;
    uint64_t range = m->caps->max_storage_buffer_range / SLC_BYTE_SLAB_SIZE;
    return (uint32_t)slc_min_u64(MAX_SLABS, slc_min_u64(left, range));
}

/* Makes a chunk. Returns false without one: too many chunks, no budget, or refused a while ago. */
static bool grow(struct slc_byte_memory *m)
{
    uint32_t at = find_free_chunk(m), slabs = (uint32_t)(m->size / SLC_BYTE_SLAB_SIZE);
    if (at == SLUICE_DEMAND_BYTE_CHUNKS ||
        (m->refused_tick && m->tick + 1 - m->refused_tick < REFUSED_TICKS))
        return false;
    struct slc_byte_chunk *chunk = &m->chunks[at];
    for (slabs = slc_min_u32(slc_max_u32(slabs, 1), slabs_left(m)); slabs > 0; slabs /= 2)
        if (create_chunk(m, chunk, slabs))
            break;
    if (slabs == 0) {
        m->refused_tick = slabs_left(m) ? m->tick + 1 : 0;
        return false;
    }
    chunk->state = SLC_BYTE_CHUNK_LIVE;
    chunk->tick = m->tick;
    m->size += chunk->memory.size;
    m->chunk_count++;
    m->generation++;
    m->refused_tick = 0;
    return true;
}

static bool has_slot(const struct slc_byte_slab *slab, uint32_t stride)
{
    return slab->slots && slab->stride == stride && slab->free_count;
}

static bool cut(struct slc_byte_memory *m, struct slc_byte_slab *slab, uint32_t stride)
{
    uint32_t count = SLC_BYTE_SLAB_SIZE / stride;
    struct slc_byte_slot *slots = slc_alloc(&m->cb, count + 1, sizeof *slots);
    if (!slots)
        return false;
    for (uint32_t i = 0; i <= count; i++)
        slots[i] =
            (struct slc_byte_slot){i ? i - 1 : count, i < count ? i + 1 : 0, SLC_NO_PAGE, false};
    if (slab->slots)
        free_slots(m, slab);
    *slab = (struct slc_byte_slab){stride, count, count, slots};
    return true;
}

/* Sets `last` to the first slab with a free slot of the stride. Otherwise cuts an unused slab, or a
 * slab without pages. Returns false if there is none. */
static bool find_slab(struct slc_byte_memory *m, uint32_t stride)
{
    uint32_t unused = SLC_NO_PLACE, empty = SLC_NO_PLACE;
    for (uint32_t c = 0; c < SLUICE_DEMAND_BYTE_CHUNKS; c++) {
        const struct slc_byte_chunk *chunk = &m->chunks[c];
        for (uint32_t i = 0; chunk->state == SLC_BYTE_CHUNK_LIVE && i < chunk->slab_count; i++) {
            uint32_t index = c << CHUNK_SHIFT | i;
            const struct slc_byte_slab *slab = &chunk->slabs[i];
            if (has_slot(slab, stride)) {
                m->last = index;
                return true;
            }
            if (!slab->slots && unused == SLC_NO_PLACE)
                unused = index;
            if (slab->slots && slab->free_count == slab->slot_count && empty == SLC_NO_PLACE)
                empty = index;
        }
    }
    m->last = unused != SLC_NO_PLACE ? unused : empty;
    return m->last != SLC_NO_PLACE && cut(m, slab_at(m, m->last), stride);
}

bool slc_byte_memory_kind(struct slc_byte_memory *memory, uint32_t stride, uint32_t *kind)
{
    for (*kind = 0; *kind < memory->kind_count; (*kind)++)
        if (memory->strides[*kind] == stride)
            return true;
    if (memory->kind_count == SLC_BYTE_KINDS)
        return false;
    memory->strides[memory->kind_count++] = stride;
    return true;
}

static void hold(struct slc_byte_memory *m, uint32_t place)
{
    struct slc_byte_slab *slab = slab_at(m, place >> SLOT_SHIFT);
    struct slc_byte_slot *slots = slab->slots, *slot = &slots[place & SLOT_MASK];
    slots[slot->previous].next = slot->next;
    slots[slot->next].previous = slot->previous;
    *slot = (struct slc_byte_slot){.owner = SLC_NO_PAGE, .held = true};
    slab->free_count--;
    m->chunks[place >> (SLOT_SHIFT + CHUNK_SHIFT)].held_count++;
    m->held_size += slab->stride;
}

static uint32_t take(void *user, uint32_t kind)
{
    struct slc_byte_memory *m = user;
    uint32_t stride = m->strides[kind];
    const struct slc_byte_slab *slab = slab_at(m, m->last);
    if (!(slab && has_slot(slab, stride)) && !find_slab(m, stride) &&
        !(grow(m) && find_slab(m, stride))) {
        m->last = 0;
        m->short_of = true;
        return SLC_NO_PLACE;
    }
    slab = slab_at(m, m->last);
    uint32_t place = m->last << SLOT_SHIFT | slab->slots[slab->slot_count].next;
    hold(m, place);
    return place;
}

static void give(void *user, uint32_t place, uint32_t page)
{
    struct slc_byte_memory *m = user;
    struct slc_byte_slab *slab = slab_at(m, place >> SLOT_SHIFT);
    struct slc_byte_chunk *chunk = &m->chunks[place >> (SLOT_SHIFT + CHUNK_SHIFT)];
    uint32_t slot = place & SLOT_MASK, head = slab->slot_count;
    struct slc_byte_slot *slots = slab->slots;
    assert(slots[slot].held && chunk->held_count > 0);
    slots[slot] = (struct slc_byte_slot){slots[head].previous, head, page, false};
    slots[slots[head].previous].next = slot;
    slots[head].previous = slot;
    slab->free_count++;
    chunk->held_count--;
    chunk->tick = m->tick;
    m->held_size -= slab->stride;
    m->evicted_count += page != SLC_NO_PAGE;
}

static bool retake(void *user, uint32_t place, uint32_t page)
{
    struct slc_byte_memory *m = user;
    const struct slc_byte_slab *slab = slab_at(m, place >> SLOT_SHIFT);
    uint32_t slot = place & SLOT_MASK;
    /* the index may belong to another chunk or stride by now */
    if (!slab || !slab->slots || slot >= slab->slot_count || slab->slots[slot].held ||
        slab->slots[slot].owner != page)
        return false;
    hold(m, place);
    return true;
}

struct slc_page_memory slc_byte_memory_interface(struct slc_byte_memory *memory)
{
    return (struct slc_page_memory){memory, take, give, retake};
}

void slc_byte_place(uint32_t place, uint32_t stride, uint32_t *chunk, uint64_t *offset)
{
    uint32_t slab = place >> SLOT_SHIFT;
    *chunk = slab >> CHUNK_SHIFT;
    *offset = (uint64_t)(slab & (MAX_SLABS - 1)) * SLC_BYTE_SLAB_SIZE +
              (uint64_t)(place & SLOT_MASK) * stride;
}

uint64_t slc_byte_value(const struct slc_byte_memory *memory, uint32_t place, uint32_t stride,
                        bool address)
{
    uint32_t chunk;
    uint64_t offset;
    slc_byte_place(place, stride, &chunk, &offset);
    return address ? memory->chunks[chunk].address + offset : (uint64_t)chunk << 32 | offset;
}

/* Even in a hurry a chunk stays for two ticks: a new chunk is empty at first. */
static void retire(struct slc_byte_memory *m, struct slc_byte_chunk *chunk, uint64_t last_launch,
                   bool hurry)
{
    if (chunk->held_count)
        chunk->tick = m->tick;
    if (m->tick - chunk->tick < (hurry ? 2 : IDLE_TICKS))
        return;
    chunk->state = SLC_BYTE_CHUNK_RETIRING;
    chunk->launch = last_launch;
    m->generation++;
}

void slc_byte_memory_begin(struct slc_byte_memory *memory, uint64_t launch, uint64_t processed,
                           bool pressure)
{
    struct slc_byte_memory *m = memory;
    m->tick++;
    for (uint32_t i = 0; i < SLUICE_DEMAND_BYTE_CHUNKS; i++) {
        struct slc_byte_chunk *chunk = &m->chunks[i];
        if (chunk->state == SLC_BYTE_CHUNK_LIVE)
            retire(m, chunk, launch - 1, pressure || m->short_of);
        if (chunk->state != SLC_BYTE_CHUNK_RETIRING || chunk->launch > processed)
            continue;
        m->size -= chunk->memory.size;
        m->chunk_count--;
        m->refused_tick = 0;
        destroy_chunk(m, chunk);
    }
    m->short_of = false;
}

bool slc_byte_memory_is_filling(const struct slc_byte_memory *memory)
{
    return memory->short_of || memory->held_size > memory->budget / 2;
}
