#include "vulkan/page_moves.h"

#include "base/checked.h"

#include <sluice/shared/texture_table.h>

#include <string.h>

#define WORDS_PER_FRAME 65536u /* words of the table that a frame scans, about */

void slc_page_moves_complete(struct slc_page_moves *moves, uint64_t completed_frame)
{
    uint32_t over = 0;
    while (over < moves->count && moves->under_way[over].frame <= completed_frame &&
           slc_page_pool_end_move(moves->pool, moves->user, moves->under_way[over].from,
                                  &moves->under_way[over].readers))
        over++;
    moves->count -= over;
    memmove(moves->under_way, moves->under_way + over, moves->count * sizeof *moves->under_way);
}

static void record_copy(const struct slc_page_pool *pool, uint32_t from, uint32_t to,
                        VkCommandBuffer commands)
{
    const struct slc_page_chunk *chunk = &pool->chunks.at[from >> 16];
    VkImageCopy copy = {.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, from & 0xFFFFu, 1},
                        .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, to & 0xFFFFu, 1},
                        .extent = {0, 0, 1}};
    SluiceResult result = sluiceGetStandardTileShape(slc_page_texel_format(chunk->format),
                                                     &copy.extent.width, &copy.extent.height);
    assert(result == SLUICE_SUCCESS);
    (void)result;
    pool->vk.CmdCopyImage(commands, slc_page_image(pool, from), VK_IMAGE_LAYOUT_GENERAL,
                          slc_page_image(pool, to), VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
}

/* Returns false if there is no page for the tile, or no room in the list. */
static bool move_tile(struct slc_page_moves *moves, uint32_t part, uint32_t word, uint64_t frame,
                      VkCommandBuffer commands)
{
    uint32_t *entry = &moves->table->entries[word], from = slc_page_of_entry(*entry), to;
    struct slc_page_readers readers;
    if (moves->count == SLC_PAGE_MOVES ||
        !slc_page_pool_move(moves->pool, moves->user, from, frame, &to, &readers))
        return false;
    record_copy(moves->pool, from, to, commands);
    *entry = to | SLC_PAGE_SHOWN;
    slc_page_table_store(moves->table, part, word, frame);
    moves->under_way[moves->count++] = (struct slc_page_move){part, word, from, to, frame, readers};
    return true;
}

/* Returns how many tiles of the part were moved. */
static uint32_t move_tiles(struct slc_page_moves *moves, uint32_t leaving, uint32_t part,
                           uint32_t room, uint64_t frame, VkCommandBuffer commands)
{
    const struct slc_page_table_part *p = &moves->table->parts[part];
    uint32_t moved = 0, end = p->first_word + p->word_count;
    for (uint32_t word = p->first_word + p->desc.regularMipCount; word < end && moved < room;
         word++) {
        uint32_t entry = moves->table->entries[word];
        if (!slc_page_is_taken(entry) || !(entry & SLC_PAGE_SHOWN) ||
            slc_page_of_entry(entry) >> 16 != leaving)
            continue;
        if (!move_tile(moves, part, word, frame, commands))
            break;
        moved++;
    }
    return moved;
}

void slc_page_moves_record(struct slc_page_moves *moves, uint64_t frame, uint64_t completed_frame,
                           VkCommandBuffer commands)
{
    const struct slc_page_table *table = moves->table;
    uint32_t room = slc_min_u32(moves->left, SLC_PAGE_MOVES_PER_FRAME);
    uint32_t leaving = slc_page_pool_leaving(moves->pool, moves->user);
    if (room == 0 || leaving == SLC_NONE)
        return;
    for (uint32_t i = 0, words = 0; i < table->part_count && words < WORDS_PER_FRAME && room; i++) {
        uint32_t part = moves->next_part;
        const struct slc_page_table_part *p = &table->parts[part];
        moves->next_part = (part + 1) % table->part_count;
        words += p->word_count;
        /* Abandoning a frame under way takes back the words that it stored. */
        if (p->word_count == 0 || p->is_lost || p->stored_frame > completed_frame)
            continue;
        uint32_t moved = move_tiles(moves, leaving, part, room, frame, commands);
        room -= moved;
        moves->left -= moves->left == UINT32_MAX ? 0 : moved;
    }
}

void slc_page_moves_forget(struct slc_page_moves *moves, uint32_t part)
{
    for (uint32_t i = 0; i < moves->count; i++)
        if (moves->under_way[i].part == part)
            moves->under_way[i].word = SLC_NONE;
}

/* The tile may have been unmapped since, and mapped again. */
static void take_back(struct slc_page_moves *moves, const struct slc_page_move *move)
{
    if (move->word == SLC_NONE) {
        slc_page_pool_give(moves->pool, moves->user, move->from, SLC_NO_OWNER);
        return;
    }
    uint32_t *entry = &moves->table->entries[move->word];
    if (*entry == (move->to | SLC_PAGE_SHOWN)) {
        slc_page_pool_move_back(moves->pool, moves->user, move->from, move->to);
        *entry = move->from | SLC_PAGE_SHOWN;
        return;
    }
    if (*entry == (move->to | SLC_PAGE_GIVEN)) /* the copy never ran */
        *entry = SLUICE_PAGE_NONE;
    slc_page_pool_give(moves->pool, moves->user, move->from, SLC_NO_OWNER);
}

void slc_page_moves_abandon(struct slc_page_moves *moves, uint64_t frame)
{
    while (moves->count && moves->under_way[moves->count - 1].frame >= frame)
        take_back(moves, &moves->under_way[--moves->count]);
}
