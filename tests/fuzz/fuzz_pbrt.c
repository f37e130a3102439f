/*
 * Any bytes as the text of a pbrt scene: an error, or a scene all of whose shapes can be read or
 * fail. With clang:
 *
 *     CC=clang meson setup BUILD -Db_sanitize=address,undefined -Db_lundef=false \
 *         -Dc_args=-fsanitize=fuzzer-no-link
 *     ninja -C BUILD tests/pbrt/fuzz_pbrt_libfuzzer
 *     BUILD/tests/pbrt/fuzz_pbrt_libfuzzer -max_len=4000 tests/fuzz/corpus/pbrt
 *
 * In the ordinary test run standalone.c plays the corpus.
 */
#define _POSIX_C_SOURCE 200809L

#include <sluice/pbrt.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void read_shapes(SluicePbrtScene *scene)
{
    SluicePbrtSceneInfo info = {.structSize = sizeof info};
    if (sluiceGetPbrtSceneInfo(scene, &info))
        abort();
    for (uint32_t i = 0; i < info.shapeCount && i < 64; i++) {
        SluicePbrtMesh mesh = {.structSize = sizeof mesh};
        SluicePbrtShape shape = {.structSize = sizeof shape};
        SluicePbrtBounds bounds;
        if (sluiceGetPbrtShape(scene, i, &shape) || shape.material >= info.materialCount)
            abort();
        sluiceGetPbrtShapeBounds(scene, i, &bounds);
        if (sluiceReadPbrtShape(scene, i, &mesh) == SLUICE_SUCCESS)
            for (size_t j = 0; j < 3 * (size_t)mesh.triangleCount; j++)
                if (mesh.pIndices[j] >= mesh.vertexCount)
                    abort();
        if (sluiceFreePbrtMesh(scene, &mesh))
            abort();
    }
    for (uint32_t i = 0; i < info.materialCount; i++) {
        SluicePbrtMaterial material = {.structSize = sizeof material};
        if (sluiceGetPbrtMaterial(scene, i, &material))
            abort();
        for (int j = 0; j < 2 && material.kind == SLUICE_PBRT_MATERIAL_MIX; j++)
            if (material.materials[j] >= info.materialCount)
                abort();
    }
    for (uint32_t i = 0; i < info.textureCount; i++) {
        SluicePbrtTexture texture = {.structSize = sizeof texture};
        if (sluiceGetPbrtTexture(scene, i, &texture))
            abort();
    }
}

static const char *scene_path(void)
{
    static char path[64];
    snprintf(path, sizeof path, "/tmp/sluice-fuzz-%ld.pbrt", (long)getpid());
    return path;
}

static void remove_scene(void)
{
    unlink(scene_path());
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static bool is_set_up;
    SluicePbrtSceneCreateInfo info = {.structSize = sizeof info,
                                      .pPath = scene_path(),
                                      .maxIncludeCount = 16,
                                      .maxTextSize = 1 << 22,
                                      .maxMeshSize = 1 << 24};
    SluicePbrtScene *scene;
    if (!is_set_up)
        atexit(remove_scene);
    is_set_up = true;
    FILE *file = fopen(info.pPath, "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0)
        abort();
    if (sluiceOpenPbrtScene(&info, &scene) == SLUICE_SUCCESS) {
        read_shapes(scene);
        sluiceDestroyPbrtScene(scene);
    }
    return 0;
}
