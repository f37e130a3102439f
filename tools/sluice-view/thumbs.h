/** Small pictures of the textures. A thread reads them from coarse levels of the sources. */
#ifndef SLUICE_VIEW_THUMBS_H
#define SLUICE_VIEW_THUMBS_H

#include "thumb_texels.h"
#include "ui_texels.h"

#include <pthread.h>
#include <stdatomic.h>

#define THUMBS_COLUMNS 32u
#define THUMBS_MOST (THUMBS_COLUMNS * THUMBS_COLUMNS) ///< later textures have no picture

struct stage;

struct thumbs {
    const struct gpu *gpu;     ///< borrowed
    const struct stage *stage; ///< borrowed; NULL: nothing was begun
    uint32_t count;
    uint8_t *pixels;          ///< owned; RGBA8, cells in rows of THUMBS_COLUMNS
    bool *known;              ///< owned; by texture
    struct thumb_texels *raw; ///< owned; by texture: texels to be converted by the device
    uint32_t next_raw;        ///< first texture of the next search in `raw`
    bool threaded;
    pthread_t thread;
    pthread_mutex_t lock; ///< guards pixels, known and raw
    atomic_bool stop;
    atomic_uint changes;
    unsigned shown; ///< number of changes that the image contains
    uint64_t next;  ///< first frame in which the image may change again
    struct ui_texels texels;
};

/** Begins to read, unless reading has begun. `wait`: reads all pictures before it returns. */
void thumbs_begin(struct thumbs *thumbs, const struct gpu *gpu, const struct stage *stage,
                  bool wait);
/** Copies pictures that were read into the image. Call once per frame, outside a render pass. */
void thumbs_record(struct thumbs *thumbs, uint64_t frame, VkCommandBuffer commands);
/** Ends the thread. Call before the stage is destroyed. No frame may be in flight. */
void thumbs_end(struct thumbs *thumbs);
/** Writes the UVs of a texture's cell: left, top, right, bottom. False if it has no picture. */
bool thumbs_find(struct thumbs *thumbs, uint32_t texture, float uv[4]);

#endif /* SLUICE_VIEW_THUMBS_H */
