#include "core/minmip.h"

#include "base/bits.h"
#include "base/bytes.h"
#include "base/checked.h"

#include <string.h>

/*
 * A texel of the map is one tile of level 0. The tiles over it form a chain to the coarsest regular
 * level. A resident tile counts only if every coarser tile of its chain counts. So a change shows
 * only if the parent of the tile counts: in the area under the tile, and in finer tiles as far as
 * they are resident.
 */

uint8_t slc_min_mip_floor(const struct slc_managed_texture *t)
{
    bool packed =
        t->shape->desc.packedTileCount > 0 && t->packed_resident == t->shape->desc.packedTileCount;
    return packed ? (uint8_t)t->shape->desc.regularMipCount : SLUICE_MIP_UNTOUCHED;
}

static bool is_resident(const struct slc_managed_texture *t, struct slc_place p)
{
    return t->nodes[slc_tile_index(t, p)] & SLC_RESIDENT;
}

/** Tiles of the next finer level whose parent is in the range. The last parent has all that remain.
 */
static struct slc_tile_range children(const struct slc_managed_texture *t, uint32_t level,
                                      struct slc_tile_range r)
{
    const struct slc_level *here = &t->shape->levels[level], *fine = &t->shape->levels[level - 1];
    return (struct slc_tile_range){
        r.x0 * 2,
        r.y0 * 2,
        r.x1 + 1 == here->width ? fine->width - 1 : slc_min_u32(r.x1 * 2 + 1, fine->width - 1),
        r.y1 + 1 == here->height ? fine->height - 1 : slc_min_u32(r.y1 * 2 + 1, fine->height - 1),
    };
}

/** Tiles of level 0 under tile `i` of `count` of a level. The last tile covers all that remain. */
static void axis_area(uint32_t i, uint32_t count, uint32_t level, uint32_t fine_count,
                      uint32_t *first, uint32_t *last)
{
    *first = i << level;
    uint64_t end = (uint64_t)(i + 1) << level;
    *last = i + 1 == count || end > fine_count ? fine_count - 1 : (uint32_t)end - 1;
}

struct slc_tile_range slc_area(const struct slc_managed_texture *t, struct slc_place p)
{
    const struct slc_level *grid = &t->shape->levels[p.level], *fine = &t->shape->levels[0];
    struct slc_tile_range r;
    axis_area(p.x, grid->width, p.level, fine->width, &r.x0, &r.x1);
    axis_area(p.y, grid->height, p.level, fine->height, &r.y0, &r.y1);
    return r;
}

static void dirty_list_append(slc_manager *m, struct slc_managed_texture *t)
{
    t->dirty = true;
    t->dirty_next = SLC_NONE;
    t->dirty_prev = m->dirty_last;
    if (m->dirty_last != SLC_NONE)
        slc_texture_at(m, m->dirty_last)->dirty_next = t->index;
    else
        m->dirty_first = t->index;
    m->dirty_last = t->index;
    m->dirty_count++;
}

static void mark_dirty(slc_manager *m, struct slc_managed_texture *t, struct slc_tile_range r)
{
    if (!t->dirty) {
        dirty_list_append(m, t);
        t->dirty_x0 = r.x0, t->dirty_y0 = r.y0;
        t->dirty_x1 = r.x1 + 1, t->dirty_y1 = r.y1 + 1;
        return;
    }
    t->dirty_x0 = slc_min_u32(t->dirty_x0, r.x0);
    t->dirty_y0 = slc_min_u32(t->dirty_y0, r.y0);
    t->dirty_x1 = slc_max_u32(t->dirty_x1, r.x1 + 1);
    t->dirty_y1 = slc_max_u32(t->dirty_y1, r.y1 + 1);
}

static struct slc_tile_range all_texels(const struct slc_managed_texture *t)
{
    return (struct slc_tile_range){0, 0, t->shape->min_mip_width - 1, t->shape->min_mip_height - 1};
}

void slc_min_mip_dirty_all(slc_manager *m, struct slc_managed_texture *t)
{
    mark_dirty(m, t, all_texels(t));
}

