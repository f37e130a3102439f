#include "device/array_scene.h"

#include "support/test.h"
#include "vulkan/format.h"
#include "vulkan/format_caps.h"

enum pattern_kind array_scene_kind(uint32_t layer)
{
    static const enum pattern_kind kinds[] = {PATTERN_LEVEL, PATTERN_HASH, PATTERN_WAVES};
    return kinds[layer % 3];
}

/* Returns whether the device reports one mip tail for all layers of an array. */
static bool layers_share_tail(struct harness *h, const SluiceImageInfo *info, uint32_t layer_count)
{
    PFN_vkGetImageSparseMemoryRequirements get =
        (PFN_vkGetImageSparseMemoryRequirements)h->GetDeviceProcAddr(
            h->device, "vkGetImageSparseMemoryRequirements");
    VkImageCreateInfo create = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                .flags = SLC_IMAGE_SPARSE_FLAGS,
                                .imageType = VK_IMAGE_TYPE_2D,
                                .format = slc_vk_format(info->format),
                                .extent = {info->width, info->height, 1},
                                .mipLevels = info->mipLevelCount,
                                .arrayLayers = layer_count,
                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                .usage = SLC_IMAGE_USAGE};
    VkImage image;
    assert_int_equal(h->CreateImage(h->device, &create, NULL, &image), VK_SUCCESS);
    VkSparseImageMemoryRequirements aspects[4];
    uint32_t count = 4;
    get(h->device, image, &count, aspects);
    h->DestroyImage(h->device, image, NULL);
    bool shared = false;
    for (uint32_t i = 0; i < count; i++)
        if (aspects[i].formatProperties.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT)
            shared = aspects[i].imageMipTailSize > 0 &&
                     aspects[i].imageMipTailFirstLod < info->mipLevelCount &&
                     aspects[i].formatProperties.flags & VK_SPARSE_IMAGE_FORMAT_SINGLE_MIPTAIL_BIT;
    return shared;
}

bool array_scene_add(struct scene *scene, SluiceImageSource *source, uint32_t layer_count,
                     SluiceVulkanTexture *textures)
{
    struct harness *h = scene->h;
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = source};
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetImageInfo(source, &info));
    SluiceResidencyMode mode;
    CHECK_OK(sluiceGetVulkanResidencyMode(scene->streamer, &mode));
    bool sparse = mode == SLUICE_RESIDENCY_MODE_SPARSE;
    bool shared = sparse && layers_share_tail(h, &info, layer_count);
    h->quiet = shared;
    SluiceResult result =
        sluiceAddVulkanTextureArray(scene->streamer, &create, layer_count, textures);
    h->quiet = false;
    if (shared)
        CHECK_RESULT(result, SLUICE_ERROR_UNSUPPORTED);
    else
        CHECK_OK(result);
    return !shared;
}

bool array_scene_init(struct array_scene *a, struct harness *h, SluiceVulkanStreamerCreateInfo info,
                      bool mixed, const uint32_t size[2], SluiceFormat format)
{
    scene_init(&a->scene, h, info);
    for (uint32_t i = 0; i < ARRAY_LAYERS; i++)
        a->layers[i] =
            pattern_source(mixed ? array_scene_kind(i) : PATTERN_LEVEL, size[0], size[1], format);
    CHECK_OK(sluiceCreateArrayImageSource(a->layers, ARRAY_LAYERS, NULL, &a->source));
    SluiceVulkanTexture textures[ARRAY_LAYERS];
    if (!array_scene_add(&a->scene, a->source, ARRAY_LAYERS, textures))
        return false;
    for (uint32_t i = 0; i < ARRAY_LAYERS; i++) {
        struct scene_texture *t = &a->scene.textures[i];
        assert_int_equal(textures[i].tableIndex, textures[0].tableIndex + i);
        assert_int_equal(textures[i].arrayLayer, i);
        assert_ptr_equal(textures[i].image, textures[0].image);
        assert_true(textures[i].arrayView != VK_NULL_HANDLE);
        *t = (struct scene_texture){
            .used = true, .source = a->layers[i], .texture = textures[i], .anisotropy = 1};
        t->info.structSize = sizeof t->info;
        CHECK_OK(sluiceGetImageInfo(a->layers[i], &t->info));
        t->probe = prober_texture(&a->scene.prober, &t->texture, t->u, t->v, 1);
    }
    return true;
}

void array_scene_finish(struct array_scene *a)
{
    scene_finish(&a->scene);
    sluiceDestroyImageSource(a->source);
    for (uint32_t i = 0; i < ARRAY_LAYERS; i++)
        sluiceDestroyImageSource(a->layers[i]);
}
