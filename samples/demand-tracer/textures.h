/** What is on the scene's surfaces: files, or pictures that are computed. Nothing is opened here.
 */
#ifndef TRACER_TEXTURES_H
#define TRACER_TEXTURES_H

#include <sluice/demand.h>
#include <sluice/exr.h>

#include "../../tools/common/files.h"
#include "options.h"
#include "patterns.h"

/** One image behind one texture. */
struct texture {
    const char *path;              ///< NULL: a pattern; borrowed from the list of files
    struct pattern pattern;        ///< else
    uint32_t size;                 ///< of a pattern, texels
    SluiceExrMemoryBudget *memory; ///< of all textures
    SluiceResult refusal;          ///< of a file that will never be opened
    SluiceDemandTextureId id;
};

/** Zeroed is empty. */
struct textures {
    struct texture *items; ///< owned; its address is known to the loader
    uint32_t count;
    uint32_t *of_scene; ///< owned; index in `items` of each texture of the scene
    uint32_t scene_count;
    struct file_list files;
    SluiceExrMemoryBudget *memory;
    uint64_t virtual_size; ///< bytes of all levels of all patterns
};

/** Creates a texture for each of the scene's. Says on stderr why it failed. */
bool textures_create(const struct tracer_options *options, SluiceDemandLoader *loader,
                     struct textures *textures);
/** After the loader. */
void textures_finish(struct textures *textures);

/** The shader's index of texture `index` of the scene. */
uint32_t textures_index(const struct textures *textures, uint32_t index);

#endif /* TRACER_TEXTURES_H */
