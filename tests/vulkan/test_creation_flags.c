/* Buffers and images have the flags that the application asks for. */
#include "vulkan/fake_objects.h"

#include "support/test.h"

#include <string.h>

static struct fake_vulkan fake; /* large */

static SluiceVulkanStreamerCreateInfo streamer_info(SluiceResidencyMode mode)
{
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = mode,
                                           .maxTextureCount = 4,
                                           .maxRegionCount = 256,
                                           .tilesPerFrame = 16};
    fake = (struct fake_vulkan){.tail_page_count = 1};
    fake_vulkan_fill(&info);
    return info;
}

static void check_address(VkBuffer buffer, VkDeviceAddress address, uint64_t size)
{
    assert_true(buffer && address == (VkDeviceAddress)(uintptr_t)buffer);
    assert_int_equal(size, FAKE_OBJECT(buffer)->size);
}

static void buffers_have_addresses_and_sizes(void **state)
{
    (void)state;
    const SluiceResidencyMode modes[] = {SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED,
                                         SLUICE_RESIDENCY_MODE_DENSE};
    for (int i = 0; i < 3; i++) {
        SluiceVulkanStreamerCreateInfo info = streamer_info(modes[i]);
        SluiceVulkanBuffers b = {.structSize = sizeof b};
        SluiceVulkanStreamer *streamer;
        fake.has_addresses = info.bufferDeviceAddress = true;
        CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
        CHECK_OK(sluiceGetVulkanBuffers(streamer, &b));
        check_address(b.textureTable, b.textureTableAddress, b.textureTableSize);
        check_address(b.feedback, b.feedbackAddress, b.feedbackSize);
        check_address(b.minMip, b.minMipAddress, b.minMipSize);
        check_address(b.feedbackTurns, b.feedbackTurnsAddress, b.feedbackTurnsSize);
        check_address(b.pageTable, b.pageTableAddress, b.pageTableSize);
        fake_vulkan_destroy(streamer);
        assert_int_equal(fake.live_objects, 0);
    }
}

static void addresses_are_0_unless_they_are_asked_for(void **state)
{
    (void)state;
    SluiceVulkanStreamerCreateInfo info = streamer_info(SLUICE_RESIDENCY_MODE_PAGED);
    SluiceVulkanBuffers b = {.structSize = sizeof b};
    SluiceVulkanStreamer *streamer;
    fake.has_addresses = true;
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    CHECK_OK(sluiceGetVulkanBuffers(streamer, &b));
    assert_true(b.textureTableAddress == 0 && b.pageTableAddress == 0 && b.minMipAddress == 0);
    assert_false(FAKE_OBJECT(b.minMip)->usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
    fake_vulkan_destroy(streamer);
}

static void addresses_that_the_device_lacks_are_refused(void **state)
{
    (void)state;
    SluiceVulkanStreamerCreateInfo info = streamer_info(SLUICE_RESIDENCY_MODE_SPARSE);
    SluiceVulkanStreamer *streamer;
    info.bufferDeviceAddress = true;
    CHECK_RESULT(fake_vulkan_create(&fake, &info, &streamer), SLUICE_ERROR_UNSUPPORTED);
    fake.has_addresses = true;
    fake.missing = "vkGetBufferDeviceAddress";
    CHECK_RESULT(fake_vulkan_create(&fake, &info, &streamer), SLUICE_ERROR_UNSUPPORTED);
    assert_int_equal(fake.live_objects, 0);
}

static SluiceResult read_nothing(SluiceImageSource *source, const SluiceImageRegion *region,
                                 void *texels, size_t row_pitch)
{
    (void)source, (void)region, (void)texels, (void)row_pitch;
    return SLUICE_SUCCESS;
}

static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    (void)source;
    *info = (SluiceImageInfo){.structSize = sizeof *info,
                              .width = 1024,
                              .height = 1024,
                              .mipLevelCount = 11,
                              .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                              .pName = "test"};
    return SLUICE_SUCCESS;
}

static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_nothing, NULL,
                                                     NULL};
static SluiceImageSource source = {&interface};

