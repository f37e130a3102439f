#include "scene.h"

#include <stdio.h>
#include <stdlib.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/log.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"
#include "transform.h"

bool scene_box_is_empty(const SluicePbrtBounds *box)
{
    return !(box->least[0] <= box->most[0] && box->least[1] <= box->most[1] &&
             box->least[2] <= box->most[2]);
}

SluicePbrtShape scene_shape(const struct scene *scene, uint32_t index)
{
    SluicePbrtShape shape = {.structSize = sizeof shape};
    (void)sluiceGetPbrtShape(scene->pbrt, index, &shape); /* the index is below shapeCount */
    return shape;
}

SluicePbrtMaterial scene_material(const struct scene *scene, uint32_t index)
{
    SluicePbrtMaterial material = {.structSize = sizeof material};
    (void)sluiceGetPbrtMaterial(scene->pbrt, index, &material);
    return material;
}

SluicePbrtTexture scene_texture(const struct scene *scene, uint32_t index)
{
    SluicePbrtTexture texture = {.structSize = sizeof texture};
    (void)sluiceGetPbrtTexture(scene->pbrt, index, &texture);
    return texture;
}

SluicePbrtLight scene_light(const struct scene *scene, uint32_t index)
{
    SluicePbrtLight light = {.structSize = sizeof light};
    (void)sluiceGetPbrtLight(scene->pbrt, index, &light);
    return light;
}

SluicePbrtObject scene_object_of(const struct scene *scene, uint32_t instance)
{
    SluicePbrtObject object = {0};
    (void)sluiceGetPbrtObject(scene->pbrt, scene->instances[instance].object, &object);
    return object;
}

static bool is_canceled(const struct scene *scene)
{
    return scene->watch && atomic_load(scene->watch->canceled);
}

/** Returns whether rays can see the shape. Reports mistakes of the scene on stderr. */
static bool is_visible(const struct scene *scene, const SluicePbrtShape *shape)
{
    if (shape->alpha.texture == SLUICE_PBRT_NONE && !(shape->alpha.value[0] > 0.0f))
        return false;
    if (scene_material(scene, shape->material).kind == SLUICE_PBRT_MATERIAL_NONE &&
        shape->areaLight == SLUICE_PBRT_NONE)
        return false;
    float inverse[12];
    if (transform_invert(shape->transform, inverse))
        return true;
    text_say("%s:%u:%u: the transform has no inverse; the shape is left out", shape->pFile,
             shape->line, shape->column);
    return false;
}

/* Limit of coordinates. Proxy boxes end at 2^100 and are slightly larger than these. */
#define MOST_COORDINATE 0x1p99f

static bool is_too_large(const SluicePbrtBounds *box)
{
    for (int i = 0; i < 3; i++)
        if (!(box->least[i] >= -MOST_COORDINATE && box->most[i] <= MOST_COORDINATE))
            return true;
    return false;
}

/* Boxes of zero thickness are valid: rays hit their faces. */
static void find_box(struct scene *scene, uint32_t index)
{
    const SluicePbrtShape shape = scene_shape(scene, index);
    SluicePbrtBounds box;
    scene->boxes[index] = bounds_none();
    if (!is_visible(scene, &shape) ||
        sluiceGetPbrtShapeBounds(scene->pbrt, index, &box) != SLUICE_SUCCESS)
        return; /* after an error the log has the line */
    if (is_too_large(&box))
        text_say("%s:%u:%u: a coordinate is beyond %g; the shape is left out", shape.pFile,
                 shape.line, shape.column, (double)MOST_COORDINATE);
    else
        scene->boxes[index] = box;
}

static bool find_boxes(struct scene *scene)
{
    const SluicePbrtSceneInfo *info = &scene->info;
    scene->boxes = calloc(info->shapeCount + 1u, sizeof *scene->boxes);
    scene->object_boxes = calloc(info->objectCount + 1u, sizeof *scene->object_boxes);
    scene->box = bounds_none();
    if (!scene->boxes || !scene->object_boxes)
        return false;
    for (uint32_t i = 0; i < info->objectCount; i++)
        scene->object_boxes[i] = bounds_none();
    for (uint32_t i = 0; i < info->shapeCount && !is_canceled(scene); i++) {
        find_box(scene, i);
        if (scene_box_is_empty(&scene->boxes[i]))
            continue;
        const uint32_t object = scene_shape(scene, i).object;
        if (object != SLUICE_PBRT_NONE)
            bounds_add(&scene->object_boxes[object], &scene->boxes[i]);
    }
    return true;
}

