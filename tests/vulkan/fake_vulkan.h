/**
 * A Vulkan device that does nothing but take notes, so that the order in which a streamer binds,
 * copies and publishes can be checked with any timing of frames and of the binding queue.
 *
 * Images are RGBA8 with tiles of 128x128. Feedback is what the test says it is.
 */
#ifndef TESTS_VULKAN_FAKE_VULKAN_H
#define TESTS_VULKAN_FAKE_VULKAN_H

#include <sluice/shared/resolve.h>
#include <sluice/vulkan.h>

#define FAKE_TILE 128u
#define FAKE_TAIL UINT32_MAX
#define FAKE_TAIL_STRIDE (1ull << 24) ///< from layer to layer
#define FAKE_EVENTS 4096u
#define FAKE_WORDS 65536u

/** Queue families: 0 does everything. */
#define FAKE_FAMILIES 4u
#define FAKE_TRANSFER_FAMILY 1u ///< nothing else
#define FAKE_SPARSE_FAMILY 2u   ///< binds, does not compute
#define FAKE_COMPUTE_FAMILY 3u  ///< does not bind

/** One page; merged runs are taken apart. */
struct fake_bind {
    VkImage image;
    uint32_t level, x, y;  ///< in tiles; level FAKE_TAIL: page x of the tail
    VkDeviceMemory memory; ///< VK_NULL_HANDLE: unbound
    uint64_t offset;
};

struct fake_copy {
    VkImage image;
    uint32_t level, layer, x, y; ///< in tiles
    uint32_t texel;              ///< the first four bytes
    bool early;                  ///< on the upload queue
    VkImage from;                ///< from this layer of an image; VK_NULL_HANDLE: from a buffer
    uint32_t from_layer;
};

#define FAKE_SETS 16u
#define FAKE_SET_BUFFERS 8u
#define FAKE_SET_IMAGES 256u

/** A descriptor set for the application's shaders: the first binding of images, and the next. */
struct fake_set {
    VkDescriptorPool pool; ///< VK_NULL_HANDLE: not allocated
    uint32_t first_image;  ///< its first binding of images
    VkBuffer buffers[FAKE_SET_BUFFERS];
    VkDescriptorImageInfo images[2][FAKE_SET_IMAGES];
    uint64_t write_count;
};

struct fake_vulkan {
    uint32_t tail_page_count; ///< 0: no tail
    uint64_t metadata_size;   ///< of every image; 0: none
    uint64_t metadata_binds;

    /** Values of the two timelines; the test sets them. */
    uint64_t frame_value, bind_value;
    uint64_t submitted_bind_value;
    VkSemaphore bind_semaphore;
    VkSemaphore frame_semaphore; ///< set by the test once a frame has told

    /** The upload queue. The test sets has_upload_queue before the context, then upload_value. */
    bool has_upload_queue;
    VkExtent3D granularity; ///< of its family; zeroed: 1 in all directions
    bool whole_levels;      ///< its family copies these alone
    uint64_t upload_value, submitted_upload_value;
    VkSemaphore upload_semaphore;
    bool records_uploads; ///< between begin and end of a command buffer of the library
    uint64_t now_frame;   ///< that the test begins: images get their layout in it

    /** Events since the test last set the counts to 0. */
    struct fake_bind binds[FAKE_EVENTS];
    struct fake_copy copies[FAKE_EVENTS];
    VkImage destroyed_images[FAKE_EVENTS];
    VkDeviceMemory freed_memories[FAKE_EVENTS];
    uint32_t bind_count, copy_count, destroyed_count, freed_count, bind_calls;
    bool published;      ///< copies to images are over: MinMip maps were copied
    uint64_t copy_calls; ///< of MinMip maps, in all

    /** Layouts that fake_vulkan_undo takes back to the last fake_vulkan_mark. */
    struct fake_object *general[FAKE_EVENTS]; ///< images that got their layout since
    uint32_t general_count;

    /** The call that fails, counted from 1 among those that may; 0: none. And its result. */
    uint64_t calls, failing_call;
    VkResult failure;
    bool fails_on;         ///< and so do all later ones, vkDeviceWaitIdle among them
    uint64_t layer_size;   ///< bytes of a layer of an image; 0: 16 MiB for all layers together
    uint64_t memory_limit; ///< bytes that the device has; 0: as many as are asked for
    uint64_t refused_size; ///< allocations of so many bytes fail; 0: none
    uint64_t heap_size;    ///< bytes of the only heap of memory; 0: 1 TiB

