/* mkdtemp */
#define _XOPEN_SOURCE 700

#include "support/test.h"

#include "gltf_file.h"
#include "gltf_materials.h"
#include "scene_import.h"

#include <vulkan/vulkan_core.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/view-gltf-XXXXXX";

/* A triangle: three positions, three UVs, three indices, and two bytes of padding. */
static const struct {
    float positions[9], uvs[6];
    uint16_t indices[4];
} triangle = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1, 0, 0, 1}, {0, 1, 2, 0}};

/* BYTES stands for the triangle in base64. */
static const char whole_scene[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[1,0]}],"
    "\"nodes\":[{\"mesh\":0},{\"mesh\":1,\"scale\":[-1,1,1],\"children\":[2]},{}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"indices\":2,"
    "\"material\":0}]},{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2,"
    "\"material\":1}]}],"
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0,0,1]}},"
    "{\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25,\"doubleSided\":true,"
    "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,1,0,1]}}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
    "\"min\":[0,0,0],\"max\":[1,1,0]},"
    "{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"},"
    "{\"bufferView\":0,\"byteOffset\":60,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":68}],"
    "\"buffers\":[{\"byteLength\":68,\"uri\":\"data:application/octet-stream;base64,BYTES\"}]}";

static void write_base64(const uint8_t *bytes, size_t size, char *text)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t length = 0;
    for (size_t i = 0; i < size; i += 3) {
        const uint32_t word = (uint32_t)bytes[i] << 16 |
                              (i + 1 < size ? (uint32_t)bytes[i + 1] << 8 : 0) |
                              (i + 2 < size ? (uint32_t)bytes[i + 2] : 0);
        for (int k = 0; k < 4; k++)
            text[length++] = i + (size_t)k > size ? '=' : digits[word >> (18 - 6 * k) & 63];
    }
    text[length] = '\0';
}

/* Replaces the first `from`, which must exist. */
static void replace(char *text, size_t size, const char *from, const char *to)
{
    char *at = strstr(text, from);
    assert_non_null(at);
    const size_t rest = strlen(at) - strlen(from) + 1;
    assert_true((size_t)(at - text) + strlen(to) + rest <= size);
    memmove(at + strlen(to), at + strlen(from), rest);
    memcpy(at, to, strlen(to));
}

static void make_scene(char text[8192], const char *from, const char *to)
{
    char bytes[128];
    write_base64((const uint8_t *)&triangle, sizeof triangle, bytes);
    strcpy(text, whole_scene);
    if (from)
        replace(text, 8192, from, to);
    if (strstr(text, "BYTES"))
        replace(text, 8192, "BYTES", bytes);
}