SluicePbrtBounds scene_node_box(const struct scene *scene, struct scene_node node)
{
    if (node.instance == SLUICE_PBRT_NONE)
        return node.shape == SLUICE_PBRT_NONE ? scene->box : scene->boxes[node.shape];
    const SluicePbrtInstance *instance = &scene->instances[node.instance];
    const SluicePbrtBounds *box = node.shape == SLUICE_PBRT_NONE
                                      ? &scene->object_boxes[instance->object]
                                      : &scene->boxes[node.shape];
    float inverse[12];
    if (scene_box_is_empty(box) || !transform_invert(instance->transform, inverse))
        return bounds_none();
    const SluicePbrtBounds placed = transform_bounds(instance->transform, box);
    return is_too_large(&placed) ? bounds_none() : placed;
}

void scene_node_transform(const struct scene *scene, struct scene_node node, float transform[12])
{
    const SluicePbrtShape shape = scene_shape(scene, node.shape);
    memcpy(transform, shape.transform, sizeof shape.transform);
    if (node.instance != SLUICE_PBRT_NONE)
        transform_multiply(scene->instances[node.instance].transform, transform, transform);
}

bool scene_for_each(const struct scene *scene,
                    bool (*visit)(void *user_data, struct scene_node node), void *user_data)
{
    bool going = !is_canceled(scene);
    for (uint32_t i = 0; i < scene->info.shapeCount && going; i++)
        if (!scene_box_is_empty(&scene->boxes[i]) &&
            scene_shape(scene, i).object == SLUICE_PBRT_NONE)
            going = visit(user_data, (struct scene_node){SLUICE_PBRT_NONE, i});
    for (uint32_t i = 0; i < scene->info.instanceCount && going && !is_canceled(scene); i++) {
        const struct scene_node node = {i, SLUICE_PBRT_NONE};
        const SluicePbrtBounds box = scene_node_box(scene, node);
        if (!scene_box_is_empty(&box))
            going = visit(user_data, node);
    }
    return going;
}

/* Counts the placed shapes of the instance's object, which has at least one. */
static uint32_t count_places(const struct scene *scene, uint32_t instance)
{
    const SluicePbrtObject object = scene_object_of(scene, instance);
    uint32_t count = 0;
    for (uint32_t i = 0; i < object.shapeCount; i++)
        count += !scene_box_is_empty(&scene->boxes[object.firstShape + i]);
    return count;
}

static bool add_to_scene(void *user_data, struct scene_node node)
{
    struct scene *scene = user_data;
    const SluicePbrtBounds box = scene_node_box(scene, node);
    bounds_add(&scene->box, &box);
    scene->node_count++;
    scene->place_count +=
        node.instance == SLUICE_PBRT_NONE ? 1 : count_places(scene, node.instance);
    return true;
}

static bool note_progress(void *user_data, uint64_t read_size)
{
    const struct scene_watch *watch = user_data;
    atomic_store(watch->read_size, read_size);
    return !atomic_load(watch->canceled);
}

bool scene_open(const char *path, const char *bounds_path, const struct scene_watch *watch,
                struct scene *scene)
{
    const SluicePbrtSceneCreateInfo info = {.structSize = sizeof info,
                                            .pPath = path,
                                            .log = {.pfnLog = log_say},
                                            .pBoundsPath = bounds_path,
                                            .pUserData = (void *)watch,
                                            .pfnProgress = watch ? note_progress : NULL};
    double start = clock_seconds();
    *scene = (struct scene){.info = {.structSize = sizeof scene->info}, .watch = watch};
    SluiceResult result = sluiceOpenPbrtScene(&info, &scene->pbrt);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetPbrtSceneInfo(scene->pbrt, &scene->info);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetPbrtInstances(scene->pbrt, &scene->instances);
    if (result == SLUICE_ERROR_CANCELED)
        return false;
    if (result != SLUICE_SUCCESS) {
        text_say("%s: cannot be opened: %s", path, sluiceGetResultName(result));
        return false;
    }
    scene->parse_seconds = clock_seconds() - start;
    start = clock_seconds();
    if (!find_boxes(scene)) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    scene_for_each(scene, add_to_scene, scene);
    scene->bounds_seconds = clock_seconds() - start;
    if (is_canceled(scene))
        return false;
    if (scene->place_count == 0)
        text_say("%s: no shape can be seen", path);
    return !bounds_path || sluiceWritePbrtBounds(scene->pbrt, bounds_path) == SLUICE_SUCCESS;
}

