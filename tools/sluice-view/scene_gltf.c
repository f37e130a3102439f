#include "scene_gltf.h"

#include "gltf_cameras.h"
#include "gltf_materials.h"
#include "scene_images.h"

#include "../../samples/streaming/cache.h"
#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define UNKNOWN (UINT32_MAX - 1)

struct opening {
    struct gltf_file *file;
    const char *cache;
    struct scene_data *scene;
    uint32_t *images; ///< images of the scene; CONTENT_COUNT per texture
};

static void say_extension(void *user, const char *extension, bool required)
{
    static const char *const harmless[] = {"KHR_lights_punctual", "KHR_texture_basisu"};
    struct opening *o = user;
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++)
        if (strcmp(extension, harmless[i]) == 0 && !required)
            return;
    scene_data_note(o->scene, "%s: %s %.100s, which is not supported", o->file->path,
                    required ? "requires" : "uses", extension);
}

static uint32_t open_image(struct opening *o, const struct gltf_texture *texture, uint32_t number,
                           enum scene_content content)
{
    char path[4096], name[64];
    struct gltf_image image = gltf_read_image(o->file, number);
    uint32_t index = SCENE_NO_IMAGE;
    struct scene_image_request request = {.path = path,
                                          .wrap_u = texture->wrap_u,
                                          .wrap_v = texture->wrap_v,
                                          .content = content,
                                          .is_srgb = texture->is_dds && number == texture->image};
    snprintf(name, sizeof name, "image %u", number);
    request.name = name;
    if (image.problem) {
        scene_data_note(o->scene, "%s: images[%u]: %s", o->file->path, number, image.problem);
    } else if (!image.uri) {
        if (cache_keep(o->cache, "embedded", "", image.bytes.bytes, (size_t)image.bytes.size, path,
                       sizeof path))
            index = scene_images_add(o->scene, &request);
    } else if (!gltf_path(o->file, image.uri, path, sizeof path)) {
        scene_data_note(o->scene, "%s: images[%u]: %.200s is no file", o->file->path, number,
                        image.uri);
    } else {
        const char *slash = strrchr(path, '/');
        request.name = slash ? slash + 1 : path;
        index = scene_images_add(o->scene, &request);
    }
    free(image.bytes.owned);
    return index;
}

static uint32_t image_of(struct opening *o, uint32_t texture_index, enum scene_content content)
{
    uint32_t *known = &o->images[CONTENT_COUNT * (size_t)texture_index + content];
    if (*known != UNKNOWN)
        return *known;
    const struct gltf_texture texture = gltf_read_texture(o->file, texture_index);
    *known = SCENE_NO_IMAGE;
    if (texture.problem)
        scene_data_note(o->scene, "%s: textures[%u]: %s", o->file->path, texture_index,
                        texture.problem);
    else
        *known = open_image(o, &texture, texture.image, content);
    if (*known == SCENE_NO_IMAGE && texture.fallback != GLTF_NONE)
        *known = open_image(o, &texture, texture.fallback, content);
    return *known;
}

static enum scene_content content_of(int slot)
{
    return slot == SLOT_COLOR || slot == SLOT_EMISSIVE ? CONTENT_COLORS
           : slot == SLOT_NORMAL                       ? CONTENT_NORMALS
                                                       : CONTENT_NUMBERS;
}

static bool read_material(struct opening *o, uint32_t index)
{
    struct scene_material *material = &o->scene->materials[index];
    if (!gltf_read_material(o->file, index, material))
        return false;
    for (int k = 0; k < SLOT_COUNT; k++) {
        struct scene_slot *slot = &material->slots[k];
        const bool has_image = slot->image != SCENE_NO_IMAGE;
        if (slot->uv_set > 1) {
            scene_data_note(o->scene, "%s: materials[%u]: TEXCOORD_%u is not supported",
                            o->file->path, index, slot->uv_set);
            slot->image = SCENE_NO_IMAGE;
            slot->uv_set = 0;
        } else if (has_image) {
            slot->image = image_of(o, slot->image, content_of(k));
        }
        if (k == SLOT_COLOR)
            material->missing = has_image && slot->image == SCENE_NO_IMAGE;
    }
    /* Without its image, a material would emit light everywhere. */
    if (material->slots[SLOT_EMISSIVE].image == SCENE_NO_IMAGE &&
        cJSON_GetObjectItemCaseSensitive(o->file->lists[GLTF_MATERIALS].items[index],
                                         "emissiveTexture"))
        memset(material->emissive, 0, sizeof material->emissive);
    return true;
}

/* Counts textures. A texture that is read as colors and as numbers counts once. */
static uint32_t count_images(const struct gltf_file *file)
{
    return file->lists[GLTF_TEXTURES].count;
}

static bool read_all(struct opening *o)
{
    const uint32_t materials = o->file->lists[GLTF_MATERIALS].count;
    const size_t most = CONTENT_COUNT * (size_t)o->file->lists[GLTF_TEXTURES].count;
    o->scene->materials = calloc(materials + 1u, sizeof *o->scene->materials);
    o->scene->images = calloc(most + 1, sizeof *o->scene->images);
    o->images = malloc((most + 1) * sizeof *o->images);
    if (!o->scene->materials || !o->scene->images || !o->images)
        return gltf_fail(o->file, "out of memory");
    o->scene->material_count = materials + 1;
    scene_material_init(&o->scene->materials[materials]);
    for (size_t i = 0; i < most; i++)
        o->images[i] = UNKNOWN;
    gltf_name_extensions(o->file, say_extension, o);
    if (o->scene->progress)
        atomic_store(&o->scene->progress->total, count_images(o->file));
    for (uint32_t i = 0; i < materials; i++)
        if (scene_data_canceled(o->scene) || !read_material(o, i))
            return false;
    return true;
}

bool scene_gltf_materials(struct gltf_file *file, const char *cache, struct scene_data *scene)
{
    struct opening opening = {file, cache, scene, NULL};
    const bool read = read_all(&opening);
    free(opening.images);
    if (!read && file->error[0])
        text_say("sluice-view: %s", file->error);
    return read;
}

struct camera_notes {
    const struct gltf_file *file;
    struct scene_data *scene;
};

static void note_camera(void *user, const char *where, const char *problem)
{
    struct camera_notes *notes = user;
    scene_data_note(notes->scene, "%s: %.100s: %s", notes->file->path, where, problem);
}

bool scene_gltf_cameras(struct gltf_file *file, struct scene_data *scene)
{
    struct camera_notes notes = {file, scene};
    struct file_cameras cameras;
    bool read = gltf_read_cameras(file, note_camera, &notes, &cameras);
    scene->cameras = cameras.items;
    scene->camera_count = cameras.count;
    if (cameras.count > 0)
        scene->camera = cameras.items[0].camera;
    for (uint32_t i = 0; read && i < cameras.count && scene->tour.count == 0; i++)
        for (size_t k = 0; read && k < cameras.items[i].path.count; k++)
            read = camera_path_add(&scene->tour, cameras.items[i].path.points[k].seconds,
                                   &cameras.items[i].path.points[k].camera);
    if (!read)
        text_say("sluice-view: %s: out of memory", file->path);
    return read;
}
