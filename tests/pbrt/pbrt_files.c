#define _XOPEN_SOURCE 700

#include "pbrt/pbrt_files.h"

#include "support/test.h"

#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void pbrt_files_init(struct pbrt_files *files)
{
    *files = (struct pbrt_files){.log_size = 0};
    const char *tmp = getenv("TMPDIR");
    snprintf(files->folder, sizeof files->folder, "%s/sluice-pbrt-XXXXXX", tmp ? tmp : "/tmp");
    assert_non_null(mkdtemp(files->folder));
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *depth)
{
    (void)status, (void)kind, (void)depth;
    chmod(path, S_IRWXU); /* archives may hold folders that cannot be written */
    return remove(path) != 0;
}

void pbrt_files_finish(struct pbrt_files *files)
{
    sluiceDestroyPbrtScene(files->scene);
    nftw(files->folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

const char *pbrt_path(const struct pbrt_files *files, const char *name)
{
    static char path[600];
    snprintf(path, sizeof path, "%s/%s", files->folder, name);
    return path;
}

void pbrt_write(struct pbrt_files *files, const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(pbrt_path(files, name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void keep(void *user, SluiceLogSeverity severity, const char *message)
{
    struct pbrt_files *files = user;
    files->warnings += severity == SLUICE_LOG_WARNING;
    files->errors += severity == SLUICE_LOG_ERROR;
    size_t room = sizeof files->log - files->log_size;
    int size = snprintf(files->log + files->log_size, room, "%s\n", message);
    if (size > 0 && (size_t)size < room)
        files->log_size += (size_t)size;
}

SluiceResult pbrt_open(struct pbrt_files *files, const char *path)
{
    SluicePbrtSceneCreateInfo info = {.structSize = sizeof info,
                                      .pPath = path,
                                      .pAllocator = files->allocator,
                                      .log = {files, keep}};
    sluiceDestroyPbrtScene(files->scene);
    files->scene = NULL;
    files->log_size = files->warnings = files->errors = 0;
    files->log[0] = 0;
    return sluiceOpenPbrtScene(&info, &files->scene);
}

SluiceResult pbrt_open_text(struct pbrt_files *files, const char *text)
{
    pbrt_write(files, "scene.pbrt", text, strlen(text));
    return pbrt_open(files, pbrt_path(files, "scene.pbrt"));
}

SluicePbrtSceneInfo pbrt_info(const struct pbrt_files *files)
{
    SluicePbrtSceneInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetPbrtSceneInfo(files->scene, &info));
    return info;
}

SluicePbrtShape pbrt_shape(const struct pbrt_files *files, uint32_t index)
{
    SluicePbrtShape shape = {.structSize = sizeof shape};
    CHECK_OK(sluiceGetPbrtShape(files->scene, index, &shape));
    return shape;
}

SluicePbrtMaterial pbrt_material(const struct pbrt_files *files, uint32_t index)
{
    SluicePbrtMaterial material = {.structSize = sizeof material};
    CHECK_OK(sluiceGetPbrtMaterial(files->scene, index, &material));
    return material;
}

static void check_numbers(const float *numbers, size_t count)
{
    for (size_t i = 0; numbers && i < count; i++)
        assert_true(isfinite(numbers[i]));
}

/* All vertices lie in the bounds, rounding aside. */
static void check_bounds(const struct pbrt_files *files, uint32_t index, const SluicePbrtMesh *mesh,
                         const SluicePbrtBounds *bounds)
{
    SluicePbrtShape shape = pbrt_shape(files, index);
    for (uint32_t i = 0; i < mesh->vertexCount; i++)
        for (int row = 0; row < 3; row++) {
            const float *m = &shape.transform[4 * row], *p = &mesh->pPositions[3 * (size_t)i];
            double x = (double)m[0] * p[0] + (double)m[1] * p[1] + (double)m[2] * p[2] + m[3];
            double size = fabs(m[0] * p[0]) + fabs(m[1] * p[1]) + fabs(m[2] * p[2]) + fabs(m[3]);
            assert_true(x >= bounds->least[row] - 1e-5 * size &&
                        x <= bounds->most[row] + 1e-5 * size);
        }
}

uint32_t pbrt_read_all(struct pbrt_files *files)
{
    uint32_t count = pbrt_info(files).shapeCount, good = 0;
    for (uint32_t i = 0; i < count; i++) {
        SluicePbrtMesh mesh = {.structSize = sizeof mesh};
        SluicePbrtBounds bounds;
        SluiceResult bounded = sluiceGetPbrtShapeBounds(files->scene, i, &bounds);
        SluiceResult read = sluiceReadPbrtShape(files->scene, i, &mesh);
        if (bounded == SLUICE_SUCCESS) {
            check_numbers(bounds.least, 3);
            check_numbers(bounds.most, 3);
        }
        if (read == SLUICE_SUCCESS) {
            CHECK_OK(bounded);
            assert_true(mesh.triangleCount > 0);
            check_numbers(mesh.pPositions, 3 * (size_t)mesh.vertexCount);
            check_numbers(mesh.pNormals, 3 * (size_t)mesh.vertexCount);
            check_numbers(mesh.pUvs, 2 * (size_t)mesh.vertexCount);
            for (size_t j = 0; j < 3 * (size_t)mesh.triangleCount; j++)
                assert_true(mesh.pIndices[j] < mesh.vertexCount);
            check_bounds(files, i, &mesh, &bounds);
            good++;
        }
        sluiceFreePbrtMesh(files->scene, &mesh);
    }
    return good;
}

bool pbrt_sample_path(char path[1024], const char *name)
{
    const char *data = getenv("SLUICE_TEST_DATA"), *root = getenv("SLUICE_SOURCE_ROOT");
    if (data)
        snprintf(path, 1024, "%s/pbrt/%s", data, name);
    else
        snprintf(path, 1024, "%s/../shared/data/pbrt/%s", root ? root : ".", name);
    return access(path, R_OK) == 0;
}

bool pbrt_unpack(const struct pbrt_files *files, const char *archive)
{
    char command[2048];
    snprintf(command, sizeof command, "tar -xJf '%s' -C '%s' --no-same-permissions", archive,
             files->folder);
    return system(command) == 0;
}
