#include "statistics.h"

#include <stdio.h>

#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"

typedef unsigned long long count;

static void write_geometry(FILE *f, const struct world *w)
{
    const struct meshes *m = &w->meshes;
    fprintf(f,
            "  \"geometryCache\": {\"numTraversables\": %llu, \"numTriangles\": %llu, "
            "\"numSpheres\": 0, \"numNormals\": %llu, \"numUVs\": %llu, \"totalBytesRead\": %llu, "
            "\"totalReadTime\": %.6f},\n",
            (count)m->built_count, (count)m->triangle_count, (count)m->normal_count,
            (count)m->uv_count, (count)m->bytes_read, m->read_seconds);
    fprintf(f,
            "  \"geometry\": {\"numProxyGeometriesResolved\": %llu, \"numGeometriesRealized\": "
            "%llu},\n",
            (count)w->resolved_count, (count)m->built_count);
}

/* Counts each picture as one source, whatever its use. */
static void write_pictures(FILE *f, const struct launches *l)
{
    static const char *const others[] = {"alphaSources", "diffuseSources", "skyboxSources"};
    SluiceDemandStatistics d = {.structSize = sizeof d};
    (void)sluiceGetDemandStatistics(l->loader, &d); /* leaves zeros on failure */
    fprintf(f,
            "  \"imageSourceFactory\": {\n    \"fileSources\": {\"numImageSources\": %llu, "
            "\"totalTilesRead\": %llu, \"totalBytesRead\": %llu, \"totalReadTime\": null}",
            (count)d.texturesOpened, (count)l->tile_count, (count)d.bytesRead);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        fprintf(f,
                ",\n    \"%s\": {\"numImageSources\": null, \"totalTilesRead\": null, "
                "\"totalBytesRead\": null, \"totalReadTime\": null}",
                others[i]);
    fputs("\n  },\n", f);
}

static void write_boxes(FILE *f, const struct world *w)
{
    const uint64_t *created = w->created;
    uint64_t all = 0;
    for (int i = 0; i < WORLD_BOX_KINDS; i++)
        all += created[i];
    fprintf(f,
            "  \"proxyFactory\": {\"numSceneProxiesCreated\": %llu, \"numShapeProxiesCreated\": "
            "%llu, \"numInstanceProxiesCreated\": %llu, \"numInstanceShapeProxiesCreated\": %llu, "
            "\"numInstancePrimitiveProxiesCreated\": %llu, \"numGeometryProxiesCreated\": %llu},\n",
            (count)created[BOX_SCENE], (count)created[BOX_FREE_SHAPE], (count)created[BOX_INSTANCE],
            (count)created[BOX_INSTANCE_SHAPE], (count)created[BOX_GROUP], (count)all);
}

/** Counts the shapes in the world that use another shape's material. */
static uint64_t count_reused(const struct launches *l)
{
    const struct world *w = l->world;
    uint64_t with_material = 0;
    for (uint32_t i = 0; i < w->place_count; i++) {
        const struct PbrtPlace *place = table_at(&w->place_table, i);
        const struct PbrtSurface *surface = table_at(&l->surfaces->table, place->surface);
        with_material += w->places[i].live && surface->realized;
    }
    const uint64_t made = l->surfaces->material_realized_count;
    return with_material > made ? with_material - made : 0;
}

static void write_materials(FILE *f, const struct launches *l)
{
    const struct surfaces *s = l->surfaces;
    fprintf(f,
            "  \"materials\": {\"numPartialMaterialsRealized\": %llu, \"numMaterialsRealized\": "
            "%llu, \"numMaterialsReused\": %llu, \"numProxyMaterialsCreated\": %llu},\n",
            (count)s->alpha_realized_count, (count)s->material_realized_count,
            (count)count_reused(l),
            l->proxies ? (count)l->scene->info.materialCount + l->scene->info.textureCount : 0);
}

static void write_scene(FILE *f, const struct scene *scene, const char *path)
{
    uint64_t of_objects = 0;
    for (uint32_t i = 0; i < scene->info.objectCount; i++) {
        SluicePbrtObject object = {0};
        (void)sluiceGetPbrtObject(scene->pbrt, i, &object);
        of_objects += object.shapeCount;
    }
    fputs("  \"scene\": {\"fileName\": ", f);
    text_write_json(f, path);
    fprintf(f,
            ", \"parseTime\": %.6f, \"numFreeShapes\": %llu, \"numObjects\": %u, "
            "\"numObjectShapes\": %llu, \"numObjectInstances\": %u}\n",
            scene->parse_seconds, (count)(scene->info.shapeCount - of_objects),
            scene->info.objectCount, (count)of_objects, scene->info.instanceCount);
}

bool statistics_write(const struct launches *l, const char *scene_path, const char *path)
{
    struct output_file *output = output_file_begin(path);
    if (!output)
        return false;
    FILE *f = output_file_stream(output);
    fprintf(f, "{\n  \"numFramesRendered\": %u,\n", l->count);
    write_geometry(f, l->world);
    write_pictures(f, l);
    write_boxes(f, l->world);
    write_materials(f, l);
    write_scene(f, l->scene, scene_path);
    fputs("}\n", f);
    return output_file_end(output, true);
}
