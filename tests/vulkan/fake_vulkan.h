/**
 * A Vulkan device that only records its calls. Tests can check the order of binds, copies and
 * publication with any timing of frames and of the binding queue.
 *
 * Images are RGBA8 with tiles of 128x128. The test supplies the feedback.
 */
#ifndef TESTS_VULKAN_FAKE_VULKAN_H
#define TESTS_VULKAN_FAKE_VULKAN_H

#include <sluice/shared/resolve.h>
#include <sluice/vulkan.h>

#define FAKE_TILE 128u
#define FAKE_TAIL UINT32_MAX
#define FAKE_TAIL_STRIDE (1ull << 24) ///< stride between layers
#define FAKE_EVENTS 4096u
#define FAKE_WORDS 65536u

/** Queue families. Family 0 does everything. */
#define FAKE_FAMILIES 4u
#define FAKE_TRANSFER_FAMILY 1u ///< transfer only
#define FAKE_SPARSE_FAMILY 2u   ///< binds, but does not compute
#define FAKE_COMPUTE_FAMILY 3u  ///< does not bind

/** A bound page. Merged runs are split. */
struct fake_bind {
    VkImage image;
    uint32_t level, x, y;  ///< in tiles; level FAKE_TAIL: page x of the tail
    VkDeviceMemory memory; ///< VK_NULL_HANDLE: unbound
    uint64_t offset;
};

struct fake_copy {
    VkImage image;
    uint32_t level, layer, x, y; ///< in tiles
    uint32_t texel;              ///< first four bytes
    bool early;                  ///< true: copied on the upload queue
    VkImage from;                ///< source image, layer `from_layer`; VK_NULL_HANDLE: a buffer
    uint32_t from_layer;
};

#define FAKE_SETS 16u
#define FAKE_SET_BUFFERS 8u
#define FAKE_SET_IMAGES 256u

/** A descriptor set for the application's shaders: two bindings of images. */
struct fake_set {
    VkDescriptorPool pool; ///< VK_NULL_HANDLE: not allocated
    uint32_t first_image;  ///< first binding of images
    VkBuffer buffers[FAKE_SET_BUFFERS];
    VkDescriptorImageInfo images[2][FAKE_SET_IMAGES];
    uint64_t write_count;
};

struct fake_vulkan {
    uint32_t tail_page_count; ///< 0: no tail
    uint64_t metadata_size;   ///< metadata bytes of every image; 0: none
    uint64_t metadata_binds;

    /** Values of the two timelines. Set by the test. */
    uint64_t frame_value, bind_value;
    uint64_t submitted_bind_value;
    VkSemaphore bind_semaphore;
    VkSemaphore frame_semaphore; ///< set by the test once a frame has returned it

    /** The upload queue. The test sets has_upload_queue before the context is created, then
     * upload_value. */
    bool has_upload_queue;
    VkExtent3D granularity; ///< granularity of its family; zeroed: 1 in all directions
    bool whole_levels;      ///< true: its family copies whole levels only
    uint64_t upload_value, submitted_upload_value;
    VkSemaphore upload_semaphore;
    bool records_uploads; ///< true: a command buffer of the library is being recorded
    uint64_t now_frame;   ///< frame that the test begins; images get their layout in it

    /** Events since the test reset the counts. */
    struct fake_bind binds[FAKE_EVENTS];
    struct fake_copy copies[FAKE_EVENTS];
    VkImage destroyed_images[FAKE_EVENTS];
    VkDeviceMemory freed_memories[FAKE_EVENTS];
    uint32_t bind_count, copy_count, destroyed_count, freed_count, bind_calls;
    bool published;      ///< true: MinMip maps were copied, so copies to images are over
    uint64_t copy_calls; ///< copies of MinMip maps, in total

    /** Layouts that fake_vulkan_undo resets to the last fake_vulkan_mark. */
    struct fake_object *general[FAKE_EVENTS]; ///< images that got their layout since
    uint32_t general_count;

    /** number, from 1, of the failing call among those that may fail, and its result; 0: none */
    uint64_t calls, failing_call;
    VkResult failure;
    bool fails_on;         ///< true: later calls fail too, including vkDeviceWaitIdle
    uint64_t layer_size;   ///< bytes of a layer of an image; 0: 16 MiB for all layers together
    uint64_t memory_limit; ///< device memory in bytes; 0: unlimited
    uint64_t refused_size; ///< allocations of this size fail; 0: none
    uint64_t heap_size;    ///< bytes of the only memory heap; 0: 1 TiB