static const char *path_of(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(path_of(name), "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static bool import(const char *from, const char *to, struct scene_data *scene)
{
    char text[8192];
    make_scene(text, from, to);
    write_file("scene.gltf", text);
    char path[256];
    strcpy(path, path_of("scene.gltf"));
    *scene = (struct scene_data){0};
    return scene_import(path, folder, false, scene);
}

static void broken_files_are_refused_with_file_and_cause(void **state)
{
    static const struct {
        const char *from, *to, *cause;
    } rows[] = {
        {"{\"asset\"", "[\"asset\"", "not valid JSON"},
        {"\"version\":\"2.0\"", "\"version\":\"1.0\"", "no glTF of version 2"},
        {"\"scenes\":[{\"nodes\":[1,0]}]", "\"scenes\":{}", "scenes is no array"},
        {"\"scenes\":[{", "\"scenes\":[7,{", "scenes[0] is no object"},
        {"\"nodes\":[1,0]", "\"nodes\":[1,3]", "scenes[0] names one of nodes that is not there"},
        {"\"scene\":0", "\"scene\":1", "scene is 1, but there are 1 scenes"},
        {"\"mesh\":1", "\"mesh\":2", "nodes[1].mesh is 2, but there are 2 meshes"},
        {"\"mesh\":1", "\"mesh\":-1", "nodes[1].mesh is no whole number"},
        {"\"mesh\":1", "\"mesh\":0.5", "nodes[1].mesh is no whole number"},
        {"\"mesh\":1", "\"mesh\":\"1\"", "nodes[1].mesh is no whole number"},
        {"\"mesh\":1", "\"mesh\":1e300", "nodes[1].mesh is 1"},
        {"\"children\":[2]", "\"children\":[1]", "within itself"},
        {"\"children\":[2]},{}", "\"children\":[2]},{\"children\":[1]}", "within itself"},
        {"\"children\":[2]", "\"children\":[2,2]", "nodes[2] is a child twice"},
        {"\"children\":[2]", "\"children\":[9]", "nodes[1] has a child that is no node"},
        {"\"scale\":[-1,1,1]", "\"scale\":[-1,1]", "nodes[1].scale is no array of 3 numbers"},
        {"\"scale\":[-1,1,1]", "\"scale\":[1e99,1,1]", "nodes[1].scale[0]"},
        {"\"POSITION\":0", "\"POSITION\":3", "POSITION is 3, but there are 3 accessors"},
        {"\"POSITION\":0", "\"PLACE\":0", "has no POSITION"},
        {"\"POSITION\":0", "\"POSITION\":1", "POSITION: accessors[1] has 3 elements of 2"},
        {"\"indices\":2", "\"indices\":0", "accessors[0] is no list of indices"},
        {"\"material\":1", "\"material\":2", "material is 2, but there are 2 materials"},
        {"\"bufferView\":0,\"componentType\":5126,\"count\":3",
         "\"bufferView\":0,\"componentType\":5126,\"count\":4000000000", "accessors[0] ends at"},
        {"\"bufferView\":0,\"componentType\":5126,\"count\":3",
         "\"bufferView\":0,\"componentType\":5126,\"count\":0", "accessors[0].count is 0"},
        {"\"bufferView\":0,\"componentType\":5126", "\"bufferView\":0,\"componentType\":5125",
         "POSITION: accessors[0]"},
        {"\"type\":\"SCALAR\"", "\"type\":\"NONE\"", "accessors[2] lacks count, type"},
        {"\"byteOffset\":60", "\"byteOffset\":64", "accessors[2] ends at byte 70"},
        {"\"byteOffset\":60", "\"byteOffset\":12", "has index 16256, but 3 vertices"},
        {"\"count\":3,\"type\":\"VEC2\"", "\"count\":2,\"type\":\"VEC2\"",
         "TEXCOORD_0: accessors[1] has 2 elements"},
        {"[{\"buffer\":0,\"byteLength\":68}]", "[{\"buffer\":0,\"byteLength\":69}]",
         "bufferViews[0] ends at byte 69 of 68"},
        {"[{\"buffer\":0,\"byteLength\":68}]", "[{\"buffer\":1,\"byteLength\":68}]",
         "bufferViews[0].buffer is 1"},
        {"[{\"buffer\":0,", "[{\"byteStride\":4,\"buffer\":0,",
         "accessors[0]: its elements overlap"},
        {"\"byteLength\":68,\"uri\"", "\"byteLength\":9999,\"uri\"", "has 68 bytes"},
        {"\"byteLength\":68,\"uri\"", "\"byteLength\":1e18,\"uri\"", "buffers[0].byteLength is 1"},
        {"base64,BYTES", "base64,????", "buffers[0]: its data is no base64"},
        {"data:application/octet-stream;base64,BYTES", "none.bin",
         "none.bin cannot be opened: No such file or directory"},
        {"data:application/octet-stream;base64,BYTES", "pack://x/y", "pack://x/y is no file"},
        {",\"uri\":\"data:application/octet-stream;base64,BYTES\"", "", "neither a file nor bytes"},
        {"\"scene\":0", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]",
         "requires KHR_draco_mesh_compression"},
        {"\"scene\":0", "\"skins\":[{\"joints\":[0,5]}]", "skins[0] names one of nodes"},
        {"\"scene\":0", "\"animations\":[{\"channels\":[{\"sampler\":0}],\"samplers\":[]}]",
         "animations[0].channels[0] has no sampler"},
        {"\"scene\":0", "\"textures\":[{\"source\":0}]", "textures[0].source is 0"},
        {"\"scene\":0", "\"textures\":[{\"extensions\":{\"MSFT_texture_dds\":{\"source\":7}}}]",
         "textures[0].source is 7"},
        {"\"min\":[0,0,0]",
         "\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"byteOffset\":62,"
         "\"componentType\":5121},\"values\":{\"bufferView\":0,\"byteOffset\":64}}",
         "accessors[0] ends at byte 76"},
        {"\"min\":[0,0,0]",
         "\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"byteOffset\":7,"
         "\"componentType\":5121},\"values\":{\"bufferView\":0}},\"min\":[0,0,0]",
         NULL},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[8192];
        struct gltf_file file;
        make_scene(text, rows[i].from, rows[i].to);
        const bool opened = gltf_open_bytes("/nowhere/a.gltf", text, strlen(text), &file);
        if (!rows[i].cause)
            assert_true(opened);
        else if (opened || !strstr(file.error, rows[i].cause) ||
                 strncmp(file.error, "/nowhere/a.gltf: ", 17) != 0)
            fail_msg("%s: %s: %s", rows[i].to, rows[i].cause, opened ? "opened" : file.error);
        gltf_finish(&file);
    }
}

static size_t make_glb(uint8_t glb[8192])
{
    char text[8192];
    make_scene(text, ",\"uri\":\"data:application/octet-stream;base64,BYTES\"", "");
    while (strlen(text) % 4 != 0)
        strcat(text, " ");
    const uint32_t json = (uint32_t)strlen(text), binary = sizeof triangle;
    const uint32_t head[5] = {0x46546C67, 2, 12 + 8 + json + 8 + binary, json, 0x4E4F534A};
    const uint32_t middle[2] = {binary, 0x004E4942};
    memcpy(glb, head, sizeof head);
    memcpy(glb + 20, text, json);
    memcpy(glb + 20 + json, middle, sizeof middle);
    memcpy(glb + 28 + json, &triangle, sizeof triangle);
    return head[2];
}

static void a_glb_that_ends_early_is_refused_wherever_it_ends(void **state)
{
    uint8_t glb[8192];
    struct gltf_file file;
    (void)state;
    const size_t size = make_glb(glb);
    assert_true(gltf_open_bytes("a.glb", glb, size, &file));
    assert_int_equal(file.buffers[0].size, sizeof triangle);
    assert_memory_equal(file.buffers[0].bytes, &triangle, sizeof triangle);
    gltf_finish(&file);
    for (size_t length = 0; length < size; length++) {
        assert_false(gltf_open_bytes("a.glb", glb, length, &file));
        assert_true(strlen(file.error) > strlen("a.glb: "));
        gltf_finish(&file);
    }
}

static void transforms_scale_then_turn_then_move(void **state)
{
    char text[8192];
    struct gltf_file file;
    struct scene_material material;
    const double turn = 0.3, u = 0.7, v = 0.2;
    (void)state;
    make_scene(text, "\"baseColorFactor\":[1,0,0,1]",
               "\"baseColorTexture\":{\"index\":0,\"texCoord\":0,\"extensions\":{"
               "\"KHR_texture_transform\":{\"scale\":[1.5,4],\"rotation\":0.3,"
               "\"offset\":[-0.2,0.1],\"texCoord\":1}}}");
    replace(text, sizeof text, "\"scene\":0", "\"scene\":0,\"textures\":[{}]");
    assert_true(gltf_open_bytes("a.gltf", text, strlen(text), &file));
    assert_true(gltf_read_material(&file, 0, &material));
    const struct scene_slot *slot = &material.slots[SLOT_COLOR];
    /* Computed with complex numbers, V up: a counterclockwise turn is a product. */
    const double x = 1.5 * u, y = -4 * v;
    const double turned[2] = {x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn)};
    assert_int_equal(slot->uv_set, 1);
    assert_float_equal(slot->m[0] * u + slot->m[1] * v + slot->m[4], turned[0] - 0.2, 1e-5);
    assert_float_equal(slot->m[2] * u + slot->m[3] * v + slot->m[5], -turned[1] + 0.1, 1e-5);
    assert_true(gltf_read_material(&file, 1, &material));
    assert_true(material.double_sided && material.alpha == ALPHA_MASK);
    assert_float_equal(material.cutoff, 0.25f, 0);
    gltf_finish(&file);
}