void slc_min_mip_drop_update(slc_manager *m, struct slc_managed_texture *t)
{
    if (!t->dirty)
        return;
    if (t->dirty_prev != SLC_NONE)
        slc_texture_at(m, t->dirty_prev)->dirty_next = t->dirty_next;
    else
        m->dirty_first = t->dirty_next;
    if (t->dirty_next != SLC_NONE)
        slc_texture_at(m, t->dirty_next)->dirty_prev = t->dirty_prev;
    else
        m->dirty_last = t->dirty_prev;
    t->dirty = false;
    m->dirty_count--;
}

/** Fills `unit` bytes at both ends of each row: the whole row, if it has at most 2 * `unit` bytes.
 */
static inline void fill_ends(uint8_t *row, size_t pitch, uint32_t rows, size_t width, size_t unit,
                             uint64_t word)
{
    for (; rows > 0; rows--, row += pitch) {
        memcpy(row, &word, unit);
        memcpy(row + width - unit, &word, unit);
    }
}

static void fill(struct slc_managed_texture *t, struct slc_tile_range r, uint8_t value)
{
    size_t pitch = t->shape->min_mip_width, width = r.x1 - r.x0 + 1;
    uint32_t rows = r.y1 - r.y0 + 1;
    uint8_t *row = t->min_mip + r.y0 * pitch + r.x0;
    uint64_t word = UINT64_C(0x0101010101010101) * value;
    if (width == 1)
        fill_ends(row, pitch, rows, width, 1, word);
    else if (width < 4)
        fill_ends(row, pitch, rows, width, 2, word);
    else if (width < 8)
        fill_ends(row, pitch, rows, width, 4, word);
    else if (width <= 16)
        fill_ends(row, pitch, rows, width, 8, word);
    else
        for (; rows > 0; rows--, row += pitch)
            memset(row, value, width);
}

static void show(struct slc_managed_texture *t, struct slc_place p, struct slc_tile_range area);

/** Shows the resident children of a tile that counts. They count, too. */
static void show_children(struct slc_managed_texture *t, struct slc_place p)
{
    struct slc_tile_range c = children(t, p.level, (struct slc_tile_range){p.x, p.y, p.x, p.y});
    for (uint32_t y = c.y0; y <= c.y1; y++)
        for (uint32_t x = c.x0; x <= c.x1; x++) {
            struct slc_place child = {p.level - 1, x, y};
            if (is_resident(t, child)) {
                t->hidden_tiles--;
                show(t, child, slc_area(t, child));
            }
        }
}

/** Writes the area of a tile that counts, and of finer tiles that count. Recursion depth: the
 * level. */
static void show(struct slc_managed_texture *t, struct slc_place p, struct slc_tile_range area)
{
    fill(t, area, (uint8_t)p.level);
    if (p.level > 0 && t->hidden_tiles > 0)
        show_children(t, p);
}

/** True if a child of a tile that counts does, too: the map is finer at the child's first texel. */
static bool shows_children(const struct slc_managed_texture *t, struct slc_place p)
{
    if (p.level == 0)
        return false;
    struct slc_tile_range c = children(t, p.level, (struct slc_tile_range){p.x, p.y, p.x, p.y});
    for (uint32_t y = c.y0; y <= c.y1; y++) {
        const uint8_t *row = t->min_mip + ((size_t)y << (p.level - 1)) * t->shape->min_mip_width;
        for (uint32_t x = c.x0; x <= c.x1; x++)
            if (row[x << (p.level - 1)] < p.level)
                return true;
    }
    return false;
}

/** Counts the finer tiles under a tile that count. */
static uint32_t count_shown(const struct slc_managed_texture *t, struct slc_place p)
{
    uint32_t count = 0;
    if (p.level == 0)
        return 0;
    struct slc_tile_range c = children(t, p.level, (struct slc_tile_range){p.x, p.y, p.x, p.y});
    for (uint32_t y = c.y0; y <= c.y1; y++)
        for (uint32_t x = c.x0; x <= c.x1; x++) {
            struct slc_place child = {p.level - 1, x, y};
            if (is_resident(t, child))
                count += 1 + count_shown(t, child);
        }
    return count;
}