/* Adds a texture to a streamer of its own; `image` is the object behind its image. */
static SluiceResult add(SluiceVulkanStreamerCreateInfo info, SluiceVulkanTextureCreateInfo create,
                        struct fake_object *image)
{
    SluiceVulkanTexture texture;
    SluiceVulkanStreamer *streamer;
    create.structSize = sizeof create;
    create.source = &source;
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    SluiceResult result = sluiceAddVulkanTexture(streamer, &create, &texture);
    if (result == SLUICE_SUCCESS)
        *image = *FAKE_OBJECT(texture.image);
    fake_vulkan_destroy(streamer);
    assert_int_equal(fake.live_objects, 0);
    return result;
}

static const SluiceResidencyMode with_images[] = {SLUICE_RESIDENCY_MODE_SPARSE,
                                                  SLUICE_RESIDENCY_MODE_DENSE};

static void images_are_mutable_if_asked_for(void **state)
{
    (void)state;
    const VkFormat formats[] = {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R32_UINT};
    for (int i = 0; i < 2; i++) {
        SluiceVulkanStreamerCreateInfo info = streamer_info(with_images[i]);
        struct fake_object image;
        CHECK_OK(add(info, (SluiceVulkanTextureCreateInfo){0}, &image));
        assert_false(image.image_flags & VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT);
        CHECK_OK(add(info, (SluiceVulkanTextureCreateInfo){.mutableFormat = true}, &image));
        assert_true(image.image_flags & VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT);
        assert_int_equal(image.format_count, 0);
        CHECK_OK(add(info,
                     (SluiceVulkanTextureCreateInfo){.pViewFormats = formats, .viewFormatCount = 2},
                     &image));
        assert_true(image.image_flags & VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT);
        assert_int_equal(image.format_count, 3);
        assert_int_equal(image.view_formats[0], VK_FORMAT_R8G8B8A8_UNORM); /* the image's own */
        assert_int_equal(image.view_formats[1], formats[0]);
        assert_int_equal(image.view_formats[2], formats[1]);
    }
}

static void mutable_formats_that_cannot_be_had_are_refused(void **state)
{
    (void)state;
    static const VkFormat formats[17] = {VK_FORMAT_R8G8B8A8_SRGB};
    SluiceVulkanStreamerCreateInfo info = streamer_info(SLUICE_RESIDENCY_MODE_SPARSE);
    struct fake_object image;
    SluiceVulkanTextureCreateInfo create = {.viewFormatCount = 1};
    CHECK_RESULT(add(info, create, &image), SLUICE_ERROR_NULL_POINTER);
    create.pViewFormats = formats;
    create.viewFormatCount = 17;
    CHECK_RESULT(add(info, create, &image), SLUICE_ERROR_INVALID_ARGUMENT);
    create.viewFormatCount = 2; /* the second one is VK_FORMAT_UNDEFINED */
    CHECK_RESULT(add(info, create, &image), SLUICE_ERROR_INVALID_ARGUMENT);
    create.viewFormatCount = 1;
    CHECK_OK(add(info, create, &image));
    for (int i = 0; i < 2; i++) {
        info = streamer_info(with_images[i]);
        fake.lacking_flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT;
        CHECK_RESULT(add(info, create, &image), SLUICE_ERROR_UNSUPPORTED);
    }
    info = streamer_info(SLUICE_RESIDENCY_MODE_PAGED);
    CHECK_RESULT(add(info, create, &image), SLUICE_ERROR_UNSUPPORTED);
}

static void mutable_textures_are_not_forgotten(void **state)
{
    (void)state;
    SluiceVulkanStreamerCreateInfo info = streamer_info(SLUICE_RESIDENCY_MODE_DENSE);
    struct fake_object image = {0};
    info.forgetTextures = true;
    info.textureArray = SLUICE_TEXTURE_ARRAY_COMBINED;
    CHECK_OK(add(info, (SluiceVulkanTextureCreateInfo){.mutableFormat = true}, &image));
    assert_true(image.image_flags & VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT); /* it is there at once */
}

