#include "probe.h"

#include <math.h>

static uint32_t texel_of(float part, uint32_t size)
{
    const uint32_t texel = (uint32_t)(part * (float)size);
    return texel < size ? texel : size - 1;
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Returns the tile of a level that covers a texel of level 0. */
static uint32_t tile_over(const SluiceStreamedTextureLayout *layout, const uint32_t texel[2],
                          uint32_t level)
{
    if (level >= layout->desc.regularMipCount)
        return layout->regularTileCount;
    const uint32_t width = layout->levelWidthInTiles[level];
    const uint32_t height = layout->levelHeightInTiles[level];
    const uint32_t x = smaller((texel[0] >> level) / layout->desc.tileWidth, width - 1);
    const uint32_t y = smaller((texel[1] >> level) / layout->desc.tileHeight, height - 1);
    return layout->levelFirstTile[level] + y * width + x;
}

static void look_at_tile(const struct stage *stage, const struct view_facts *facts,
                         SluiceTextureId id, struct view_probe *probe)
{
    const struct tile_log_tile *log = tile_log_get(&facts->log, id, probe->tile_index);
    sluiceGetTileState(stage_manager(stage), id, probe->tile_index, &probe->state, &probe->tile);
    if (!log)
        return;
    probe->loads = log->loads;
    probe->failures = log->failures;
    if (log->loads > 0)
        probe->age = (double)(stage_now(stage) - log->loaded_time) / STAGE_TICKS_PER_SECOND;
}

void probe_point(const struct stage *stage, const struct view_facts *facts,
                 const struct stage_pick *pick, struct view_probe *probe)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    *probe = (struct view_probe){
        .texture = STAGE_NO_TEXTURE, .age = -1, .why = {.structSize = sizeof probe->why}};
    if (!pick->hit || pick->texture >= facts->texture_count)
        return;
    const struct stage_texture *texture = stage_texture(stage, pick->texture);
    probe->texture = pick->texture;
    probe->texel[0] = texel_of(pick->u, texture->width);
    probe->texel[1] = texel_of(pick->v, texture->height);
    const SluiceTextureRect rect = {probe->texel[0], probe->texel[1], 1, 1};
    if (sluiceGetTextureLayout(stage_manager(stage), texture->id, &layout) != SLUICE_SUCCESS ||
        sluiceExplainVulkanTexture(stage_streamer(stage), texture->id, &rect, &probe->why) !=
            SLUICE_SUCCESS)
        return;
    probe->known = true;
    probe->resident = (uint8_t)probe->why.residentLevel;
    probe->requested = (uint8_t)probe->why.requestedLevel;
    probe->tile_index = tile_over(&layout, probe->texel, probe->resident);
    if (probe->tile_index < layout.tileCount)
        look_at_tile(stage, facts, texture->id, probe);
}

/* Computes the level of detail like sluiceComputeLod of the shaders. The longer side of the pixel's
 * footprint counts. With anisotropic filtering the footprint is an ellipse: its shorter axis
 * counts, but at least the longer side divided by the anisotropy. */
void probe_pixel(const float texels[4], const struct view_settings *settings,
                 struct view_probe *probe)
{
    const double x = (double)texels[0], y = (double)texels[1];
    const double z = (double)texels[2], w = (double)texels[3];
    const double right = hypot(x, y), down = hypot(z, w);
    const double sum = right * right + down * down, area = x * w - y * z;
    if (!(sum > 0))
        return;
    const double shorter = sqrt(fmax(0, (sum - sqrt(fmax(0, sum * sum - 4 * area * area))) / 2));
    const double longer = fmax(right, down),
                 most = settings->filter == VIEW_NEAREST ? 1 : settings->anisotropy;
    probe->density = fmin(right, down);
    probe->lod = log2(most > 1 ? fmax(shorter, longer / most) : longer) + settings->lod_bias;
    probe->camera_level = floor(probe->lod - (most > 1 ? 0.1875 : 0.125)); /* sluiceLodMargin */
    if (probe->camera_level < settings->finest_level && settings->finest_level > 0)
        probe->lod = probe->camera_level = settings->finest_level;
}
