#include "vulkan/page_moves.h"

#include "base/checked.h"

#include <sluice/shared/texture_table.h>

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#define WORDS_PER_FRAME 65536u /* approximate words of the table that a frame scans */

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

/* State of recording the moves of a frame. */
struct turn {
    struct slc_page_moves *moves;
    uint32_t leaving; ///< image that is being emptied
    uint32_t room;    ///< pages that may still be moved
    uint32_t tiles;   ///< tiles on moved pages
    uint32_t stored;  ///< moved tiles whose words show the new page
    uint64_t frame;
    VkCommandBuffer commands;
};

static bool has_room(const struct turn *t, uint32_t tiles)
{
    uint32_t sum = t->tiles + tiles;
    if (t->room == 0 || t->moves->count == SLC_PAGE_MOVES ||
        (t->tiles > 0 && sum > SLC_PAGE_MOVED_TILES))
        return false;
    return sum <= SLC_PAGE_MOVES_PER_FRAME ||
           slc_page_table_make_room(t->moves->table, sum - t->stored + t->moves->store_reserve);
}

/* Copies the page. Returns false if there is no page for its tiles, or no room in the lists. */
static bool move_page(struct turn *t, uint32_t from)
{
    struct slc_page_moves *moves = t->moves;
    struct slc_page_move *move = &moves->under_way[moves->count];
    uint32_t tiles = slc_page_pool_tiles_on(moves->pool, moves->user, from);
    if (tiles == 0 || !has_room(t, tiles) ||
        !slc_page_pool_move(moves->pool, moves->user, from, t->frame, &move->to, &move->readers))
        return false;
    move->from = from;
    move->frame = t->frame;
    record_copy(moves->pool, from, move->to, t->commands);
    moves->to_of[from & 0xFFFFu] = 1 + move->to;
    moves->count++;
    moves->left -= moves->left == UINT32_MAX ? 0 : 1;
    t->room--;
    t->tiles += tiles;
    return true;
}

/* Moves the pages of a part's tiles while there is room, and shows the tiles on their new pages. */
static void move_part(struct turn *t, uint32_t part)
{
    struct slc_page_table *table = t->moves->table;
    const struct slc_page_table_part *p = &table->parts[part];
    for (uint32_t i = p->desc.regularMipCount; i < p->word_count; i++) {
        uint32_t *entry = &table->entries[p->first_word + i], from = slc_page_of_entry(*entry);
        if (!slc_page_is_taken(*entry) || !(*entry & SLC_PAGE_SHOWN) || from >> 16 != t->leaving ||
            (!t->moves->to_of[from & 0xFFFFu] && !move_page(t, from)))
            continue;
        *entry = (t->moves->to_of[from & 0xFFFFu] - 1) | SLC_PAGE_SHOWN;
        slc_page_table_store(table, part, p->first_word + i, t->frame);
        t->stored++;
    }
}

void slc_page_moves_record(struct slc_page_moves *moves, uint64_t frame, VkCommandBuffer commands)
{
    const struct slc_page_table *table = moves->table;
    uint32_t first = moves->count;
    struct turn t = {.moves = moves,
                     .leaving = slc_page_pool_leaving(moves->pool, moves->user),
                     .room = slc_min_u32(moves->left, SLC_PAGE_MOVES_PER_FRAME),
                     .frame = frame,
                     .commands = commands};
    if (t.room == 0 || t.leaving == SLC_NONE)
        return;
    for (uint32_t i = 0, words = 0; i < table->part_count && words < WORDS_PER_FRAME && t.room;
         i++) {
        move_part(&t, moves->next_part);
        words += table->parts[moves->next_part].word_count;
        moves->next_part = (moves->next_part + 1) % table->part_count;
    }
    t.room = 0;
    for (uint32_t i = 0; i < table->part_count && t.stored < t.tiles; i++)
        move_part(&t, i);
    assert(t.stored == t.tiles);
    for (uint32_t i = first; i < moves->count; i++)
        moves->to_of[moves->under_way[i].from & 0xFFFFu] = 0;
}

static int compare_new_pages(const void *a, const void *b)
{
    const struct slc_page_move *x = a, *y = b;
    return (x->to > y->to) - (x->to < y->to);
}

/* Shows tiles from their old pages. The moves are sorted by new page. */
static void show_old_pages(struct slc_page_table *table, const struct slc_page_move *moves,
                           uint32_t count)
{
    for (uint32_t i = 0; i < table->part_count; i++) {
        const struct slc_page_table_part *p = &table->parts[i];
        for (uint32_t j = p->desc.regularMipCount; j < p->word_count; j++) {
            uint32_t *entry = &table->entries[p->first_word + j];
            if (!slc_page_is_taken(*entry))
                continue;
            const struct slc_page_move key = {.to = slc_page_of_entry(*entry)};
            const struct slc_page_move *move =
                bsearch(&key, moves, count, sizeof *moves, compare_new_pages);
            if (move)
                *entry = move->from | (*entry & SLC_PAGE_SHOWN);
        }
    }
}

/* Tiles may have left the new page since, and other tiles may be there. */
void slc_page_moves_abandon(struct slc_page_moves *moves, uint64_t frame)
{
    uint32_t first = moves->count, last = moves->count;
    while (moves->count && moves->under_way[moves->count - 1].frame >= frame) {
        const struct slc_page_move move = moves->under_way[--moves->count];
        if (slc_page_pool_move_back(moves->pool, moves->user, move.from, move.to))
            moves->under_way[--first] = move;
    }
    qsort(moves->under_way + first, last - first, sizeof *moves->under_way, compare_new_pages);
    if (first < last)
        show_old_pages(moves->table, moves->under_way + first, last - first);
}