/* A `count` of 0: one family owns it. */
static void check_families(const struct fake_object *object, uint32_t count, const uint32_t *list)
{
    assert_int_equal(object->family_count, count);
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(object->families[i], list[i]);
}

static void check_sharing(const SluiceVulkanContextCreateInfo *context, uint32_t count,
                          const uint32_t *families)
{
    for (int i = 0; i < 2; i++) {
        SluiceVulkanStreamerCreateInfo info = streamer_info(with_images[i]);
        SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = &source};
        SluiceVulkanBuffers b = {.structSize = sizeof b};
        SluiceVulkanTexture texture;
        SluiceVulkanStreamer *streamer;
        fake_vulkan_context_info(&fake); /* the lock that `context` points to */
        CHECK_OK(sluiceCreateVulkanContext(context, &info.context));
        CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
        CHECK_OK(sluiceAddVulkanTexture(streamer, &create, &texture));
        CHECK_OK(sluiceGetVulkanBuffers(streamer, &b));
        check_families(FAKE_OBJECT(texture.image), count, families);
        check_families(FAKE_OBJECT(b.feedback), count, families);
        fake_vulkan_destroy(streamer);
    }
}

static void images_and_buffers_are_shared_by_all_families(void **state)
{
    (void)state;
    const uint32_t sampling[] = {FAKE_COMPUTE_FAMILY, 0}, both[] = {0, FAKE_COMPUTE_FAMILY},
                   with_uploads[] = {0, FAKE_TRANSFER_FAMILY};
    SluiceVulkanContextCreateInfo context = fake_vulkan_context_info(&fake);
    check_sharing(&context, 0, NULL);
    context.pSamplingQueueFamilies = sampling;
    context.samplingQueueFamilyCount = 2;
    check_sharing(&context, 2, both);
    context.samplingQueueFamilyCount = 0;
    context.uploadQueue = (VkQueue)(void *)&fake;
    context.uploadQueueFamilyIndex = 0;
    check_sharing(&context, 0, NULL);
    context.uploadQueueFamilyIndex = FAKE_TRANSFER_FAMILY;
    check_sharing(&context, 2, with_uploads);
}

static void families_that_cannot_sample_are_refused(void **state)
{
    (void)state;
    const uint32_t none[] = {FAKE_FAMILIES}, copies[] = {FAKE_TRANSFER_FAMILY};
    SluiceVulkanContext *created;
    fake = (struct fake_vulkan){.tail_page_count = 1};
    SluiceVulkanContextCreateInfo context = fake_vulkan_context_info(&fake);
    context.samplingQueueFamilyCount = 1;
    CHECK_RESULT(sluiceCreateVulkanContext(&context, &created), SLUICE_ERROR_NULL_POINTER);
    context.pSamplingQueueFamilies = none;
    CHECK_RESULT(sluiceCreateVulkanContext(&context, &created), SLUICE_ERROR_INVALID_ARGUMENT);
    context.pSamplingQueueFamilies = copies;
    CHECK_RESULT(sluiceCreateVulkanContext(&context, &created), SLUICE_ERROR_INVALID_ARGUMENT);
    context.samplingQueueFamilyCount = 7;
    CHECK_RESULT(sluiceCreateVulkanContext(&context, &created), SLUICE_ERROR_INVALID_ARGUMENT);
    context.samplingQueueFamilyCount = 0;
    context.uploadQueue = (VkQueue)(void *)&fake;
    context.uploadQueueFamilyIndex = FAKE_FAMILIES;
    CHECK_RESULT(sluiceCreateVulkanContext(&context, &created), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_int_equal(fake.live_objects, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buffers_have_addresses_and_sizes),
        cmocka_unit_test(addresses_are_0_unless_they_are_asked_for),
        cmocka_unit_test(addresses_that_the_device_lacks_are_refused),
        cmocka_unit_test(images_are_mutable_if_asked_for),
        cmocka_unit_test(mutable_formats_that_cannot_be_had_are_refused),
        cmocka_unit_test(mutable_textures_are_not_forgotten),
        cmocka_unit_test(images_and_buffers_are_shared_by_all_families),
        cmocka_unit_test(families_that_cannot_sample_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