/* Assimp meets material 1 first. */
static void meshes_keep_their_materials_and_mirrored_ones_turn(void **state)
{
    struct scene_data scene;
    (void)state;
    assert_true(import(NULL, NULL, &scene));
    assert_int_equal(scene.part_count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        const struct scene_part *part = &scene.parts[i];
        const struct scene_vertex *corners[3];
        float least = 0;
        for (int k = 0; k < 3; k++) {
            corners[k] = &scene.vertices[scene.indices[part->first_index + (uint32_t)k]];
            least = fminf(least, corners[k]->position[0]);
        }
        assert_int_equal(part->index_count, 3);
        assert_int_equal(part->material, least < 0 ? 1 : 0);
        assert_float_equal(scene.materials[part->material].color[least < 0 ? 1 : 0], 1, 0);
        const float ax = corners[1]->position[0] - corners[0]->position[0];
        const float ay = corners[1]->position[1] - corners[0]->position[1];
        const float bx = corners[2]->position[0] - corners[0]->position[0];
        const float by = corners[2]->position[1] - corners[0]->position[1];
        assert_true(ax * by - ay * bx > 0);
        for (int k = 0; least >= 0 && k < 3; k++) {
            assert_float_equal(corners[k]->uv[0][0], corners[k]->position[0], 0);
            assert_float_equal(corners[k]->uv[0][1], corners[k]->position[1], 0);
        }
    }
    scene_data_finish(&scene);
}

