/*
 * How fast pbrt scenes are opened, and what memory that takes.
 *
 *     pbrt_figures [options] FOLDER
 *
 * FOLDER takes scenes that are made here and removed at the end. They are in the page cache. One
 * thread. The ratio beside the text is to counting the lines of the same file, read in blocks of
 * 128 KiB, in the same run.
 */
#define _XOPEN_SOURCE 700

#include "../../tools/common/clock.h"
#include "../../tools/common/shared_options.h"

#include <sluice/pbrt.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ROUNDS = 5 };

static struct {
    bool json, quick;
    const char *folder;
    size_t live, peak; ///< bytes of the scene
} run;

static void figure(const char *name, double value, const char *unit)
{
    if (run.json)
        printf("{\"name\": \"%s\", \"value\": %.6g, \"unit\": \"%s\"}\n", name, value, unit);
    else
        printf("%-40s %12.6g %s\n", name, value, unit);
}

static void fail(const char *what)
{
    fprintf(stderr, "pbrt_figures: %s failed\n", what);
    exit(1);
}

static const char *path_of(const char *name)
{
    static char path[1024];
    snprintf(path, sizeof path, "%s/%s", run.folder, name);
    return path;
}

static FILE *create(const char *name)
{
    FILE *file = fopen(path_of(name), "wb");
    if (!file)
        fail("making a file");
    return file;
}

/* Memory */

static void *allocate(void *user, size_t size, size_t alignment)
{
    (void)user, (void)alignment;
    run.live += size;
    run.peak = run.live > run.peak ? run.live : run.peak;
    return malloc(size);
}

static void release(void *user, void *memory, size_t size)
{
    (void)user;
    run.live -= size;
    free(memory);
}

/* Files */

/* A sheet of triangles with positions, normals, texture coordinates and indices as text. */
static void write_text(uint32_t vertices)
{
    FILE *file = create("text.pbrt");
    fputs("WorldBegin\nShape \"trianglemesh\"\n\"point P\" [\n", file);
    for (uint32_t i = 0; i < vertices; i++)
        fprintf(file, "%.7g %.7g %.7g\n", i * 0.0123457, i * -0.3333331, 1.0 / (i + 1));
    fputs("]\n\"normal N\" [\n", file);
    for (uint32_t i = 0; i < vertices; i++)
        fprintf(file, "%.7g %.7g %.7g\n", sin(i), cos(i), 0.25);
    fputs("]\n\"point2 uv\" [\n", file);
    for (uint32_t i = 0; i < vertices; i++)
        fprintf(file, "%.7g %.7g\n", i / (double)vertices, 1 - i / (double)vertices);
    fputs("]\n\"integer indices\" [\n", file);
    for (uint32_t i = 0; i + 2 < vertices; i++)
        fprintf(file, "%u %u %u\n", i, i + 1, i + 2);
    fputs("]\n", file);
    fclose(file);
}

static void write_instances(uint32_t count)
{
    FILE *file = create("instances.pbrt");
    fputs("WorldBegin\nObjectBegin \"tree\"\nShape \"sphere\"\nObjectEnd\n", file);
    for (uint32_t i = 0; i < count; i++)
        fprintf(file,
                "AttributeBegin\nConcatTransform [ %.6g 0 0 0 0 1 0 0 0 0 1 0 %.6g %.6g 0 1 ]\n"
                "ObjectInstance \"tree\"\nAttributeEnd\n",
                1 + i * 1e-6, i * 0.25, i * 0.125);
    fclose(file);
}

static void write_ply(uint32_t vertices)
{
    FILE *file = create("mesh.ply");
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\nelement vertex %u\nproperty float x\n"
            "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
            "property float nz\nelement face %u\nproperty list uchar int vertex_indices\n"
            "end_header\n",
            vertices, vertices);
    for (uint32_t i = 0; i < vertices; i++) {
        float v[6] = {(float)i, (float)i * 0.5f, 1, 0, 0, 1};
        fwrite(v, sizeof *v, 6, file);
    }
    for (uint32_t i = 0; i < vertices; i++) {
        int32_t face[3] = {(int32_t)i, (int32_t)((i + 1) % vertices), 0};
        fputc(3, file);
        fwrite(face, sizeof *face, 3, file);
    }
    fclose(file);
    file = create("ply.pbrt");
    fputs("WorldBegin\nShape \"plymesh\" \"string filename\" \"mesh.ply\"\n", file);
    fclose(file);
}

/* Figures */