void scene_finish(struct scene *scene)
{
    free(scene->boxes);
    free(scene->object_boxes);
    clusters_finish(&scene->clusters);
    sluiceDestroyPbrtScene(scene->pbrt);
    *scene = (struct scene){0};
}

struct node_list {
    const struct scene *scene;
    struct box_tree_box *boxes; ///< owned
    uint32_t *keys;             ///< owned; shapes, then instances
    uint32_t count;
};

static bool list_node(void *user_data, struct scene_node node)
{
    struct node_list *list = user_data;
    const SluicePbrtBounds box = scene_node_box(list->scene, node);
    memcpy(list->boxes[list->count].low, box.least, sizeof box.least);
    memcpy(list->boxes[list->count].high, box.most, sizeof box.most);
    list->keys[list->count++] = node.instance == SLUICE_PBRT_NONE
                                    ? node.shape
                                    : list->scene->info.shapeCount + node.instance;
    return true;
}

struct scene_node scene_node_of_key(const struct scene *scene, uint32_t key)
{
    const uint32_t shapes = scene->info.shapeCount;
    return key < shapes ? (struct scene_node){SLUICE_PBRT_NONE, key}
                        : (struct scene_node){key - shapes, SLUICE_PBRT_NONE};
}

bool scene_cluster(struct scene *scene, uint32_t size)
{
    const double start = clock_seconds();
    if (scene->node_count <= size)
        return true;
    struct node_list list = {.scene = scene,
                             .boxes = malloc(scene->node_count * sizeof *list.boxes),
                             .keys = malloc(scene->node_count * sizeof *list.keys)};
    bool done = list.boxes && list.keys;
    if (done) {
        scene_for_each(scene, list_node, &list);
        done = clusters_create(list.boxes, list.keys, list.count, size,
                               scene->watch ? scene->watch->canceled : NULL, &scene->clusters);
    }
    if (!done && !is_canceled(scene))
        fprintf(stderr, "out of memory\n");
    free(list.boxes);
    free(list.keys);
    scene->cluster_seconds = clock_seconds() - start;
    return done;
}

static void print_value(FILE *file, const struct scene *scene, const SluicePbrtValue *value)
{
    if (value->texture != SLUICE_PBRT_NONE) {
        const SluicePbrtTexture texture = scene_texture(scene, value->texture);
        fputs(" \"", file);
        text_write(file, texture.pName);
        fputc('"', file);
    } else {
        fprintf(file, " %g,%g,%g", value->value[0], value->value[1], value->value[2]);
    }
}

struct dump {
    const struct scene *scene;
    FILE *file;
};

static void dump_shape(const struct dump *dump, struct scene_node node)
{
    const SluicePbrtBounds box = scene_node_box(dump->scene, node);
    const SluicePbrtShape shape = scene_shape(dump->scene, node.shape);
    const SluicePbrtMaterial material = scene_material(dump->scene, shape.material);
    text_write(dump->file, shape.pFile);
    fprintf(dump->file, ":%u box %g %g %g %g %g %g material \"", shape.line, box.least[0],
            box.least[1], box.least[2], box.most[0], box.most[1], box.most[2]);
    text_write(dump->file, material.pType);
    fputs("\" diffuse", dump->file);
    print_value(dump->file, dump->scene, &material.diffuse);
    fputs(" alpha", dump->file);
    print_value(dump->file, dump->scene, &shape.alpha);
    fputc('\n', dump->file);
}

static bool dump_node(void *user_data, struct scene_node node)
{
    const struct dump *dump = user_data;
    if (node.instance == SLUICE_PBRT_NONE) {
        dump_shape(dump, node);
        return true;
    }
    const SluicePbrtObject object = scene_object_of(dump->scene, node.instance);
    for (uint32_t i = object.firstShape; i < object.firstShape + object.shapeCount; i++)
        if (!scene_box_is_empty(&dump->scene->boxes[i]))
            dump_shape(dump, (struct scene_node){node.instance, i});
    return true;
}

bool scene_dump(const struct scene *scene, const char *path)
{
    struct output_file *output = output_file_begin(path);
    if (!output)
        return false;
    struct dump dump = {scene, output_file_stream(output)};
    scene_for_each(scene, dump_node, &dump);
    return output_file_end(output, true);
}
