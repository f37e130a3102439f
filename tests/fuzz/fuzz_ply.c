/*
 * Any bytes as a PLY file: an error, or bounds and triangles that fit together. With clang:
 *
 *     CC=clang meson setup BUILD -Db_sanitize=address,undefined -Db_lundef=false \
 *         -Dc_args=-fsanitize=fuzzer-no-link
 *     ninja -C BUILD tests/pbrt/fuzz_ply_libfuzzer
 *     BUILD/tests/pbrt/fuzz_ply_libfuzzer -max_len=2000 tests/fuzz/corpus/ply
 *
 * In the ordinary test run standalone.c plays the corpus.
 */
#define _POSIX_C_SOURCE 200809L

#include "base/alloc.h"
#include "pbrt/ply_reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char *ply_path(void)
{
    static char path[64];
    snprintf(path, sizeof path, "/tmp/sluice-fuzz-%ld.ply", (long)getpid());
    return path;
}

static void remove_ply(void)
{
    unlink(ply_path());
}

/* Vertices lie in the bounds, and indices are those of vertices. */
static void check_mesh(const SluicePbrtMesh *mesh, const SluicePbrtBounds *bounds)
{
    for (uint32_t i = 0; i < mesh->vertexCount; i++)
        for (int j = 0; j < 3; j++) {
            float x = mesh->pPositions[3 * (size_t)i + (size_t)j];
            if (!(x >= bounds->least[j] && x <= bounds->most[j]))
                abort();
        }
    for (size_t i = 0; i < 3 * (size_t)mesh->triangleCount; i++)
        if (mesh->pIndices[i] >= mesh->vertexCount)
            abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static bool is_set_up;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_pbrt_ply_trouble trouble;
    struct slc_pbrt_stamp stamp;
    SluicePbrtBounds bounds;
    SluicePbrtMesh mesh;
    if (!is_set_up)
        atexit(remove_ply);
    is_set_up = true;
    FILE *file = fopen(ply_path(), "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0)
        abort();
    SluiceResult bounded = slc_pbrt_ply_read_bounds(ply_path(), &cb, &bounds, &stamp, &trouble);
    SluiceResult read = slc_pbrt_ply_read_mesh(ply_path(), &cb, 1 << 24, &mesh, &trouble);
    if (read == SLUICE_SUCCESS) {
        if (bounded != SLUICE_SUCCESS)
            abort();
        check_mesh(&mesh, &bounds);
        slc_pbrt_free_mesh(&cb, &mesh);
    }
    return 0;
}
