#include "needs.h"

#include <stdlib.h>
#include <string.h>

static bool add_texture(struct needs *needs, const SluiceStreamedTextureManager *manager,
                        const struct needs_id *id)
{
    struct needs_texture *texture = &needs->textures[needs->texture_count];
    *texture = (struct needs_texture){.id = *id, .first_region = needs->region_count};
    texture->layout.structSize = sizeof texture->layout;
    if (sluiceGetTextureLayout(manager, id->id, &texture->layout) != SLUICE_SUCCESS)
        return false;
    texture->tile_frames = calloc(texture->layout.tileCount, sizeof *texture->tile_frames);
    texture->tile_loaded = calloc(texture->layout.tileCount, sizeof *texture->tile_loaded);
    needs->texture_count++;
    needs->region_count += (size_t)texture->layout.feedbackWidth * texture->layout.feedbackHeight;
    return texture->tile_frames && texture->tile_loaded;
}

bool needs_begin(struct needs *needs, const SluiceStreamedTextureManager *manager,
                 const struct needs_id *ids, uint32_t count)
{
    *needs = (struct needs){.textures = calloc(count + 1u, sizeof *needs->textures)};
    bool done = needs->textures != NULL;
    for (uint32_t i = 0; done && i < count; i++)
        done = add_texture(needs, manager, &ids[i]);
    if (done) {
        needs->levels = malloc(needs->region_count + 1);
        needs->shown = malloc((needs->region_count + 1) * sizeof *needs->shown);
        done = needs->levels && needs->shown && needs_wait_begin(&needs->wait, needs->region_count);
    }
    if (!done)
        needs_finish(needs);
    return done;
}

void needs_finish(struct needs *needs)
{
    for (uint32_t i = 0; i < needs->texture_count; i++) {
        free(needs->textures[i].tile_frames);
        free(needs->textures[i].tile_loaded);
    }
    free(needs->textures);
    free(needs->levels);
    free(needs->shown);
    needs_wait_finish(&needs->wait);
    *needs = (struct needs){0};
}

static uint16_t shown_at(const struct needs_texture *texture, const uint32_t *min_mip, uint32_t x,
                         uint32_t y)
{
    const SluiceStreamedTextureLayout *layout = &texture->layout;
    if (x >=
        layout->minMipWidth) /* textures without regular levels have one texel for all regions */
        x = layout->minMipWidth - 1;
    if (y >= layout->minMipHeight)
        y = layout->minMipHeight - 1;
    return (uint16_t)(min_mip[y * layout->minMipWidth + x] & 0xFFFFu);
}

/* Converts the buffers' words to maps. All packed levels become one. */
static void read_maps(struct needs *needs, const struct needs_texture *texture,
                      const struct needs_words *words)
{
    const SluiceStreamedTextureLayout *layout = &texture->layout;
    const struct SluiceTextureEntry *entry = &words->table[texture->id.table_index];
    const uint32_t *feedback = words->feedback + entry->feedbackOffset;
    uint8_t *levels = needs->levels + texture->first_region;
    uint16_t *shown = needs->shown + texture->first_region;
    for (uint32_t y = 0; y < layout->feedbackHeight; y++)
        for (uint32_t x = 0; x < layout->feedbackWidth; x++) {
            uint32_t at = y * layout->feedbackWidth + x, level = feedback[at];
            levels[at] = level >= SLUICE_MIP_UNTOUCHED ? SLUICE_MIP_UNTOUCHED
                         : level < layout->desc.regularMipCount
                             ? (uint8_t)level
                             : (uint8_t)layout->desc.regularMipCount;
            shown[at] = shown_at(texture, words->min_mip + entry->minMipOffset, x, y);
        }
}

static bool take_tile(struct needs *needs, struct needs_texture *texture, uint32_t tile,
                      struct needs_frame *frame)
{
    uint64_t *last = &texture->tile_frames[tile];
    if (*last == needs->frame_count)
        return false;
    needs->needed_tiles += *last == 0;
    frame->needed_tiles++;
    *last = needs->frame_count;
    return true;
}

/* Marks the tiles over a region (the area of a tile of level 0), from `level` to the first that is
 * marked already. */
static void take_region(struct needs *needs, struct needs_texture *texture, uint32_t x, uint32_t y,
                        uint32_t level, struct needs_frame *frame)
{
    const SluiceStreamedTextureLayout *layout = &texture->layout;
    for (; level < layout->desc.regularMipCount; level++) {
        uint32_t width = layout->levelWidthInTiles[level];
        uint32_t height = layout->levelHeightInTiles[level];
        uint32_t column = x >> level < width ? x >> level : width - 1;
        uint32_t row = y >> level < height ? y >> level : height - 1;
        if (!take_tile(needs, texture, layout->levelFirstTile[level] + row * width + column, frame))
            return;
    }
    for (uint32_t i = layout->regularTileCount; i < layout->tileCount; i++)
        take_tile(needs, texture, i, frame);
}

static void take_texture(struct needs *needs, struct needs_texture *texture,
                         struct needs_frame *frame)
{
    const uint8_t *levels = needs->levels + texture->first_region;
    const uint16_t *shown = needs->shown + texture->first_region;
    uint32_t width = texture->layout.feedbackWidth;
    for (uint32_t i = 0; i < width * texture->layout.feedbackHeight; i++) {
        if (levels[i] == SLUICE_MIP_UNTOUCHED)
            continue;
        texture->sampled = true;
        take_region(needs, texture, i % width, i / width, levels[i], frame);
        frame->missing_regions += !needs_is_shown(shown[i], levels[i]);
    }
}

bool needs_add_frame(struct needs *needs, const struct needs_words *words,
                     struct needs_frame *frame)
{
    needs->frame_count++;
    for (uint32_t i = 0; i < needs->texture_count; i++) {
        read_maps(needs, &needs->textures[i], words);
        take_texture(needs, &needs->textures[i], frame);
    }
    return needs_wait_add_frame(&needs->wait, needs->levels, needs->shown);
}

void needs_add_loaded(struct needs *needs, const SluiceStreamedTextureManager *manager)
{
    for (uint32_t i = 0; i < needs->texture_count; i++) {
        struct needs_texture *texture = &needs->textures[i];
        for (uint32_t tile = 0; tile < texture->layout.tileCount; tile++) {
            SluiceTileState state = SLUICE_TILE_STATE_FREE;
            if (!texture->tile_loaded[tile] &&
                sluiceGetTileState(manager, texture->id.id, tile, &state, NULL) == SLUICE_SUCCESS)
                texture->tile_loaded[tile] =
                    state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY;
        }
    }
}

uint64_t needs_count_tiles(const struct needs *needs, bool loaded, bool needed)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < needs->texture_count; i++) {
        const struct needs_texture *texture = &needs->textures[i];
        for (uint32_t tile = 0; tile < texture->layout.tileCount; tile++)
            count +=
                texture->tile_loaded[tile] == loaded && (texture->tile_frames[tile] != 0) == needed;
    }
    return count;
}

uint32_t needs_count_never_sampled(const struct needs *needs)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < needs->texture_count; i++)
        count += !needs->textures[i].sampled;
    return count;
}
