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
    SERIES_STALE, ///< tiles per frame that were loaded, and not seen since their load
    SERIES_RESTORED,
    SERIES_BIND_CALLS, ///< per frame
    SERIES_BIND_RUNS,
    SERIES_FEEDBACK_WORDS,
    SERIES_MISSING, ///< percent
    SERIES_COUNT
};

struct facts_texture {
    SluiceTextureStatistics statistics;
    uint32_t finest_level;      ///< finest level with resident tiles; SLUICE_MIP_UNTOUCHED: none
    double thrash;              ///< loads per resident tile
    SluiceTextureRequestId pin; ///< request that pins all tiles; 0: none
    SluiceTileLoaderStatistics reads; ///< figures of its source, some frames old
};

struct view_facts {
    double seconds;       ///< time since the first frame
    double frame_seconds; ///< smoothed duration of a frame
    double real_seconds;  ///< duration of the last frame; 0: `seconds` of facts_update
    double host_seconds, gpu_seconds, present_seconds, ui_seconds;
    uint64_t frame;
    uint64_t all_size, resident_size, standby_size, wanted_size, memory_size;
    uint64_t tails_size; ///< bytes of all mip tails; a resident tail is never evicted
    uint64_t budget;     ///< 0: none
    double sharp;        ///< part of the regions in view with their requested level, 0 to 1
    bool sharp_known;    ///< the last count found requests; otherwise `sharp` is 0
    SluiceVulkanStreamerStatistics now, before;
    SluiceVulkanContextStatistics context;
    SluiceVulkanLoadStages stages;
    SluiceTileLoaderStatistics reads; ///< figures of all sources
    uint32_t reads_texture;           ///< texture whose `reads` are updated next
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
    uint32_t map_texture; ///< texture whose maps are read next
    uint64_t sharp_count, seen_count;
    bool borrows;          ///< `log` and `events` belong to a recording
    uint32_t played_frame; ///< frame of the recording that the figures describe; UINT32_MAX: none
};

/** Creates facts of a stage. False, with a line on stderr, without memory. */
bool facts_create(struct view_facts *facts, const struct stage *stage);
void facts_destroy(struct view_facts *facts);
/** Updates the facts. Call once per frame, after the frame was recorded. */
void facts_update(struct view_facts *facts, const struct stage *stage,
                  const struct view_settings *settings, double seconds);
/** Reads all textures and maps of the stage's manager at once. */
void facts_look_at_all(struct view_facts *facts, const struct stage *stage);
/** Returns the memory that all requests need. Takes time proportional to the tiles of level 0. */
struct budget_need facts_budget_need(const struct view_facts *facts, const struct stage *stage);
const char *facts_series_name(enum facts_series series);

#endif /* SLUICE_VIEW_FACTS_H */
