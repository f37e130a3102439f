/** Scenes in files of a folder of their own, and what is said while they are read. */
#ifndef TESTS_PBRT_PBRT_FILES_H
#define TESTS_PBRT_PBRT_FILES_H

#include <sluice/pbrt.h>

struct pbrt_files {
    char folder[256];
    char log[65536]; ///< all messages, one per line
    size_t log_size;
    uint32_t warnings, errors;
    const SluiceAllocationCallbacks *allocator; ///< NULL: malloc and free
    SluicePbrtScene *scene;
};

void pbrt_files_init(struct pbrt_files *files);
/** Closes the scene and removes the folder. */
void pbrt_files_finish(struct pbrt_files *files);

void pbrt_write(struct pbrt_files *files, const char *name, const void *bytes, size_t size);
/** The path of a file in the folder; valid until the next call. */
const char *pbrt_path(const struct pbrt_files *files, const char *name);

/** Opens a file of any folder. Closes the scene before. */
SluiceResult pbrt_open(struct pbrt_files *files, const char *path);
/** Writes "scene.pbrt" and opens it. */
SluiceResult pbrt_open_text(struct pbrt_files *files, const char *text);

SluicePbrtSceneInfo pbrt_info(const struct pbrt_files *files);
SluicePbrtShape pbrt_shape(const struct pbrt_files *files, uint32_t index);
SluicePbrtMaterial pbrt_material(const struct pbrt_files *files, uint32_t index);

/** Reads bounds and triangles of all shapes; checks that indices and numbers are in range. Returns
 *  how many shapes could be read. */
uint32_t pbrt_read_all(struct pbrt_files *files);

/** A path below the folder of sample files. False: it is not there. */
bool pbrt_sample_path(char path[1024], const char *name);

/** Unpacks an archive into the folder with the system's tar. False: tar failed. */
bool pbrt_unpack(const struct pbrt_files *files, const char *archive);

#endif /* TESTS_PBRT_PBRT_FILES_H */
