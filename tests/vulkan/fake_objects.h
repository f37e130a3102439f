/**
 * Objects that handles of the fake device point to, and calls that fail when the test says so.
 *
 * Dispatchable handles are the device itself.
 */
#ifndef TESTS_VULKAN_FAKE_OBJECTS_H
#define TESTS_VULKAN_FAKE_OBJECTS_H

#include "vulkan/fake_vulkan.h"

/** Object behind a handle that is not dispatchable. */
struct fake_object {
    VkExtent3D extent;
    uint32_t level_count, layer_count;
    uint64_t size;
    void *memory;
    VkBufferUsageFlags usage;    ///< buffers
    VkMemoryAllocateFlags flags; ///< memory
    VkImage image;               ///< views
    VkImageCreateFlags image_flags;
    VkFormat view_formats[32]; ///< images: formats of views, format_count of them
    uint32_t format_count;
    uint32_t families[8]; ///< images, buffers: family_count sharing families; 0: exclusive
    uint32_t family_count;
    bool general;           ///< images: true in layout GENERAL
    uint64_t general_frame; ///< frame in which the image got that layout
    bool has_name, needs_name;
    uint32_t first_image; ///< set layouts: first binding of images; UINT32_MAX: buffers only
};

#define FAKE_OBJECT(handle) ((struct fake_object *)(handle))

/** Returns the device of a dispatchable handle. */
static inline struct fake_vulkan *fake_of(void *handle)
{
    return handle;
}

/** Counts the calls of functions that may fail. Returns the test's error if this one fails. */
VkResult fake_next_call(struct fake_vulkan *fake);

/** Makes a function that may fail return its error. `handle` is dispatchable. */
#define FAKE_MAY_FAIL(handle)                                                                      \
    do {                                                                                           \
        VkResult status = fake_next_call(fake_of(handle));                                         \
        if (status != VK_SUCCESS)                                                                  \
            return status;                                                                         \
    } while (0)

/** Notes which families share an image or buffer. */
#define FAKE_SHARE(object, info)                                                                   \
    do {                                                                                           \
        if ((info)->sharingMode == VK_SHARING_MODE_CONCURRENT)                                     \
            for (; (object)->family_count < (info)->queueFamilyIndexCount;                         \
                 (object)->family_count++)                                                         \
                (object)->families[(object)->family_count] =                                       \
                    (info)->pQueueFamilyIndices[(object)->family_count];                           \
    } while (0)

/** Creates a live object of `size` bytes. */
void *fake_make(struct fake_vulkan *fake, uint64_t size);
/** Creates an object of a kind that debuggers show. */
void *fake_make_shown(struct fake_vulkan *fake, uint64_t size);
/** Destroys an object. NULL is allowed. */
void fake_drop(struct fake_vulkan *fake, void *object);

#endif /* TESTS_VULKAN_FAKE_OBJECTS_H */
