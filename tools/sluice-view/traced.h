/** A pbrt scene on a device: rays request missing pages from a demand loader. */
#ifndef SLUICE_VIEW_TRACED_H
#define SLUICE_VIEW_TRACED_H

#include "scene_pbrt.h"
#include "stage.h"
#include "traced_parts.h"

#include "../../samples/demand-pbrt/flight.h"

#include <sluice/demand_query.h>

#define TRACED_FRAME_SECONDS 0.03 ///< seconds per frame for pages that rays requested
#define TRACED_EVENTS 1024u
#define TRACED_MISSES 1024u

struct view_facts;

/** A page that a launch requested, or that could not be read. */
struct traced_event {
    uint64_t launch;
    uint32_t picture; ///< UINT32_MAX: unknown
    SluiceDemandMissKind kind;
    uint32_t level, x, y; ///< level, column and row of a tile
};

struct traced_picture {
    struct stage_texture texture; ///< name at first; all else once the picture is open
    SluiceDemandTextureId id;     ///< 0: no ray has requested it
    uint32_t tile_count, resident_count, pending_count, refused_count;
    uint32_t arrived, left; ///< tiles loaded and evicted, as far as `tiles` shows
    uint32_t asked;         ///< openings, tiles and mip tails that launches missed
    uint32_t finest;        ///< finest level with resident tiles; UINT32_MAX: none
    /** File of the picture, once open. Other threads may read it. */
    _Atomic(struct picture_file *) file;
};

struct traced {
    const struct gpu *gpu; ///< borrowed
    struct scene_pbrt *pbrt;
    struct pbrt_options options;
    struct view_settings settings; ///< settings applied last
    bool waits;                    ///< each frame waits for all its loads
    struct traced_parts *parts;    ///< owned
    SluiceVulkanContext *context;  ///< owned by `parts`, as is the loader
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
    bool looks;                  ///< launches write a TracedView per pixel
    bool looked;                 ///< the last launch wrote them
    uint32_t rays;               ///< number of this frame's last launch that traced rays; 0: none
    uint64_t time;               ///< microseconds; time stamp of the last frame
    uint32_t use_count;          ///< uses of pictures listed in `parts->show.pictures`
    uint32_t most_texture_index; ///< largest texture index of these uses
    struct PbrtLaunch constants; ///< constants of the picture that is accumulated
    uint32_t sample;             ///< sample that is traced; earlier samples are complete
    uint32_t missing;            ///< pixels without this sample after the last launch
    uint32_t vain;               ///< launches in a row without progress
    float lod_bias;              ///< LOD bias of the picture that is accumulated
    bool restarts;
    double trace_seconds; ///< duration of the last frame's launches
    SluiceDemandTicket ticket;
    struct traced_picture *pictures; ///< owned
    uint32_t picture_count;
    uint32_t next_picture; ///< picture whose figures are read next
    SluiceDemandStatistics now, before;
    uint32_t miss_count;           ///< listed misses of the last launch
    uint32_t pages[TRACED_MISSES]; ///< pages of these misses, ascending
    struct traced_event events[TRACED_EVENTS];
    uint32_t event_count, event_next;
    char picked[256]; ///< description of the surface that traced_pick found
};

/** Creates a traced scene, and takes `pbrt`. NULL, with a line on stderr, on failure. */
struct traced *traced_create(const struct stage_request *request,
                             const struct view_settings *settings, struct scene_pbrt *pbrt);
void traced_destroy(struct traced *traced);
/** Traces rays and waits for them. Puts the view of the picture into `end`. Records a copy if
 *  `draw->copy` is set. */
bool traced_record(struct traced *traced, const struct stage_draw *draw, VkCommandBuffer commands,
                   struct frames_end *end);
/** Traces and shows one picture without serving its requests. Makes the driver compile programs. */
bool traced_trace_once(struct traced *traced, const struct stage_draw *draw);
void traced_apply(struct traced *traced, const struct view_settings *settings);
/** Returns the constants of a launch for a camera of the viewer. */
struct PbrtLaunch traced_constants(struct traced *traced, const struct view_camera *camera);
/** Finds the shape under x, y by tracing one ray. */
struct stage_pick traced_pick(struct traced *traced, const struct view_camera *camera, float x,
                              float y);
/** Returns resident and wanted level of the pixel at x, y, 0 to 1 from the left and the top. NULL:
 *  unknown, or the pixel has no texture. */
const struct TracedView *traced_view_at(const struct traced *traced, float x, float y);
/** Returns the picture of the loader's texture `texture`; UINT32_MAX: none. */
uint32_t traced_picture_of(const struct traced *traced, uint32_t texture);
/** Part of the pixels that are complete after the last launches, 0 to 1. */
double traced_complete(const struct traced *traced);
/** Number of pictures that rays requested and that are not open yet. */
uint32_t traced_opening_count(const struct traced *traced);
/** Bytes of device memory for meshes, acceleration structures and materials. Excludes the memory
 *  of the loader. */
uint64_t traced_geometry_size(const struct traced *traced);

/** Lends the source of an open picture; NULL otherwise. Any thread. */
SluiceImageSource *traced_borrow_source(const struct traced *traced, uint32_t picture);
void traced_return_source(const struct traced *traced, uint32_t picture, SluiceImageSource *source);

/** Keeps the misses of the last launch (traced_facts.c). */
void traced_note_misses(struct traced *traced);
/** Writes the loader's figures into the fields of the streamer's figures. */
void traced_facts_update(struct traced *traced, struct view_facts *facts);
/** Writes one sentence: why the picture, or the picked surface, is not sharper. Returns `text`.
 *  `*good`: the surface is as sharp as it can be. */
const char *traced_explain(const struct traced *traced, uint32_t picture, bool *good, char *text,
                           size_t size);

#endif /* SLUICE_VIEW_TRACED_H */