static void show_everything(struct slc_managed_texture *t)
{
    fill(t, all_texels(t), slc_min_mip_floor(t));
    t->hidden_tiles = t->resident_tiles;
    if (t->shape->desc.regularMipCount == 0 || t->packed_resident < t->shape->desc.packedTileCount)
        return;
    const struct slc_level *top = &t->shape->levels[t->shape->desc.regularMipCount - 1];
    for (uint32_t y = 0; y < top->height; y++)
        for (uint32_t x = 0; x < top->width; x++) {
            struct slc_place p = {t->shape->desc.regularMipCount - 1, x, y};
            if (is_resident(t, p)) {
                t->hidden_tiles--;
                show(t, p, slc_area(t, p));
            }
        }
}

static void packed_changed(slc_manager *m, struct slc_managed_texture *t, bool resident)
{
    bool before = t->packed_resident == t->shape->desc.packedTileCount;
    t->packed_resident += resident ? 1u : UINT32_MAX;
    if (before == (t->packed_resident == t->shape->desc.packedTileCount))
        return;
    if (t->nodes)
        show_everything(t);
    slc_min_mip_dirty_all(m, t);
}

void slc_min_mip_prefetch(const struct slc_managed_texture *t, const struct slc_node *n)
{
    if (n->tile >= t->shape->regular_tile_count)
        return;
    struct slc_place p = slc_node_place(t, n);
    size_t row = slc_min_u32(p.y << p.level, t->shape->min_mip_height - 1);
    SLC_PREFETCH(t->min_mip + row * t->shape->min_mip_width + (p.x << p.level));
}

static void tile_came(slc_manager *m, struct slc_managed_texture *t, struct slc_place p,
                      struct slc_tile_range area, bool counts)
{
    t->resident_tiles++;
    t->hidden_tiles += !counts;
    if (!counts)
        return;
    show(t, p, area);
    mark_dirty(m, t, area);
}

static void tile_went(slc_manager *m, struct slc_managed_texture *t, struct slc_place p,
                      struct slc_tile_range area, bool counted, uint8_t above)
{
    t->resident_tiles--;
    t->hidden_tiles -= !counted;
    if (!counted)
        return;
    if (shows_children(t, p))
        t->hidden_tiles += count_shown(t, p);
    fill(t, area, above);
    mark_dirty(m, t, area);
}

/** slc_min_mip_changed for tiles of level 0, which are most tiles: each is one texel. */
static void finest_changed(slc_manager *m, struct slc_managed_texture *t, uint32_t tile,
                           uint8_t above, bool resident)
{
    uint8_t *texel = &t->min_mip[tile];
    bool counts = resident ? *texel == above : *texel == 0;
    uint32_t one = resident ? 1 : UINT32_MAX;
    t->resident_tiles += one;
    t->hidden_tiles += counts ? 0 : one;
    if (!counts)
        return;
    *texel = resident ? 0 : above;
    uint32_t x = tile % t->shape->min_mip_width, y = tile / t->shape->min_mip_width;
    mark_dirty(m, t, (struct slc_tile_range){x, y, x, y});
}

void slc_min_mip_changed(slc_manager *m, struct slc_managed_texture *t, const struct slc_node *n,
                         bool resident)
{
    const struct slc_shape *shape = t->shape;
    if (n->tile >= shape->regular_tile_count) {
        packed_changed(m, t, resident);
        return;
    }
    t->nodes[n->tile] ^= SLC_RESIDENT;
    *slc_resident_in_level(t, n->level) += resident ? 1 : UINT32_MAX;
    if (n->level == 0 && shape->desc.regularMipCount > 1) {
        finest_changed(m, t, n->tile, 1, resident);
        return;
    }
    /* Under a tile that does not count, the map has one value: the level of the finest coarser tile
     * that counts. */
    struct slc_place p = slc_node_place(t, n);
    struct slc_tile_range r = slc_area(t, p);
    uint8_t shown = t->min_mip[(size_t)r.y0 * shape->min_mip_width + r.x0];
    bool coarsest = p.level + 1 == shape->desc.regularMipCount;
    uint8_t above = coarsest ? slc_min_mip_floor(t) : (uint8_t)(p.level + 1);
    if (resident)
        tile_came(m, t, p, r, shown == above && t->packed_resident == shape->desc.packedTileCount);
    else
        tile_went(m, t, p, r, shown <= p.level, above);
}
