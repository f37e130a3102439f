/** Textures of the scene: picture files or procedural patterns. Opens no files itself. */
#ifndef TRACER_TEXTURES_H
#define TRACER_TEXTURES_H

#include <sluice/demand.h>
#include <sluice/exr.h>

#include "../../tools/common/files.h"
#include "../common/shared_source.h"
#include "options.h"
#include "patterns.h"

/** An image. It has one texture in each loader. */
struct texture {
    const char *path;              ///< NULL: a pattern; borrowed from the list of files
    struct pattern pattern;        ///< used if `path` is NULL
    uint32_t size;                 ///< size of a pattern in texels
    SluiceExrMemoryBudget *memory; ///< shared by all textures
    SluiceResult refusal;          ///< error of a file that can never be opened
    struct shared_source shared;   ///< shared by all loaders
};

/** Zeroed is empty. */
struct textures {
    struct texture *items; ///< owned; loaders keep the elements' addresses
    uint32_t count;
    uint32_t *of_scene; ///< owned; index in `items` by texture of the scene
    uint32_t scene_count;
    struct file_list files;
    SluiceExrMemoryBudget *memory;
    uint64_t virtual_size; ///< bytes of all levels of all patterns
};

/** Chooses an image for each of the scene's textures. Reports errors on stderr. */
bool textures_create(const struct tracer_options *options, struct textures *textures);
/** Call after all loaders are destroyed. */
void textures_finish(struct textures *textures);

/** Adds a texture per image to a loader, and writes their ids to `ids`. Reports errors on
 * stderr. */
bool textures_add(const struct tracer_options *options, struct textures *textures,
                  SluiceDemandLoader *loader, SluiceDemandTextureId *ids);
/** Returns the shader's index of the scene's texture `index`, from the ids of its loader. */
uint32_t textures_index(const struct textures *textures, const SluiceDemandTextureId *ids,
                        uint32_t index);

#endif /* TRACER_TEXTURES_H */
