/** Facts for the panels: figures of the streamer, gathered once per frame. */
#ifndef SLUICE_VIEW_FACTS_H
#define SLUICE_VIEW_FACTS_H

#include "budget_need.h"
#include "history.h"
#include "settings.h"
#include "stage.h"
#include "tile_log.h"

#include <sluice/vulkan_explain.h>

#define FACTS_EVENTS 2048

enum facts_series {
    SERIES_RESIDENT, ///< MB
    SERIES_WANTED,
    SERIES_STANDBY,
    SERIES_BUDGET,
    SERIES_READ, ///< MB/s
    SERIES_UPLOADED,
    SERIES_MAPPED, ///< tiles per frame
    SERIES_UNMAPPED,
    SERIES_CANCELED,
    SERIES_FAILED,
    SERIES_SHARP, ///< percent
    SERIES_BIAS,  ///< levels
    SERIES_FRAME, ///< ms
    SERIES_HOST,
    SERIES_GPU,
    SERIES_STALE, ///< tiles per frame that were loaded and not seen after that
    SERIES_RESTORED,
    SERIES_BIND_CALLS, ///< per frame
    SERIES_BIND_RUNS,
    SERIES_FEEDBACK_WORDS,
    SERIES_MISSING, ///< percent
    SERIES_COUNT
};

struct facts_texture {
    SluiceTextureStatistics statistics;
    uint32_t finest_level;            ///< resident somewhere; SLUICE_MIP_UNTOUCHED: none
    double thrash;                    ///< loads per resident tile
    SluiceTextureRequestId pin;       ///< of all its tiles; 0: none
    SluiceTileLoaderStatistics reads; ///< of its source, of a frame not long ago
};

struct view_facts {
    double seconds;       ///< since the first frame
    double frame_seconds; ///< smoothed
    double real_seconds;  ///< that the last frame took; 0: as given to facts_update
    double host_seconds, gpu_seconds, present_seconds, ui_seconds;
    uint64_t frame;
    uint64_t all_size, resident_size, standby_size, wanted_size, memory_size;
    uint64_t tails_size; ///< of all textures; stays whatever the budget
    uint64_t budget;     ///< 0: none
    double sharp;        ///< part of the regions in view that have the level that they request
    bool sharp_known;    ///< the last count found requests; false: `sharp` is 0
    SluiceVulkanStreamerStatistics now, before;
    SluiceVulkanContextStatistics context;
    SluiceVulkanLoadStages stages;
    SluiceTileLoaderStatistics reads; ///< of all sources
    uint32_t reads_texture;           ///< the next texture whose reads are looked at
    struct facts_texture *textures;   ///< owned
    uint32_t texture_count;
    float latest[SERIES_COUNT];
    struct history history;
    struct tile_log log;
    uint64_t stale_before;
    SluiceTileEvent *events; ///< owned; the last FACTS_EVENTS, a ring
    uint32_t event_count, event_next;
    uint64_t event_cursor;
    uint8_t *maps; ///< owned; scratch for two maps of the largest texture
    size_t map_size;
    uint32_t map_texture; ///< the next texture whose maps are looked at
    uint64_t sharp_count, seen_count;
    bool borrows;          ///< log and events are those of a recording
    uint32_t played_frame; ///< of the recording, that the figures are of; UINT32_MAX: none yet
};

/** False, with a line on stderr, without memory. */
bool facts_create(struct view_facts *facts, const struct stage *stage);
void facts_destroy(struct view_facts *facts);
/** Once per frame, after it was recorded. */
void facts_update(struct view_facts *facts, const struct stage *stage,
                  const struct view_settings *settings, double seconds);
/** Looks at all textures and maps of the stage's manager at once. */
void facts_look_at_all(struct view_facts *facts, const struct stage *stage);
/** Returns the memory that all requests need. Takes time in proportion to tiles of level 0. */
struct budget_need facts_budget_need(const struct view_facts *facts, const struct stage *stage);
const char *facts_series_name(enum facts_series series);

#endif /* SLUICE_VIEW_FACTS_H */