    /** Has VK_EXT_memory_budget. The budget is the whole heap; other programs use
     * used_by_others. */
    bool has_memory_budget;
    uint64_t used_by_others;  ///< bytes
    uint32_t extension_calls; ///< calls that list extensions
    uint32_t budget_calls;

    /** Buffers set by the test, and the words that were filled and updated in them. */
    struct fake_watch {
        VkBuffer buffer;
        uint32_t words[FAKE_WORDS];
        uint32_t marked[FAKE_WORDS];
    } watches[2];

    /** Waits for the device and for semaphores. */
    uint32_t device_waits;
    struct fake_wait {
        VkSemaphore semaphore;
        uint64_t value, timeout;
        uint64_t live_objects; ///< live objects at that time
    } waits[64];
    uint32_t wait_count;
    bool waits_signal;   ///< true: a wait moves the frames' timeline to its value
    bool waits_time_out; ///< true: waits time out below the value; false: all waits succeed
    bool no_resolve;     ///< true: compute passes are not recorded; for the demand loader

    /** Settings of the next context. Zeroed: no callbacks, defaults, one thread. */
    SluiceLogCallback log;
    const SluiceAllocationCallbacks *pAllocator;
    uint32_t loaderThreadCount, maxPageChunkCount;
    SluiceTileRetryPolicy readRetry;
    uint64_t minStagingSize, minTileMemorySize;
    uint32_t maxBindsPerCall;
    const SluiceJobSystem *pJobSystem;
    SluiceReadPool *readPool; ///< if set, provides the threads
    bool no_queue_lock;       ///< true: calls outside the queue lock are allowed

    SluiceVulkanQueueLockCallbacks queue_lock;
    VkQueue locked_queue; ///< VK_NULL_HANDLE: all queues
    uint32_t lock_depth;  ///< 0: unlocked
    uint64_t lock_count;  ///< since the start

    VkImageCreateFlags lacking_flags;   ///< Images with any of these flags are unsupported.
    bool has_addresses;                 ///< Supports bufferDeviceAddress.
    bool no_linear_filter;              ///< Its format supports NEAREST filters only.
    VkSamplerCreateInfo newest_sampler; ///< pNext is NULL
    uint32_t sampler_count;             ///< number of created samplers

    const char *missing; ///< function that instance and device lack; NULL: none

    uint64_t live_objects; ///< created and not destroyed
    /** Buffers, images, views, memory, pipelines and semaphores without a name; and objects that
     * were named. */
    uint64_t unnamed_objects, named_count;
    uint64_t live_memory; ///< bytes

    void *user;
    /** Returns the feedback of a region. `region`: its index in the feedback buffer. */
    uint8_t (*want)(void *user, uint32_t region);
    uint32_t damage_count; ///< number of next resolve results with a wrong checksum
    uint32_t whole_count;  ///< number of items whose whole map was requested

    struct fake_set sets[FAKE_SETS]; ///< sets of layouts with images; the first free one is used
    uint32_t set_count;
    uint32_t max_samplers; ///< per stage; 0: one million

    struct fake_object *table, *readback; ///< Buffers of the resolve passes.
    struct SluiceResolveParams push;
    uint32_t dispatch_count;
};

/** Fills in times. If ticksPerSecond is 0: time stamps count frames, the timeout uses the newest
 * map only, no standby tiles, immediate retries. */
void fake_vulkan_fill(SluiceVulkanStreamerCreateInfo *info);
/** Returns settings of a context on the device, including those of `fake`. */
SluiceVulkanContextCreateInfo fake_vulkan_context_info(struct fake_vulkan *fake);
/** Creates a streamer with a context of its own. `*streamer` is NULL after an error. */
SluiceResult fake_vulkan_create(struct fake_vulkan *fake, SluiceVulkanStreamerCreateInfo *info,
                                SluiceVulkanStreamer **streamer);
/** Destroys the streamer and its context. Accepts NULL. */
void fake_vulkan_destroy(SluiceVulkanStreamer *streamer);
VkImage fake_vulkan_image_of(VkImageView view);
VkCommandBuffer fake_vulkan_commands(struct fake_vulkan *fake);
/** Commands recorded between these calls are never submitted: fake_vulkan_undo restores layouts and
 * watched buffers. */
void fake_vulkan_mark(struct fake_vulkan *fake);
void fake_vulkan_undo(struct fake_vulkan *fake);

#endif /* TESTS_VULKAN_FAKE_VULKAN_H */