static const char pixel[] =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGA"
    "WjR9awAAAABJRU5ErkJggg==";

#define AS_COLORS "\"baseColorTexture\":{\"index\":0}"
#define AS_ALL                                                                                     \
    AS_COLORS ",\"metallicRoughnessTexture\":{\"index\":0}},\"normalTexture\":{\"index\":0},"      \
              "\"extras\":{"

static void import_with_image(const char *image, const char *texture, const char *uses,
                              struct scene_data *scene)
{
    char text[8192], added[2048];
    make_scene(text, "\"baseColorFactor\":[1,0,0,1]", uses);
    snprintf(added, sizeof added, "\"scene\":0,\"textures\":[%s],\"images\":[%s]", texture, image);
    replace(text, sizeof text, "\"scene\":0", added);
    write_file("scene.gltf", text);
    char path[256];
    strcpy(path, path_of("scene.gltf"));
    *scene = (struct scene_data){0};
    assert_true(scene_import(path, folder, true, scene));
}

static void images_that_cannot_be_shown_are_named(void **state)
{
    static const struct {
        const char *image, *texture, *words;
    } rows[] = {
        {"{\"uri\":\"no such.png\"}", "{\"source\":0}", "no such.png"},
        {"{\"uri\":\"data:image/png;base64,???\"}", "{\"source\":0}", "images[0]: its data"},
        {"{\"uri\":\"pack://x/y.png\"}", "{\"source\":0}", "pack://x/y.png is no file"},
        {"{}", "{\"source\":0}", "images[0]: it has neither"},
        {"{}", "{\"extensions\":{\"KHR_texture_basisu\":{}}}", "textures[0]: KHR_texture_basisu"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct scene_data scene;
        import_with_image(rows[i].image, rows[i].texture, AS_COLORS, &scene);
        assert_int_equal(scene.image_count, 0);
        assert_int_equal(scene.message_count, 1);
        assert_non_null(strstr(scene.messages[0], rows[i].words));
        assert_true(scene.materials[0].missing && !scene.materials[1].missing);
        scene_data_finish(&scene);
    }
}

static void images_inside_of_the_file_are_opened(void **state)
{
    char image[512];
    struct scene_data scene;
    (void)state;
    snprintf(image, sizeof image, "{\"uri\":\"%s\"}", pixel);
    import_with_image(image, "{\"source\":0}", AS_COLORS, &scene);
    assert_int_equal(scene.image_count, 1);
    assert_int_equal(scene.message_count, 0);
    assert_int_equal(scene.materials[0].slots[SLOT_COLOR].image, 0);
    scene_data_finish(&scene);
}

/* A texture shows what its extension names, or else its own source. */
#define LOSSLESS "data:image/webp;base64,UklGRh4AAABXRUJQVlA4TBEAAAAvAUAAAAdQwP4XsP+BiOh/AAA="

static const char *image_text(const char *uri)
{
    static char text[1024];
    snprintf(text, sizeof text, "{\"uri\":\"%s\"},{\"uri\":\"%s\"}", pixel, uri);
    return text;
}

static void textures_of_webp_are_shown_and_damaged_ones_fall_back(void **state)
{
    static const char with[] =
        "{\"source\":0,\"extensions\":{\"EXT_texture_webp\":{\"source\":1}}}";
    SluiceImageInfo info = {.structSize = sizeof info};
    struct scene_data scene;
    (void)state;
    import_with_image("{\"uri\":\"" LOSSLESS "\"}", "{\"source\":0}", AS_COLORS, &scene);
    const bool reads_webp = scene.image_count == 1;
    scene_data_finish(&scene);
    import_with_image(image_text("no such.webp"), with, AS_COLORS, &scene);
    assert_int_equal(scene.image_count, 1);
    assert_int_equal(scene.message_count, 1);
    assert_non_null(strstr(scene.messages[0], "no such.webp"));
    assert_false(scene.materials[0].missing);
    assert_int_equal(sluiceGetImageInfo(scene.images[0].source, &info), SLUICE_SUCCESS);
    assert_int_equal(info.width, 1);
    scene_data_finish(&scene);
    if (!reads_webp)
        SKIP_TEST("libvips reads no WebP");
    import_with_image(image_text(LOSSLESS), with, AS_COLORS, &scene);
    assert_int_equal(scene.image_count, 1);
    assert_int_equal(scene.message_count, 0);
    assert_int_equal(sluiceGetImageInfo(scene.images[0].source, &info), SLUICE_SUCCESS);
    assert_int_equal(info.width, 2);
    const SluiceImageRegion region = {0, 1, 1, 1, 1, 0};
    uint8_t texel[4];
    assert_int_equal(sluiceReadImageRegion(scene.images[0].source, &region, texel, 4),
                     SLUICE_SUCCESS);
    assert_memory_equal(texel, "\xff\x80\x80\xff", 4);
    scene_data_finish(&scene);
}

static void textures_of_basisu_show_their_own_source(void **state)
{
    struct scene_data scene;
    (void)state;
    import_with_image(image_text("none.ktx2"),
                      "{\"source\":0,\"extensions\":{\"KHR_texture_basisu\":{\"source\":1}}}",
                      AS_COLORS, &scene);
    assert_int_equal(scene.image_count, 1);
    assert_int_equal(scene.message_count, 0);
    assert_false(scene.materials[0].missing);
    scene_data_finish(&scene);
}

/* 4 x 4 texels of BC1 in three levels: the format says nothing about sRGB. */
static void write_dds(const char *name)
{
    static const uint32_t header[32] = {0x20534444, 124, 0x21007,   4, 4,          8,
                                        0,          3,   [19] = 32, 4, 0x31545844, [27] = 0x401008};
    static const uint8_t blocks[24] = {0xE0, 7, 0, 0, 0,    0, 0, 0, 0xE0, 7, 0, 0,
                                       0,    0, 0, 0, 0xE0, 7, 0, 0, 0,    0, 0, 0};
    FILE *file = fopen(path_of(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(header, 4, 32, file), 32);
    assert_int_equal(fwrite(blocks, 1, sizeof blocks, file), sizeof blocks);
    assert_int_equal(fclose(file), 0);
}

static void textures_of_dds_are_shown_as_what_they_mean(void **state)
{
    static const char with[] =
        "{\"source\":0,\"extensions\":{\"MSFT_texture_dds\":{\"source\":1}}}";
    SluiceImageInfo info = {.structSize = sizeof info};
    struct scene_data scene;
    (void)state;
    write_dds("a.dds");
    import_with_image(image_text("a.dds"), with, AS_ALL, &scene);
    assert_int_equal(scene.image_count, 3);
    assert_int_equal(scene.message_count, 0);
    const struct scene_slot *slots = scene.materials[0].slots;
    SluiceImageSource *colors = scene.images[slots[SLOT_COLOR].image].source;
    assert_int_equal(sluiceGetImageInfo(colors, &info), SLUICE_SUCCESS);
    assert_int_equal(info.format, SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK);
    assert_int_equal(info.mipLevelCount, 3);
    const SluiceImageRegion region = {0, 0, 0, 4, 4, 0};
    uint8_t block[8];
    assert_int_equal(sluiceReadImageRegion(colors, &region, block, 8), SLUICE_SUCCESS);
    assert_memory_equal(block, "\xe0\x07\0\0\0\0\0\0", 8);
    assert_int_equal(sluiceGetImageInfo(scene.images[slots[SLOT_NORMAL].image].source, &info),
                     SLUICE_SUCCESS);
    assert_int_equal(info.format, SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK);
    scene_data_finish(&scene);
}

/* Two texels: (255, 128, 128) and (128, 255, 128). */
static const char two_texels[] =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mP439DQ8L8BAA"
    "5/A//8Kj2mAAAAAElFTkSuQmCC";

/* The mean of 255 and 128 as colors, as numbers, and of the vectors (1, 0, 0) and (0, 1, 0). */
static void coarser_levels_are_made_for_what_texels_mean(void **state)
{
    static const struct {
        int slot;
        SluiceFormat format;
        int red, blue;
    } rows[] = {{SLOT_COLOR, SLUICE_FORMAT_R8G8B8A8_SRGB, 205, 128},
                {SLOT_ROUGHNESS, SLUICE_FORMAT_R8G8B8A8_UNORM, 192, 128},
                {SLOT_NORMAL, SLUICE_FORMAT_R8G8B8A8_UNORM, 218, 128}};
    char image[512];
    struct scene_data scene;
    (void)state;
    snprintf(image, sizeof image, "{\"uri\":\"%s\"}", two_texels);
    import_with_image(image, "{\"source\":0}", AS_ALL, &scene);
    assert_int_equal(scene.image_count, 3);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        SluiceImageSource *source =
            scene.images[scene.materials[0].slots[rows[i].slot].image].source;
        SluiceImageInfo info = {.structSize = sizeof info};
        const SluiceImageRegion region = {1, 0, 0, 1, 1, 0};
        uint8_t texel[4];
        assert_int_equal(sluiceGetImageInfo(source, &info), SLUICE_SUCCESS);
        assert_int_equal(sluiceReadImageRegion(source, &region, texel, 4), SLUICE_SUCCESS);
        assert_int_equal(info.format, rows[i].format);
        assert_int_equal(info.addressModeU, SLUICE_IMAGE_ADDRESS_MODE_REPEAT);
        assert_in_range(texel[0], rows[i].red - 1, rows[i].red + 1);
        assert_in_range(texel[1], rows[i].red - 1, rows[i].red + 1);
        assert_in_range(texel[2], rows[i].blue - 1, rows[i].blue + 1);
    }
    scene_data_finish(&scene);
}

/* Two images; a material for each row of slots. */
static uint32_t primary_of(const struct scene_material *materials, uint32_t count, int wrap)
{
    struct scene_image images[3] = {{.wrap_u = wrap, .wrap_v = wrap},
                                    {.wrap_u = wrap, .wrap_v = wrap},
                                    {.wrap_u = wrap, .wrap_v = wrap}};
    struct scene_data scene = {.images = images,
                               .image_count = 3,
                               .materials = (struct scene_material *)materials,
                               .material_count = count};
    scene_data_find_sets(&scene);
    assert_int_equal(images[0].primary, SCENE_NO_IMAGE);
    return images[1].primary;
}

static struct scene_material material_of(uint32_t color, uint32_t normal, float scale, float turn)
{
    struct scene_material material;
    scene_material_init(&material);
    material.slots[SLOT_COLOR].image = color;
    material.slots[SLOT_NORMAL] = (struct scene_slot){
        normal,
        0,
        {scale * cosf(turn), scale * sinf(turn), -scale * sinf(turn), scale * cosf(turn), 0, 0}};
    return material;
}

static void images_follow_where_one_map_tells_what_they_need(void **state)
{
    const int repeat = VK_SAMPLER_ADDRESS_MODE_REPEAT,
              clamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    struct scene_material m[2];
    (void)state;
    m[0] = material_of(0, 1, 1, 0);
    assert_int_equal(primary_of(m, 1, repeat), 0);
    assert_int_equal(primary_of(m, 1, clamp), 0);
    m[1] = material_of(0, 1, 1, 0); /* twice alike */
    assert_int_equal(primary_of(m, 2, repeat), 0);
    m[1] = material_of(0, 1, 2, 0); /* at two scales */
    assert_int_equal(primary_of(m, 2, repeat), SCENE_NO_IMAGE);
    m[1] = material_of(2, 1, 1, 0); /* beside two color images */
    assert_int_equal(primary_of(m, 2, repeat), SCENE_NO_IMAGE);
    m[1] = material_of(1, SCENE_NO_IMAGE, 1, 0); /* a color itself */
    assert_int_equal(primary_of(m, 2, repeat), SCENE_NO_IMAGE);
    m[0] = material_of(0, 1, 4, 0);
    assert_int_equal(primary_of(m, 1, repeat), 0);
    assert_int_equal(primary_of(m, 1, clamp), SCENE_NO_IMAGE);
    m[0] = material_of(0, 1, 2.5f, 0); /* repeats in part */
    assert_int_equal(primary_of(m, 1, repeat), SCENE_NO_IMAGE);
    m[0] = material_of(0, 1, 1, 0.5f);
    assert_int_equal(primary_of(m, 1, repeat), SCENE_NO_IMAGE);
    m[0] = material_of(0, 1, 1, 0);
    m[0].slots[SLOT_NORMAL].uv_set = 1;
    assert_int_equal(primary_of(m, 1, repeat), SCENE_NO_IMAGE);
}

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    char command[128];
    (void)state;
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broken_files_are_refused_with_file_and_cause),
        cmocka_unit_test(a_glb_that_ends_early_is_refused_wherever_it_ends),
        cmocka_unit_test(transforms_scale_then_turn_then_move),
        cmocka_unit_test(meshes_keep_their_materials_and_mirrored_ones_turn),
        cmocka_unit_test(images_that_cannot_be_shown_are_named),
        cmocka_unit_test(images_inside_of_the_file_are_opened),
        cmocka_unit_test(textures_of_webp_are_shown_and_damaged_ones_fall_back),
        cmocka_unit_test(textures_of_basisu_show_their_own_source),
        cmocka_unit_test(textures_of_dds_are_shown_as_what_they_mean),
        cmocka_unit_test(coarser_levels_are_made_for_what_texels_mean),
        cmocka_unit_test(images_follow_where_one_map_tells_what_they_need),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
