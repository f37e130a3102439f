#include "vulkan/page_table.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#define STORE_BATCH 256u /* words */

/* Store of a word of the table in this frame. */
struct slc_page_store {
    uint32_t word, value;
    uint32_t turn; ///< order of the stores: the last store to a word counts
};

SluiceResult slc_page_table_init(struct slc_page_table *table, const struct slc_vk *vk,
                                 const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                                 uint32_t word_count, uint32_t part_count, uint32_t change_count)
{
    *table = (struct slc_page_table){.vk = vk, .cb = cb};
    SluiceResult result = slc_region_arena_init(&table->arena, cb, word_count, part_count);
    if (result != SLUICE_SUCCESS)
        return result;
    table->part_count = part_count;
    table->store_capacity = change_count;
    table->parts = slc_calloc(cb, part_count, sizeof *table->parts);
    table->new_parts = slc_alloc(cb, part_count, sizeof *table->new_parts);
    table->entries = slc_alloc(cb, table->arena.size, sizeof *table->entries);
    table->stores = slc_alloc(cb, change_count, sizeof *table->stores);
    if (!table->parts || !table->new_parts || !table->entries || !table->stores)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    return slc_buffer_init(&table->buffer, vk, caps, (uint64_t)table->arena.size * 4,
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           SLC_BUFFER_DEVICE);
}

void slc_page_table_finish(struct slc_page_table *table)
{
    const SluiceAllocationCallbacks *cb = table->cb;
    if (!cb)
        return;
    slc_buffer_finish(&table->buffer, table->vk);
    slc_free(cb, table->stores, table->store_capacity, sizeof *table->stores);
    slc_free(cb, table->entries, table->arena.size, sizeof *table->entries);
    slc_free(cb, table->new_parts, table->part_count, sizeof *table->new_parts);
    slc_free(cb, table->parts, table->part_count, sizeof *table->parts);
    slc_region_arena_finish(&table->arena, cb);
    *table = (struct slc_page_table){0};
}

static uint32_t level_width(const SluiceStreamedTextureDesc *desc, uint32_t level)
{
    return slc_div_up_u32(slc_mip_size(desc->width, level), desc->tileWidth);
}

/* Returns the first word of a level's tiles, counted from the start of the texture's part. */
static uint32_t level_word(const SluiceStreamedTextureDesc *desc, uint32_t level)
{
    uint32_t word = desc->regularMipCount;
    for (uint32_t i = 0; i < level; i++)
        word +=
            level_width(desc, i) * slc_div_up_u32(slc_mip_size(desc->height, i), desc->tileHeight);
    return word;
}

uint32_t slc_page_table_word(const struct slc_page_table *table, uint32_t part, uint32_t level,
                             uint32_t x, uint32_t y)
{
    const struct slc_page_table_part *p = &table->parts[part];
    return p->first_word + level_word(&p->desc, level) + y * level_width(&p->desc, level) + x;
}

SluiceResult slc_page_table_add(struct slc_page_table *table, uint32_t part,
                                const SluiceStreamedTextureDesc *desc)
{
    struct slc_page_table_part *p = &table->parts[part];
    *p = (struct slc_page_table_part){.desc = *desc};
    if (desc->regularMipCount == 0)
        return SLUICE_SUCCESS;
    uint32_t count = level_word(desc, desc->regularMipCount);
    if (!slc_region_arena_take(&table->arena, count, &p->first_word))
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    p->word_count = count;
    memset(table->entries + p->first_word, 0xFF, (size_t)count * sizeof *table->entries);
    table->new_parts[table->new_part_count++] = part;
    return SLUICE_SUCCESS;
}

void slc_page_table_remove(struct slc_page_table *table, uint32_t part)
{
    struct slc_page_table_part *p = &table->parts[part];
    uint32_t kept = 0;
    for (uint32_t i = 0; i < table->new_part_count; i++)
        if (table->new_parts[i] != part)
            table->new_parts[kept++] = table->new_parts[i];
    table->new_part_count = kept;
    if (p->word_count)
        slc_region_arena_give(&table->arena, p->first_word, p->word_count);
    *p = (struct slc_page_table_part){0};
}

static bool is_shown(const struct slc_page_table *table, uint32_t word)
{
    return slc_page_is_taken(table->entries[word]) && table->entries[word] & SLC_PAGE_SHOWN;
}

void slc_page_table_store(struct slc_page_table *table, uint32_t part, uint32_t word,
                          uint64_t frame)
{
    uint32_t turn = table->store_count++;
    assert(turn < table->store_capacity);
    uint32_t value =
        is_shown(table, word) ? slc_page_of_entry(table->entries[word]) : SLUICE_PAGE_NONE;
    table->stores[turn] = (struct slc_page_store){word, value, turn};
    table->parts[part].stored_frame = frame;
}