    /** The device has VK_EXT_memory_budget. The budget is the whole heap; other programs use
     *  used_by_others. */
    bool has_memory_budget;
    uint64_t used_by_others;  ///< bytes
    uint32_t extension_calls; ///< calls that list extensions
    uint32_t budget_calls;

    /** Buffers that the test set, and the words that were filled in and updated there. */
    struct fake_watch {
        VkBuffer buffer;
        uint32_t words[FAKE_WORDS];
        uint32_t marked[FAKE_WORDS];
    } watches[2];

    /** Waits: each device wait, and the semaphores that were waited for. */
    uint32_t device_waits;
    struct fake_wait {
        VkSemaphore semaphore;
        uint64_t value, timeout;
        uint64_t live_objects; ///< at that time
    } waits[64];
    uint32_t wait_count;
    bool waits_signal;   ///< a wait moves the frames' timeline to its value
    bool waits_time_out; ///< where the timeline has not reached the value; else all waits succeed
    bool no_resolve;     ///< compute passes leave no trace: for the demand loader

    /** Settings of the next context. Zeroed: no callbacks, defaults, and one thread. */
    SluiceLogCallback log;
    const SluiceAllocationCallbacks *pAllocator;
    uint32_t loaderThreadCount, maxPageChunkCount;
    SluiceTileRetryPolicy readRetry;
    uint64_t minStagingSize, minTileMemorySize;
    uint32_t maxBindsPerCall;
    const SluiceJobSystem *pJobSystem;
    SluiceReadPool *readPool; ///< Has the threads, then.
    bool no_queue_lock;       ///< else calls outside the queue lock are failures

    SluiceVulkanQueueLockCallbacks queue_lock;
    VkQueue locked_queue; ///< VK_NULL_HANDLE: all
    uint32_t lock_depth;  ///< 0: unlocked
    uint64_t lock_count;  ///< since the start

    VkImageCreateFlags lacking_flags;   ///< It has no images with any of these.
    bool has_addresses;                 ///< It has the feature bufferDeviceAddress.
    bool no_linear_filter;              ///< Its format is sampled with NEAREST filters only.
    VkSamplerCreateInfo newest_sampler; ///< pNext is NULL
    uint32_t sampler_count;             ///< created

    const char *missing; ///< function that neither instance nor device has; NULL: none

    uint64_t live_objects; ///< created and not destroyed
    /** Buffers, images, views, memory, pipelines, semaphores without a name; and that got one. */
    uint64_t unnamed_objects, named_count;
    uint64_t live_memory; ///< bytes

    void *user;
    /** The feedback of one region, by its index in the feedback buffer. */
    uint8_t (*want)(void *user, uint32_t region);
    uint32_t damage_count; ///< so many results that are resolved next have a wrong checksum
    uint32_t whole_count;  ///< items of which the whole map was asked for

    struct fake_set sets[FAKE_SETS]; ///< of layouts with images, first free first
    uint32_t set_count;
    uint32_t max_samplers; ///< per stage; 0: a million

    struct fake_object *table, *readback; ///< buffers of the resolve passes
    struct SluiceResolveParams push;
    uint32_t dispatch_count;
};

/** Fills in the times: if ticksPerSecond is 0, time stamps count frames, and 0 is the newest
 *  map alone, no standby tiles, and a second try at once. */
void fake_vulkan_fill(SluiceVulkanStreamerCreateInfo *info);
/** Settings of a context on the device, with those of `fake`. */
SluiceVulkanContextCreateInfo fake_vulkan_context_info(struct fake_vulkan *fake);
/** Creates a streamer on a context of its own. `*streamer` is NULL after an error. */
SluiceResult fake_vulkan_create(struct fake_vulkan *fake, SluiceVulkanStreamerCreateInfo *info,
                                SluiceVulkanStreamer **streamer);
/** Destroys the streamer and its context. NULL is allowed. */
void fake_vulkan_destroy(SluiceVulkanStreamer *streamer);
VkImage fake_vulkan_image_of(VkImageView view);
VkCommandBuffer fake_vulkan_commands(struct fake_vulkan *fake);
/** Commands that were recorded between these calls are never submitted: layouts and watched buffers
 *  are as they were. */
void fake_vulkan_mark(struct fake_vulkan *fake);
void fake_vulkan_undo(struct fake_vulkan *fake);

#endif /* TESTS_VULKAN_FAKE_VULKAN_H */
