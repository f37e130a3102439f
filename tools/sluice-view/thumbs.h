/** Small pictures of the textures, from coarse levels of their sources, read on a thread. */
#ifndef SLUICE_VIEW_THUMBS_H
#define SLUICE_VIEW_THUMBS_H

#include "thumb_texels.h"
#include "ui_texels.h"

#include <pthread.h>
#include <stdatomic.h>

#define THUMBS_COLUMNS 32u
#define THUMBS_MOST (THUMBS_COLUMNS * THUMBS_COLUMNS) ///< textures behind have none

struct stage;

struct thumbs {
    const struct gpu *gpu;     ///< borrowed
    const struct stage *stage; ///< borrowed; NULL: nothing was begun
    uint32_t count;
    uint8_t *pixels;          ///< owned; RGBA8, cells in rows of THUMBS_COLUMNS
    bool *known;              ///< owned; by texture
    struct thumb_texels *raw; ///< owned; by texture: texels that the device has to convert
    uint32_t next_raw;        ///< where to look for some first
    bool threaded;
    pthread_t thread;
    pthread_mutex_t lock; ///< of pixels, known and raw
    atomic_bool stop;
    atomic_uint changes;
    unsigned shown; ///< changes that the image has
    uint64_t next;  ///< frame in which the image may change again
    struct ui_texels texels;
};

/** Begins to read. `wait`: all are there when it returns. Does nothing if it has begun. */
void thumbs_begin(struct thumbs *thumbs, const struct gpu *gpu, const struct stage *stage,
                  bool wait);
/** Once per frame, outside a render pass: takes what was read into the image. */
void thumbs_record(struct thumbs *thumbs, uint64_t frame, VkCommandBuffer commands);
/** Ends the thread, before the stage is destroyed. No frame may be in flight. */
void thumbs_end(struct thumbs *thumbs);
/** Corners of a texture's cell in the image: left, top, right, bottom. False if there is none. */
bool thumbs_find(struct thumbs *thumbs, uint32_t texture, float uv[4]);

#endif /* SLUICE_VIEW_THUMBS_H */
