#include "renderer.h"

#include "../../tools/common/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool upload(const struct gpu *gpu, const void *data, size_t size, bool for_builds,
                   struct gpu_buffer *buffer)
{
    VkBufferUsageFlags usage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | (for_builds ? ACCEL_INPUT_USAGE : 0);
    if (!gpu_create_buffer(gpu, size, usage, buffer))
        return false;
    memcpy(buffer->mapped, data, size);
    return true;
}

static bool upload_scene(const struct gpu *gpu, const struct renderer_request *request,
                         struct renderer *r)
{
    const struct scene *scene = request->scene;
    const struct mesh *mesh = &scene->mesh;
    if (!upload(gpu, mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices, r->uses_pipeline,
                &r->vertices) ||
        !upload(gpu, mesh->indices, mesh->index_count * sizeof *mesh->indices, r->uses_pipeline,
                &r->indices) ||
        !upload(gpu, scene->instances, scene->instance_count * sizeof *scene->instances, false,
                &r->instances) ||
        !upload(gpu, scene->bvh.nodes, scene->bvh.count * sizeof *scene->bvh.nodes, false,
                &r->nodes))
        return false;
    struct TracerInstance *instances = r->instances.mapped;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        instances[i].texture =
            textures_index(request->textures, request->texture_ids, scene->instances[i].texture);
    return true;
}

static void write_vector(struct vec3 v, float out[3])
{
    out[0] = v.x, out[1] = v.y, out[2] = v.z;
}

void renderer_set_camera(struct renderer *r, const struct tracer_options *options,
                         const struct scene_camera *camera)
{
    const float width = (float)options->size[0], height = (float)options->size[1];
    const float half = tanf(0.5f * camera->field_of_view);
    struct TracerLaunch *constants = &r->constants;
    *constants = (struct TracerLaunch){.width = options->size[0],
                                       .height = options->size[1],
                                       .spread = atanf(2.0f * half / height),
                                       .seed = options->seed,
                                       .bounces = options->bounces};
    struct vec3 forward = vec3_normalize(vec3_sub(camera->target, camera->eye));
    struct vec3 right = vec3_normalize(vec3_cross(forward, (struct vec3){0, 1, 0}));
    write_vector(camera->eye, constants->eye);
    write_vector(forward, constants->forward);
    write_vector(vec3_scale(right, half * width / height), constants->right);
    write_vector(vec3_scale(vec3_cross(right, forward), half), constants->up);
}

/** Chooses pipeline or compute shader. Returns false if the device lacks the requested one. */
static bool choose_path(const struct gpu *gpu, int choice, struct renderer *r)
{
    r->uses_pipeline = gpu->ray_tracing && choice != PATH_COMPUTE;
    if (gpu->ray_tracing || choice == PATH_COMPUTE)
        return true;
    text_say("%s has no ray-tracing pipeline%s", gpu->properties.deviceName,
             choice == PATH_AUTO ? ": rays are traced in a compute shader, which is slower" : "");
    return choice == PATH_AUTO;
}

static bool create_pipeline(const struct gpu *gpu, const struct tracer_options *options,
                            const struct scene *scene, struct renderer *r)
{
    if (r->uses_pipeline)
        return ray_pipeline_create(gpu, r->bindings.layout, options->preview, options->needs,
                                   &r->rays);
    return compute_pipeline_create(gpu, r->bindings.layout, options->preview, options->needs,
                                   scene->bvh.scene_root, &r->compute);
}

bool renderer_create(const struct gpu *gpu, const struct renderer_request *given,
                     struct renderer *r)
{
    const struct tracer_options *options = given->options;
    const struct film *film = given->film;
    *r = (struct renderer){0};
    renderer_set_camera(r, options, &options->view);
    if (!choose_path(gpu, options->path, r) || !upload_scene(gpu, given, r) ||
        !needs_create(gpu, options->needs, &r->needs) ||
        (r->uses_pipeline &&
         !accel_build(gpu, given->scene, r->vertices.buffer, r->indices.buffer, &r->accel)))
        return false;
    const struct bindings_request request = {
        .loader = given->loader,
        .own_buffers = {[TRACER_BINDING_VERTICES] = r->vertices.buffer,
                        [TRACER_BINDING_INDICES] = r->indices.buffer,
                        [TRACER_BINDING_INSTANCES] = r->instances.buffer,
                        [TRACER_BINDING_NODES] = r->nodes.buffer,
                        [TRACER_BINDING_FILM] = film->sums.buffer,
                        [TRACER_BINDING_LATEST] = film->latest.buffer,
                        [TRACER_BINDING_LISTS] = film->lists.buffer,
                        [TRACER_BINDING_COUNTERS] = film->counters.buffer,
                        [TRACER_BINDING_NEEDS] = r->needs.pages.buffer},
        .scene = r->accel.scene.handle,
    };
    return bindings_create(gpu, &request, &r->bindings) &&
           create_pipeline(gpu, options, given->scene, r);
}

void renderer_destroy(const struct gpu *gpu, struct renderer *r)
{
    ray_pipeline_destroy(gpu, &r->rays);
    vkDestroyPipeline(gpu->device, r->compute, NULL);
    bindings_destroy(gpu, &r->bindings);
    accel_finish(gpu, &r->accel);
    gpu_destroy_buffer(gpu, &r->vertices);
    gpu_destroy_buffer(gpu, &r->indices);
    gpu_destroy_buffer(gpu, &r->instances);
    gpu_destroy_buffer(gpu, &r->nodes);
    needs_destroy(gpu, &r->needs);
}

void renderer_record(struct renderer *r, VkDescriptorSet demand_set, const struct film *film,
                     uint32_t sample, VkCommandBuffer commands)
{
    struct TracerLaunch launch = r->constants;
    launch.count = film->missing_count;
    launch.sampleIndex = sample;
    launch.listIndex = film->list_index;
    if (r->uses_pipeline) {
        bindings_bind(&r->bindings, commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, demand_set,
                      &launch);
        ray_pipeline_record(&r->rays, commands, launch.count);
    } else {
        bindings_bind(&r->bindings, commands, VK_PIPELINE_BIND_POINT_COMPUTE, demand_set, &launch);
        compute_pipeline_record(r->compute, commands, launch.count);
    }
    film_record_end(commands);
}
