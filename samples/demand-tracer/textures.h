/** What is on the scene's surfaces: files, or pictures that are computed. Nothing is opened here.
 */
#ifndef TRACER_TEXTURES_H
#define TRACER_TEXTURES_H

#include <sluice/demand.h>
#include <sluice/exr.h>

#include "../../tools/common/files.h"
#include "../common/shared_source.h"
#include "options.h"
#include "patterns.h"

/** One image behind one texture of each loader. */
struct texture {
    const char *path;              ///< NULL: a pattern; borrowed from the list of files
    struct pattern pattern;        ///< else
    uint32_t size;                 ///< of a pattern, texels
    SluiceExrMemoryBudget *memory; ///< of all textures
    SluiceResult refusal;          ///< of a file that will never be opened
    struct shared_source shared;   ///< of all loaders
};

/** Zeroed is empty. */
struct textures {
    struct texture *items; ///< owned; its address is known to the loaders
    uint32_t count;
    uint32_t *of_scene; ///< owned; index in `items` of each texture of the scene
    uint32_t scene_count;
    struct file_list files;
    SluiceExrMemoryBudget *memory;
    uint64_t virtual_size; ///< bytes of all levels of all patterns
};

/** Chooses an image for each of the scene's textures. Says on stderr why it failed. */
bool textures_create(const struct tracer_options *options, struct textures *textures);
/** After all loaders. */
void textures_finish(struct textures *textures);

/** Adds a texture to a loader for each image; `ids` gets its id. Says on stderr why it failed. */
bool textures_add(const struct tracer_options *options, struct textures *textures,
                  SluiceDemandLoader *loader, SluiceDemandTextureId *ids);
/** The shader's index of texture `index` of the scene, with the ids of its loader. */
uint32_t textures_index(const struct textures *textures, const SluiceDemandTextureId *ids,
                        uint32_t index);

#endif /* TRACER_TEXTURES_H */
