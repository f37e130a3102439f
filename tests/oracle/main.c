/* Casts rays through pbrt scenes that are loaded as a whole: see options.c. */
#include "oracle/options.h"
#include "oracle/output.h"

#include <stdio.h>
#include <stdlib.h>
#include <vips/vips.h>

static void figure(const struct oracle_options *options, const char *name, double value)
{
    if (options->json)
        printf("{\"name\": \"%s\", \"value\": %.9g}\n", name, value);
    else
        printf("%-24s %.9g\n", name, value);
}

static bool compare(const struct oracle_options *options, const struct oracle *o, const float *rgba)
{
    struct oracle_difference difference;
    if (!oracle_compare(options->compare, rgba, o->camera.width, o->camera.height, &difference))
        return false;
    figure(options, "flip", difference.flip);
    figure(options, "rms", difference.rms);
    figure(options, "equal_pixels", difference.equal);
    figure(options, "mean", difference.mean_a);
    figure(options, "other_mean", difference.mean_b);
    return true;
}

static bool make_picture(const struct oracle_options *options, const struct oracle *o)
{
    uint32_t width = o->camera.width, height = o->camera.height;
    float *rgba = calloc((size_t)width * height, 4 * sizeof *rgba);
    bool ok = rgba != NULL;
    if (ok)
        oracle_render(o, rgba);
    if (ok && options->file)
        ok = oracle_write(options->file, rgba, width, height);
    if (ok && options->compare)
        ok = compare(options, o, rgba);
    free(rgba);
    return ok;
}

static bool write_places(const char *path, const struct oracle *o,
                         const struct oracle_census *census)
{
    FILE *file = fopen(path, "w");
    if (file)
        fputs("shape\tinstance\tvisible\tentered\tbox\n", file);
    for (size_t i = 0; file && i < o->scene.place_count; i++) {
        const struct oracle_place *p = &o->scene.places[i];
        fprintf(file, "%u\t%d\t%u\t%u\t%.7g %.7g %.7g %.7g %.7g %.7g\n", p->shape,
                p->instance == SLUICE_PBRT_NONE ? -1 : (int)p->instance, census->is_visible[i],
                census->is_entered[i], p->box.least.x, p->box.least.y, p->box.least.z,
                p->box.most.x, p->box.most.y, p->box.most.z);
    }
    return file && fclose(file) == 0;
}

static void print_census(const struct oracle_options *options, const struct oracle *o,
                         const struct oracle_census *census)
{
    figure(options, "rays", (double)census->ray_count);
    figure(options, "rays_that_hit", (double)census->hit_count);
    figure(options, "shapes_placed", (double)census->count);
    figure(options, "shapes_visible",
           (double)oracle_census_count(census->is_visible, census->count));
    figure(options, "shapes_entered",
           (double)oracle_census_count(census->is_entered, census->count));
    figure(options, "materials_visible",
           (double)oracle_census_count(census->is_material_visible, o->scene.info.materialCount));
}

static void print_tiles(const struct oracle_options *options, const struct oracle_tiles *tiles)
{
    figure(options, "pictures", (double)tiles->picture_count);
    figure(options, "tiles_least", (double)oracle_tiles_count(tiles, ORACLE_TILE_SURE));
    figure(options, "tiles", (double)oracle_tiles_count(tiles, ORACLE_TILE_LIKELY));
    figure(options, "tiles_most", (double)oracle_tiles_count(tiles, ORACLE_TILE_MAYBE));
}

static bool count_hits(const struct oracle_options *options, struct oracle *o)
{
    struct oracle_census census;
    struct oracle_tiles tiles;
    bool ok = oracle_census_create(&census, &o->scene);
    ok &= oracle_tiles_create(&tiles, &o->scene, oracle_camera_spread(&o->camera));
    FILE *hits = options->hits ? fopen(options->hits, "w") : NULL;
    ok = ok && (hits || !options->hits);
    if (ok) {
        ok = oracle_cast(o, &census, options->tiles ? &tiles : NULL, hits);
        print_census(options, o, &census);
        if (options->tiles)
            print_tiles(options, &tiles);
    }
    if (hits)
        ok &= fclose(hits) == 0;
    ok = ok && (!options->places || write_places(options->places, o, &census));
    if (!ok)
        fprintf(stderr, "pbrt_oracle: a table cannot be written, or tiles cannot be counted\n");
    oracle_census_finish(&census);
    oracle_tiles_finish(&tiles);
    return ok;
}

int main(int argc, char **argv)
{
    static struct oracle oracle;
    struct oracle_options options;
    enum option_outcome outcome = oracle_options_parse(argc, argv, &options);
    if (outcome != OPTIONS_RUN)
        return outcome == OPTIONS_HELP ? 0 : 2;
    if (VIPS_INIT(argv[0]) != 0)
        return 1;
    vips_concurrency_set(1);
    bool ok = oracle_init(&oracle, options.scene, &options.settings);
    if (ok) {
        figure(&options, "meshes", oracle.scene.mesh_count);
        figure(&options, "triangles", (double)oracle.scene.triangle_count);
        ok = options.settings.mode == ORACLE_CAST ? count_hits(&options, &oracle)
                                                  : make_picture(&options, &oracle);
    }
    oracle_finish(&oracle);
    vips_shutdown();
    return ok ? 0 : 1;
}
