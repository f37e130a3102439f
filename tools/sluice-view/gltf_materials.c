#include "gltf_materials.h"

#include <vulkan/vulkan_core.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static const cJSON *member(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

static const cJSON *extension(const cJSON *object, const char *name)
{
    return member(member(object, "extensions"), name);
}

/* Reads KHR_texture_transform: scale, then counterclockwise rotation with V down, then offset. */
static bool read_transform(struct gltf_file *file, const cJSON *info, const char *where,
                           struct scene_slot *slot, uint64_t *set)
{
    const cJSON *transform = extension(info, "KHR_texture_transform");
    float scale[2] = {1, 1}, offset[2] = {0, 0}, turn = 0;
    if (!transform)
        return true;
    if (!gltf_get_floats(file, transform, where, "scale", 2, scale) ||
        !gltf_get_floats(file, transform, where, "offset", 2, offset) ||
        !gltf_get_float(file, transform, where, "rotation", &turn) ||
        !gltf_get_whole(file, transform, where, "texCoord", 0, 7, set))
        return false;
    const float c = cosf(turn), s = sinf(turn);
    const float m[6] = {c * scale[0], s * scale[1], -s * scale[0],
                        c * scale[1], offset[0],    offset[1]};
    memcpy(slot->m, m, sizeof m);
    return true;
}

static bool read_slot(struct gltf_file *file, const cJSON *parent, const char *name,
                      const char *where, struct scene_slot *slot)
{
    const cJSON *info = member(parent, name);
    char here[96];
    uint64_t set = 0;
    uint32_t texture;
    if (!info)
        return true;
    snprintf(here, sizeof here, "%s.%s", where, name);
    if (!gltf_get_index(file, info, here, "index", GLTF_TEXTURES, &texture) ||
        !gltf_get_whole(file, info, here, "texCoord", 0, 7, &set) ||
        !read_transform(file, info, here, slot, &set))
        return false;
    if (texture == GLTF_NONE)
        return gltf_fail(file, "%s has no index", here);
    slot->image = texture;
    slot->uv_set = (uint32_t)set;
    return true;
}

static bool read_alpha(struct gltf_file *file, const cJSON *from, const char *where,
                       struct scene_material *to)
{
    const char *mode = cJSON_GetStringValue(member(from, "alphaMode"));
    to->alpha = ALPHA_OPAQUE;
    if (mode && strcmp(mode, "MASK") == 0)
        to->alpha = ALPHA_MASK;
    else if (mode && strcmp(mode, "BLEND") == 0)
        to->alpha = ALPHA_BLEND;
    to->double_sided = cJSON_IsTrue(member(from, "doubleSided"));
    return gltf_get_float(file, from, where, "alphaCutoff", &to->cutoff);
}

bool gltf_read_material(struct gltf_file *file, uint32_t index, struct scene_material *to)
{
    char where[64];
    const cJSON *from = file->lists[GLTF_MATERIALS].items[index];
    const cJSON *pbr = member(from, "pbrMetallicRoughness");
    snprintf(where, sizeof where, "materials[%u]", index);
    scene_material_init(to);
    to->metalness = 1;
    return read_alpha(file, from, where, to) &&
           gltf_get_floats(file, pbr, where, "baseColorFactor", 4, to->color) &&
           gltf_get_float(file, pbr, where, "metallicFactor", &to->metalness) &&
           gltf_get_float(file, pbr, where, "roughnessFactor", &to->roughness) &&
           gltf_get_floats(file, from, where, "emissiveFactor", 3, to->emissive) &&
           gltf_get_float(file, member(from, "normalTexture"), where, "scale", &to->normal_scale) &&
           gltf_get_float(file, member(from, "occlusionTexture"), where, "strength",
                          &to->occlusion) &&
           read_slot(file, pbr, "baseColorTexture", where, &to->slots[SLOT_COLOR]) &&
           read_slot(file, pbr, "metallicRoughnessTexture", where, &to->slots[SLOT_ROUGHNESS]) &&
           read_slot(file, from, "normalTexture", where, &to->slots[SLOT_NORMAL]) &&
           read_slot(file, from, "occlusionTexture", where, &to->slots[SLOT_OCCLUSION]) &&
           read_slot(file, from, "emissiveTexture", where, &to->slots[SLOT_EMISSIVE]);
}

