/**
 * Vulkan functions that the fake device has.
 *
 * Each source file of the device lists its own functions. fake_vulkan.c finds them by name.
 */
#ifndef TESTS_VULKAN_FAKE_FUNCTIONS_H
#define TESTS_VULKAN_FAKE_FUNCTIONS_H

#include "vulkan/fake_vulkan.h"

/** A function. Lists end with a NULL name. */
struct fake_function {
    const char *name; ///< Vulkan's name, such as vkCreateImage
    PFN_vkVoidFunction function;
};

/** Element of a list. `name` is spelled without vk. */
#define FAKE_FUNCTION(name, function)                                                              \
    {                                                                                              \
        "vk" #name, (PFN_vkVoidFunction)function                                                   \
    }

extern const struct fake_function fake_property_functions[];   ///< fake_properties.c
extern const struct fake_function fake_object_functions[];     ///< fake_objects.c
extern const struct fake_function fake_image_functions[];      ///< fake_images.c
extern const struct fake_function fake_buffer_functions[];     ///< fake_buffers.c
extern const struct fake_function fake_queue_functions[];      ///< fake_queue.c
extern const struct fake_function fake_descriptor_functions[]; ///< fake_descriptors.c
extern const struct fake_function fake_command_functions[];    ///< fake_commands.c
extern const struct fake_function fake_pass_functions[];       ///< fake_passes.c

#endif /* TESTS_VULKAN_FAKE_FUNCTIONS_H */
