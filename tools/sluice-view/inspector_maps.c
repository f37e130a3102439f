#include "inspector_maps.h"

#include <stdlib.h>

#define SECONDS 0.1

/* Returns the texture whose feedback counts: a follower's primary. */
static SluiceTextureId id_of_feedback(const struct stage *stage, uint32_t texture)
{
    const uint32_t primary = stage_texture(stage, texture)->primary;
    return stage_texture(stage, primary == STAGE_NO_TEXTURE ? texture : primary)->id;
}

/* Recordings have no marks of shaders. */
static void look_at_feedback(struct inspector_maps *m, const struct stage *stage, uint32_t texture)
{
    const SluiceTextureId id = id_of_feedback(stage, texture);
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    m->feedback_known = false;
    if (!stage_streamer(stage) ||
        sluiceGetTextureLayout(stage_manager(stage), id, &layout) != SLUICE_SUCCESS)
        return;
    const size_t size = (size_t)layout.feedbackWidth * layout.feedbackHeight;
    uint8_t *levels = realloc(m->feedback, size);
    if (!levels)
        return;
    m->feedback = levels;
    m->feedback_layout = layout;
    m->feedback_known = sluiceWriteVulkanFeedback(stage_streamer(stage), id, layout.feedbackWidth,
                                                  size, levels) == SLUICE_SUCCESS;
}

/* Makes room for another texture. */
static bool fit(struct inspector_maps *m, const struct stage *stage, SluiceTextureId id)
{
    if (m->states && m->id == id)
        return true;
    inspector_maps_finish(m);
    m->id = id;
    m->layout = (SluiceStreamedTextureLayout){.structSize = sizeof m->layout};
    if (sluiceGetTextureLayout(stage_manager(stage), id, &m->layout) != SLUICE_SUCCESS)
        return false;
    const size_t size = (size_t)m->layout.minMipWidth * m->layout.minMipHeight;
    m->states = calloc(m->layout.tileCount + 2 * size + 1, 1);
    m->resident = m->states + m->layout.tileCount;
    m->requested = m->resident + size;
    return m->states;
}

static bool look(struct inspector_maps *m, const SluiceStreamedTextureManager *manager)
{
    const uint32_t width = m->layout.minMipWidth;
    const size_t size = (size_t)width * m->layout.minMipHeight;
    for (uint32_t i = 0; i < m->layout.regularTileCount; i++) {
        SluiceTileState state = SLUICE_TILE_STATE_FREE;
        sluiceGetTileState(manager, m->id, i, &state, NULL);
        m->states[i] = (uint8_t)state;
    }
    return sluiceWriteMinMipData(manager, m->id, width, size, m->resident) == SLUICE_SUCCESS &&
           sluiceWriteRequestedLevels(manager, m->id, width, size, m->requested) == SLUICE_SUCCESS;
}

bool inspector_maps_update(struct inspector_maps *m, const struct stage *stage, uint32_t texture,
                           double seconds)
{
    if (!fit(m, stage, stage_texture(stage, texture)->id))
        return false;
    if (seconds < m->next && !stage_played(stage))
        return m->known;
    m->next = seconds + SECONDS;
    m->known = look(m, stage_manager(stage));
    look_at_feedback(m, stage, texture);
    return m->known;
}

void inspector_maps_finish(struct inspector_maps *m)
{
    free(m->states);
    free(m->feedback);
    *m = (struct inspector_maps){0};
}