bool slc_page_table_make_room(struct slc_page_table *table, uint32_t count)
{
    uint32_t capacity = table->store_count + count;
    if (capacity <= table->store_capacity)
        return true;
    struct slc_page_store *stores = slc_regrow(table->cb, table->stores, table->store_capacity,
                                               capacity, sizeof *table->stores);
    if (!stores)
        return false;
    table->stores = stores;
    table->store_capacity = capacity;
    return true;
}

static void update_words(struct slc_page_table *table, uint32_t first, uint32_t count,
                         const uint32_t *words, VkCommandBuffer commands)
{
    if (count)
        table->vk->CmdUpdateBuffer(commands, table->buffer.buffer, (VkDeviceSize)first * 4,
                                   (VkDeviceSize)count * 4, words);
}

static void fill_none(struct slc_page_table *table, uint32_t first, uint32_t count,
                      VkCommandBuffer commands)
{
    if (count)
        table->vk->CmdFillBuffer(commands, table->buffer.buffer, (VkDeviceSize)first * 4,
                                 (VkDeviceSize)count * 4, SLUICE_PAGE_NONE);
}

static void record_header(struct slc_page_table *table, const struct slc_page_table_part *part,
                          VkCommandBuffer commands)
{
    uint32_t levels = part->desc.regularMipCount, header[SLUICE_MAX_MIP_LEVELS];
    for (uint32_t level = 0; level < levels; level++)
        header[level] = part->first_word + level_word(&part->desc, level);
    update_words(table, part->first_word, levels, header, commands);
}

static void record_no_pages(struct slc_page_table *table, const struct slc_page_table_part *part,
                            VkCommandBuffer commands)
{
    uint32_t levels = part->desc.regularMipCount;
    fill_none(table, part->first_word + levels, part->word_count - levels, commands);
}

/* Records all tile words of the part, with or without the stores of this frame. */
static void record_words(struct slc_page_table *table, const struct slc_page_table_part *part,
                         VkCommandBuffer commands)
{
    uint32_t run[STORE_BATCH], end = part->first_word + part->word_count;
    for (uint32_t word = part->first_word + part->desc.regularMipCount; word < end;) {
        uint32_t first = word, count = 0;
        while (word < end && !is_shown(table, word))
            word++;
        fill_none(table, first, word - first, commands);
        for (first = word; word < end && count < STORE_BATCH && is_shown(table, word); word++)
            run[count++] = slc_page_of_entry(table->entries[word]);
        update_words(table, first, count, run, commands);
    }
}

static void record_lost(struct slc_page_table *table, uint64_t frame, VkCommandBuffer commands)
{
    for (uint32_t i = 0; i < table->part_count; i++) {
        struct slc_page_table_part *part = &table->parts[i];
        if (!part->is_lost)
            continue;
        record_words(table, part, commands);
        part->stored_frame = frame;
        part->is_lost = false;
    }
    table->has_lost = false;
}

void slc_page_table_record_begin(struct slc_page_table *table, uint64_t frame,
                                 VkCommandBuffer commands)
{
    for (uint32_t i = 0; i < table->new_part_count; i++) {
        struct slc_page_table_part *part = &table->parts[table->new_parts[i]];
        record_header(table, part, commands);
        if (!part->is_lost)
            record_no_pages(table, part, commands);
        part->recorded_frame = frame;
    }
    table->new_part_count = 0;
    if (table->has_lost)
        record_lost(table, frame, commands);
}

/* Sorts by word. Stores to one word keep their order. */
static int compare_stores(const void *a, const void *b)
{
    const struct slc_page_store *x = a, *y = b;
    if (x->word != y->word)
        return x->word < y->word ? -1 : 1;
    return x->turn < y->turn ? -1 : 1;
}

void slc_page_table_record_publish(struct slc_page_table *table, VkCommandBuffer commands)
{
    uint32_t run[STORE_BATCH], run_count = 0, first = 0;
    if (table->store_count > 1)
        qsort(table->stores, table->store_count, sizeof *table->stores, compare_stores);
    for (uint32_t i = 0; i < table->store_count; i++) {
        const struct slc_page_store *s = &table->stores[i];
        if (i + 1 < table->store_count && s[1].word == s->word)
            continue;
        if (run_count && (s->word != first + run_count || run_count == STORE_BATCH)) {
            update_words(table, first, run_count, run, commands);
            run_count = 0;
        }
        if (run_count == 0)
            first = s->word;
        run[run_count++] = s->value;
    }
    update_words(table, first, run_count, run, commands);
    table->store_count = 0;
}

void slc_page_table_abandon(struct slc_page_table *table, uint64_t frame)
{
    table->store_count = 0; /* left by a begin that failed: lost parts are written again */
    for (uint32_t i = 0; i < table->part_count; i++) {
        struct slc_page_table_part *part = &table->parts[i];
        if (part->recorded_frame >= frame) {
            part->recorded_frame = 0;
            table->new_parts[table->new_part_count++] = i;
            part->is_lost = true;
        }
        part->is_lost |= part->stored_frame >= frame;
        table->has_lost |= part->is_lost;
    }
}
