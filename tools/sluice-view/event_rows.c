#include "event_rows.h"

uint32_t event_rows_find(const struct view_facts *f, uint32_t reason, uint32_t texture,
                         const SluiceTileEvent **rows, uint32_t most)
{
    uint32_t count = 0, index;
    for (uint32_t age = 0; age < f->event_count && count < most; age++) {
        const SluiceTileEvent *event =
            &f->events[(f->event_next + FACTS_EVENTS - 1 - age) % FACTS_EVENTS];
        if (reason != EVENT_ANY_REASON && (uint32_t)event->reason + 1 != reason)
            continue;
        if (!tile_log_index(&f->log, event->textureId, &index) ||
            (texture != STAGE_NO_TEXTURE && texture != index))
            continue;
        rows[count++] = event;
    }
    return count;
}