static double file_size(const char *name)
{
    FILE *file = fopen(path_of(name), "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0)
        fail("looking at a file");
    double size = (double)ftell(file);
    fclose(file);
    return size;
}

static double count_lines(const char *name)
{
    static char bytes[1 << 17];
    volatile size_t lines = 0;
    double start = clock_seconds();
    FILE *file = fopen(path_of(name), "rb");
    if (!file)
        fail("reading a file");
    setvbuf(file, NULL, _IONBF, 0);
    for (size_t got; (got = fread(bytes, 1, sizeof bytes, file)) > 0;)
        for (char *at = bytes; (at = memchr(at, '\n', (size_t)(bytes + got - at))); at++)
            lines++;
    fclose(file);
    return clock_seconds() - start;
}

static SluicePbrtScene *open_scene(const char *name, double *seconds)
{
    SluiceAllocationCallbacks cb = {NULL, allocate, release};
    SluicePbrtSceneCreateInfo info = {
        .structSize = sizeof info, .pPath = path_of(name), .pAllocator = &cb};
    SluicePbrtScene *scene;
    run.live = run.peak = 0;
    double start = clock_seconds();
    if (sluiceOpenPbrtScene(&info, &scene) != SLUICE_SUCCESS)
        fail("opening a scene");
    *seconds = clock_seconds() - start;
    return scene;
}

static void measure_text(void)
{
    double least = 1e9, lines = 1e9, read = 1e9, size = file_size("text.pbrt");
    for (int i = 0; i < ROUNDS; i++) {
        SluicePbrtMesh mesh = {.structSize = sizeof mesh};
        double seconds, counted = count_lines("text.pbrt");
        SluicePbrtScene *scene = open_scene("text.pbrt", &seconds);
        least = fmin(least, seconds);
        lines = fmin(lines, counted);
        double start = clock_seconds();
        if (sluiceReadPbrtShape(scene, 0, &mesh) != SLUICE_SUCCESS)
            fail("reading a mesh");
        read = fmin(read, clock_seconds() - start);
        sluiceFreePbrtMesh(scene, &mesh);
        sluiceDestroyPbrtScene(scene);
    }
    figure("text.size", size / 1e6, "MB");
    figure("text.open", size / 1e6 / least, "MB/s");
    figure("text.count_lines", size / 1e6 / lines, "MB/s");
    figure("text.open_per_count_lines", least / lines, "times");
    figure("text.read_mesh", size / 1e6 / read, "MB/s");
}

static void measure_instances(uint32_t count)
{
    double seconds = 0, least = 1e9;
    size_t live = 0, peak = 0;
    for (int i = 0; i < ROUNDS; i++) {
        SluicePbrtScene *scene = open_scene("instances.pbrt", &seconds);
        least = fmin(least, seconds);
        live = run.live;
        peak = run.peak;
        sluiceDestroyPbrtScene(scene);
    }
    figure("instances.count", count, "instances");
    figure("instances.open", least * 1e6 / count, "s per 10^6");
    figure("instances.text", file_size("instances.pbrt") / 1e6 / least, "MB/s");
    figure("instances.memory", (double)live / count, "B each");
    figure("instances.peak_memory", (double)peak / count, "B each");
}

static void measure_ply(void)
{
    double bounds = 1e9, read = 1e9, seconds, size = file_size("mesh.ply");
    for (int i = 0; i < ROUNDS; i++) {
        SluicePbrtScene *scene = open_scene("ply.pbrt", &seconds);
        SluicePbrtMesh mesh = {.structSize = sizeof mesh};
        SluicePbrtBounds box;
        double start = clock_seconds();
        if (sluiceGetPbrtShapeBounds(scene, 0, &box) != SLUICE_SUCCESS)
            fail("finding bounds");
        bounds = fmin(bounds, clock_seconds() - start);
        start = clock_seconds();
        if (sluiceReadPbrtShape(scene, 0, &mesh) != SLUICE_SUCCESS)
            fail("reading a PLY file");
        read = fmin(read, clock_seconds() - start);
        sluiceFreePbrtMesh(scene, &mesh);
        sluiceDestroyPbrtScene(scene);
    }
    figure("ply.size", size / 1e6, "MB");
    figure("ply.bounds", size * 24 / 37 / 1e6 / bounds, "MB/s of vertices");
    figure("ply.read", size / 1e6 / read, "MB/s");
}

static void remove_files(void)
{
    static const char *const NAMES[] = {"text.pbrt", "instances.pbrt", "ply.pbrt", "mesh.ply"};
    for (int i = 0; i < 4; i++)
        unlink(path_of(NAMES[i]));
}

int main(int argc, char **argv)
{
    const struct option options[] = {
        {OPTION_WORD, .value = &run.folder, .help = "a folder for the scenes", .minimum = 1},
        option_json(&run.json),
        {OPTION_FLAG, "quick", .value = &run.quick, .help = "small scenes"},
    };
    const struct option_table table = {"pbrt_figures",
                                       "usage: pbrt_figures [options] FOLDER\n\nMeasures how fast "
                                       "pbrt scenes are opened, and what "
                                       "memory that takes; a figure per line.\n",
                                       NULL, options, sizeof options / sizeof *options};
    enum option_outcome outcome = options_parse(&table, argc, argv);
    if (outcome != OPTIONS_RUN)
        return outcome == OPTIONS_HELP ? 0 : 2;
    atexit(remove_files);
    uint32_t instances = run.quick ? 10000 : 1000000;
    write_text(run.quick ? 20000 : 1000000);
    write_instances(instances);
    write_ply(run.quick ? 20000 : 2000000);
    measure_text();
    measure_instances(instances);
    measure_ply();
    return 0;
}
