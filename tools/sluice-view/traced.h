/** A scene of pbrt on a device: rays ask a demand loader for what they lack. */
#ifndef SLUICE_VIEW_TRACED_H
#define SLUICE_VIEW_TRACED_H

#include "scene_pbrt.h"
#include "stage.h"
#include "traced_parts.h"

#include "../../samples/demand-pbrt/flight.h"

#include <sluice/demand_query.h>

#define TRACED_FRAME_SECONDS 0.03 ///< of a frame of a window, for what rays asked for
#define TRACED_EVENTS 1024u
#define TRACED_MISSES 1024u

struct view_facts;

/** Something that a launch asked for, or that could not be read. */
struct traced_event {
    uint64_t launch;
    uint32_t picture; ///< UINT32_MAX: unknown
    SluiceDemandMissKind kind;
    uint32_t level, x, y; ///< of tiles: column and row
};

struct traced_picture {
    struct stage_texture texture; ///< its name first; the rest when it is open
    SluiceDemandTextureId id;     ///< 0: no ray has asked for it
    uint32_t tile_count, resident_count, pending_count, refused_count;
    uint32_t arrived, left; ///< tiles, as far as looks at them tell
    uint32_t asked;         ///< openings, tiles and tails that launches missed
    uint32_t finest;        ///< level of which tiles are resident; UINT32_MAX: none
    /** Its file, once it is open: other threads may read it. */
    _Atomic(struct picture_file *) file;
};

struct traced {
    const struct gpu *gpu; ///< borrowed
    struct scene_pbrt *pbrt;
    struct pbrt_options options;
    struct view_settings settings; ///< applied last
    bool waits;                    ///< for all work of a frame
    struct traced_parts *parts;    ///< owned
    SluiceVulkanContext *context;  ///< of `parts`, as the loader
    SluiceDemandLoader *loader;
    struct mesh_cache *meshes;
    struct picture_files files;
    struct textures textures;
    struct surfaces surfaces;
    struct table lights, emitters;
    bool only_areas;
    struct proxies proxies;
    struct world world;
    struct film film;
    struct launches launches;
    struct flight flight;
    struct traced_tiles tiles;
    bool looks;                  ///< launches find out what pixels have and want
    bool looked;                 ///< the last launch did
    uint32_t rays;               ///< number of the last launch with rays of this frame; 0: none
    uint64_t time;               ///< microseconds, of the last frame
    uint32_t use_count;          ///< uses of pictures that `parts->show.pictures` has
    uint32_t most_texture_index; ///< of these
    struct PbrtLaunch constants; ///< of the picture that is gathered
    uint32_t sample;             ///< that is traced: so many are complete
    uint32_t missing;            ///< pixels of it, after the last launch
    uint32_t vain;               ///< launches in a row without progress
    float lod_bias;              ///< of the picture that is gathered
    bool restarts;
    double trace_seconds; ///< of the launches of the last frame
    SluiceDemandTicket ticket;
    struct traced_picture *pictures; ///< owned
    uint32_t picture_count;
    uint32_t next_picture; ///< that is looked at
    SluiceDemandStatistics now, before;
    uint32_t miss_count;           ///< of the last launch, as far as they are listed
    uint32_t pages[TRACED_MISSES]; ///< of these; ascend
    struct traced_event events[TRACED_EVENTS];
    uint32_t event_count, event_next;
    char picked[256]; ///< what traced_pick found, in words
};

/** Takes the scene. Says on stderr why it failed; NULL then. */
struct traced *traced_create(const struct stage_request *request,
                             const struct view_settings *settings, struct scene_pbrt *pbrt);
void traced_destroy(struct traced *traced);
/** Traces, and waits for it. The view of the picture goes into `end`; a copy is recorded. */
bool traced_record(struct traced *traced, const struct stage_draw *draw, VkCommandBuffer commands,
                   struct frames_end *end);
/** Traces and shows a picture once, and makes nothing that rays ask for: to compile programs. */
bool traced_trace_once(struct traced *traced, const struct stage_draw *draw);
void traced_apply(struct traced *traced, const struct view_settings *settings);
/** Constants of a launch for a camera of the viewer. */
struct PbrtLaunch traced_constants(struct traced *traced, const struct view_camera *camera);
/** The shape under x, y: one ray is traced. */
struct stage_pick traced_pick(struct traced *traced, const struct view_camera *camera, float x,
                              float y);
/** What the pixel at x, y, 0 to 1 from the left and the top, has and wants. NULL: unknown, or it
 * has no texture. */
const struct TracedView *traced_view_at(const struct traced *traced, float x, float y);
/** Picture of a texture of the loader by its index, or UINT32_MAX. */
uint32_t traced_picture_of(const struct traced *traced, uint32_t texture);
/** Part of the pixels of the last launches that lack nothing. */
double traced_complete(const struct traced *traced);
/** Pictures that rays asked for and that are not open, as of the last looks at them. */
uint32_t traced_opening_count(const struct traced *traced);
/** Bytes of device memory beside the loader's: meshes, their structures, materials. */
uint64_t traced_geometry_size(const struct traced *traced);

/** Of a picture that is open; NULL otherwise. Any thread. */
SluiceImageSource *traced_borrow_source(const struct traced *traced, uint32_t picture);
void traced_return_source(const struct traced *traced, uint32_t picture, SluiceImageSource *source);

/** traced_facts.c: keeps what the last launch missed. */
void traced_note_misses(struct traced *traced);
/** Figures of the loader under the names of the streamer's. */
void traced_facts_update(struct traced *traced, struct view_facts *facts);
/** A sentence: why is this texture, or what was picked, not sharper? Returns `text`. `*good`: it is
 *  as sharp as it gets. */
const char *traced_explain(const struct traced *traced, uint32_t picture, bool *good, char *text,
                           size_t size);

#endif /* SLUICE_VIEW_TRACED_H */