static int wrap_of(const cJSON *sampler, const char *name)
{
    const double wrap = cJSON_GetNumberValue(member(sampler, name));
    return wrap == 33071   ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE
           : wrap == 33648 ? VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT
                           : VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

/* Returns a checked index: whole, and below the count. */
static uint32_t index_of(const cJSON *object, const char *name)
{
    const cJSON *item = member(object, name);
    return cJSON_IsNumber(item) ? (uint32_t)item->valuedouble : GLTF_NONE;
}

struct gltf_texture gltf_read_texture(const struct gltf_file *file, uint32_t index)
{
    const cJSON *from = file->lists[GLTF_TEXTURES].items[index], *sampler = NULL;
    const uint32_t sampler_index = index_of(from, "sampler");
    if (sampler_index != GLTF_NONE)
        sampler = file->lists[GLTF_SAMPLERS].items[sampler_index];
    const uint32_t dds = index_of(extension(from, "MSFT_texture_dds"), "source");
    const uint32_t webp = index_of(extension(from, "EXT_texture_webp"), "source");
    struct gltf_texture texture = {.image = dds != GLTF_NONE ? dds : webp,
                                   .fallback = index_of(from, "source"),
                                   .is_dds = dds != GLTF_NONE,
                                   .wrap_u = wrap_of(sampler, "wrapS"),
                                   .wrap_v = wrap_of(sampler, "wrapT")};
    if (texture.image == GLTF_NONE) {
        texture.image = texture.fallback;
        texture.fallback = GLTF_NONE;
    }
    if (texture.image == GLTF_NONE)
        texture.problem = extension(from, "KHR_texture_basisu")
                              ? "KHR_texture_basisu is not supported"
                          : member(from, "extensions") ? "its extension is not supported"
                                                       : "it names no image";
    return texture;
}

struct gltf_image gltf_read_image(const struct gltf_file *file, uint32_t index)
{
    const cJSON *from = file->lists[GLTF_IMAGES].items[index];
    struct gltf_image image = {.uri = cJSON_GetStringValue(member(from, "uri"))};
    const uint32_t view = index_of(from, "bufferView");
    if (image.uri && strncmp(image.uri, "data:", 5) == 0) {
        size_t size = 0;
        image.bytes.bytes = image.bytes.owned = gltf_decode_data_uri(image.uri, &size);
        image.bytes.size = size;
        image.uri = NULL;
        if (!image.bytes.bytes)
            image.problem = "its data is no base64";
    } else if (!image.uri && view != GLTF_NONE) {
        image.bytes = gltf_view_bytes(file, view);
    } else if (!image.uri) {
        image.problem = "it has neither a file nor bytes";
    }
    return image;
}

static bool is_among(const cJSON *list, const char *name)
{
    for (const cJSON *item = list ? list->child : NULL; item; item = item->next)
        if (cJSON_IsString(item) && strcmp(item->valuestring, name) == 0)
            return true;
    return false;
}

static bool is_supported(const char *name)
{
    static const char *const names[] = {"KHR_texture_transform", "EXT_texture_webp",
                                        "MSFT_texture_dds"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(names[i], name) == 0)
            return true;
    return false;
}

void gltf_name_extensions(const struct gltf_file *file,
                          void (*say)(void *user, const char *extension, bool required), void *user)
{
    const cJSON *used = member(file->json, "extensionsUsed");
    const cJSON *required = member(file->json, "extensionsRequired");
    for (const cJSON *item = used ? used->child : NULL; item; item = item->next)
        if (cJSON_IsString(item) && !is_supported(item->valuestring) &&
            !is_among(item->next, item->valuestring))
            say(user, item->valuestring, is_among(required, item->valuestring));
}
