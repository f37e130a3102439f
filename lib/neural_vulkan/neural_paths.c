#include <sluice/neural_paths.h>

#include "base/alloc.h"
#include "base/struct_size.h"
#include "neural_vulkan/cooperative.h"

#include <assert.h>
#include <string.h>

/* Query state: functions and struct chains of one device. */
struct question {
    VkInstance instance;
    VkPhysicalDevice device;
    PFN_vkGetInstanceProcAddr get;
    SluiceAllocationCallbacks cb;
    PFN_vkEnumerateDeviceExtensionProperties enumerate;
    PFN_vkGetPhysicalDeviceFeatures2 get_features;
    PFN_vkGetPhysicalDeviceProperties2 get_properties;
    bool has_dot, has_vector, has_matrix, has_control; ///< extensions
    uint32_t subgroup_size;
};

/* Errors: OUT_OF_HOST_MEMORY. */
static SluiceResult find_extensions(struct question *q)
{
    uint32_t count = 0, written;
    if (q->enumerate(q->device, NULL, &count, NULL) < 0 || count == 0)
        return SLUICE_SUCCESS;
    VkExtensionProperties *list = slc_alloc(&q->cb, count, sizeof *list);
    if (!list)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    written = count;
    if (q->enumerate(q->device, NULL, &written, list) >= 0)
        for (uint32_t i = 0; i < written; i++) {
            const char *name = list[i].extensionName;
            q->has_dot |= strcmp(name, VK_KHR_SHADER_INTEGER_DOT_PRODUCT_EXTENSION_NAME) == 0;
            q->has_vector |= strcmp(name, SLC_VECTOR_EXTENSION) == 0;
            q->has_matrix |= strcmp(name, SLC_MATRIX_EXTENSION) == 0;
            q->has_control |= strcmp(name, VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME) == 0;
        }
    slc_free(&q->cb, list, count, sizeof *list);
    return SLUICE_SUCCESS;
}

/* Queries features. The chain contains structs of available extensions only. */
static void get_features(const struct question *q, SluiceNeuralPaths *paths)
{
    VkPhysicalDeviceShaderIntegerDotProductFeaturesKHR dot = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_INTEGER_DOT_PRODUCT_FEATURES_KHR};
    struct slc_cooperative_features vector = {.sType = (VkStructureType)SLC_VECTOR_FEATURES};
    struct slc_cooperative_features matrix = {.sType = (VkStructureType)SLC_MATRIX_FEATURES};
    VkPhysicalDeviceSubgroupSizeControlFeaturesEXT control = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES_EXT};
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &vulkan12};
    if (q->has_dot) {
        dot.pNext = vulkan12.pNext;
        vulkan12.pNext = &dot;
    }
    if (q->has_vector) {
        vector.pNext = vulkan12.pNext;
        vulkan12.pNext = &vector;
    }
    if (q->has_matrix) {
        matrix.pNext = vulkan12.pNext;
        vulkan12.pNext = &matrix;
    }
    if (q->has_control) {
        control.pNext = vulkan12.pNext;
        vulkan12.pNext = &control;
    }
    q->get_features(q->device, &features);
    paths->integerDot = dot.shaderIntegerDotProduct;
    paths->half = vulkan12.shaderFloat16;
    paths->vectorInt8 = vector.cooperative && vulkan12.vulkanMemoryModel;
    paths->vectorFp8 = paths->vectorInt8 && vulkan12.shaderFloat16;
    paths->matrix = matrix.cooperative && vulkan12.vulkanMemoryModel && vulkan12.shaderInt8 &&
                    control.computeFullSubgroups;
}

/* Queries the stages that support the features, and the subgroup size. */
static void get_properties(struct question *q, SluiceNeuralPaths *paths)
{
    struct slc_vector_properties vector = {.sType = (VkStructureType)SLC_VECTOR_PROPERTIES};
    struct slc_matrix_properties matrix = {.sType = (VkStructureType)SLC_MATRIX_PROPERTIES};
    VkPhysicalDeviceSubgroupProperties subgroup = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup};
    if (q->has_vector) {
        vector.pNext = subgroup.pNext;
        subgroup.pNext = &vector;
    }
    if (q->has_matrix) {
        matrix.pNext = subgroup.pNext;
        subgroup.pNext = &matrix;
    }
    q->get_properties(q->device, &properties);
    bool has_vector = (vector.stages & VK_SHADER_STAGE_COMPUTE_BIT) && vector.maxComponents >= 96;
    paths->vectorInt8 = paths->vectorInt8 && has_vector;
    paths->vectorFp8 = paths->vectorFp8 && has_vector;
    paths->vectorStages = vector.stages;
    paths->matrix = paths->matrix && (matrix.stages & VK_SHADER_STAGE_COMPUTE_BIT);
    q->subgroup_size = subgroup.subgroupSize;
}

static bool is_combination(const struct slc_vector_combination *c, int32_t input, int32_t read_as,
                           int32_t matrix, int32_t bias, int32_t result)
{
    return c->inputType == input && c->inputInterpretation == read_as &&
           c->matrixInterpretation == matrix && c->biasInterpretation == bias &&
           c->resultType == result;
}

/* Keeps vector paths whose types are listed. Errors: OUT_OF_HOST_MEMORY. */
static SluiceResult check_vectors(const struct question *q, SluiceNeuralPaths *paths)
{
    slc_get_vector_combinations get = (slc_get_vector_combinations)q->get(
        q->instance, "vkGetPhysicalDeviceCooperativeVectorPropertiesNV");
    uint32_t count = 0;
    bool int8 = false, fp8 = false;
    if (paths->vectorInt8 && get && get(q->device, &count, NULL) >= 0 && count) {
        struct slc_vector_combination *list = slc_calloc(&q->cb, count, sizeof *list);
        uint32_t written = count;
        if (!list)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint32_t i = 0; i < count; i++)
            list[i].sType = (VkStructureType)SLC_VECTOR_COMBINATION;
        written = get(q->device, &written, list) >= 0 ? written : 0;
        for (uint32_t i = 0; i < written; i++) {
            int8 |= is_combination(&list[i], SLC_COMPONENT_UINT32, SLC_COMPONENT_SINT8_PACKED,
                                   SLC_COMPONENT_SINT8, SLC_COMPONENT_SINT32, SLC_COMPONENT_SINT32);
            fp8 |= is_combination(&list[i], SLC_COMPONENT_FLOAT16, SLC_COMPONENT_E4M3,
                                  SLC_COMPONENT_E4M3, SLC_COMPONENT_FLOAT16, SLC_COMPONENT_FLOAT16);
        }
        slc_free(&q->cb, list, count, sizeof *list);
    }
    paths->vectorInt8 = paths->vectorInt8 && int8;
    paths->vectorFp8 = paths->vectorFp8 && int8 && fp8; /* the last layer is int8 */
    if (!paths->vectorInt8)
        paths->vectorStages = 0;
    return SLUICE_SUCCESS;
}

/* Tells whether neural_matrix.glsl can use a shape. Rows of weights are loaded as words, and layers
 * have a multiple of 16 outputs. */
static bool is_usable(const struct question *q, const struct slc_matrix_combination *c)
{
    return c->aType == SLC_COMPONENT_SINT8 && c->bType == SLC_COMPONENT_SINT8 &&
           c->cType == SLC_COMPONENT_SINT32 && c->resultType == SLC_COMPONENT_SINT32 &&
           !c->saturates && c->scope == SLC_SCOPE_SUBGROUP && c->m > 0 && c->n > 0 && c->k >= 4 &&
           c->k <= 32 && 16 % c->m == 0 && 32 % c->k == 0 && q->subgroup_size % c->n == 0;
}

/* Chooses the largest listed shape. Errors: OUT_OF_HOST_MEMORY. */
static SluiceResult choose_matrix(const struct question *q, SluiceNeuralPaths *paths)
{
    slc_get_matrix_combinations get = (slc_get_matrix_combinations)q->get(
        q->instance, "vkGetPhysicalDeviceCooperativeMatrixPropertiesKHR");
    uint32_t count = 0;
    if (paths->matrix && get && get(q->device, &count, NULL) >= 0 && count) {
        struct slc_matrix_combination *list = slc_calloc(&q->cb, count, sizeof *list);
        uint32_t written = count;
        if (!list)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint32_t i = 0; i < count; i++)
            list[i].sType = (VkStructureType)SLC_MATRIX_COMBINATION;
        written = get(q->device, &written, list) >= 0 ? written : 0;
        for (uint32_t i = 0; i < written; i++)
            if (is_usable(q, &list[i]) && list[i].m * list[i].n * list[i].k >
                                              paths->matrixM * paths->matrixN * paths->matrixK) {
                paths->matrixM = list[i].m;
                paths->matrixN = list[i].n;
                paths->matrixK = list[i].k;
            }
        slc_free(&q->cb, list, count, sizeof *list);
    }
    paths->matrix = paths->matrixM > 0;
    return SLUICE_SUCCESS;
}

static bool load_functions(struct question *q)
{
    q->enumerate = (PFN_vkEnumerateDeviceExtensionProperties)q->get(
        q->instance, "vkEnumerateDeviceExtensionProperties");
    q->get_features =
        (PFN_vkGetPhysicalDeviceFeatures2)q->get(q->instance, "vkGetPhysicalDeviceFeatures2");
    q->get_properties =
        (PFN_vkGetPhysicalDeviceProperties2)q->get(q->instance, "vkGetPhysicalDeviceProperties2");
    return q->enumerate && q->get_features && q->get_properties;
}

SluiceResult sluiceGetNeuralPaths(VkInstance instance, VkPhysicalDevice physicalDevice,
                                  PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr,
                                  const SluiceAllocationCallbacks *pAllocator,
                                  SluiceNeuralPaths *pPaths)
{
    if (!instance || !physicalDevice || !pfnGetInstanceProcAddr || !pPaths)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceNeuralPaths), pPaths, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_allocator_is_valid(pAllocator))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    struct question q = {.instance = instance,
                         .device = physicalDevice,
                         .get = pfnGetInstanceProcAddr,
                         .cb = slc_allocator(pAllocator)};
    SluiceNeuralPaths paths = {.structSize = sizeof paths};
    if (!load_functions(&q))
        return SLUICE_ERROR_UNSUPPORTED;
    result = find_extensions(&q);
    if (result != SLUICE_SUCCESS)
        return result;
    get_features(&q, &paths);
    get_properties(&q, &paths);
    result = check_vectors(&q, &paths);
    if (result == SLUICE_SUCCESS)
        result = choose_matrix(&q, &paths);
    if (result == SLUICE_SUCCESS)
        slc_struct_write(SLC_STRUCT(SluiceNeuralPaths), pPaths, &paths);
    return result;
}

/* Contents of SluiceNeuralPathFeatures.storage. */
struct feature_structs {
    VkPhysicalDeviceShaderIntegerDotProductFeaturesKHR dot;
    struct slc_cooperative_features vector, matrix;
    VkPhysicalDeviceSubgroupSizeControlFeaturesEXT control;
};

static void add_cooperative(SluiceNeuralPathFeatures *features, const char *name, int32_t type,
                            struct slc_cooperative_features *chained)
{
    *chained = (struct slc_cooperative_features){
        .sType = (VkStructureType)type, .pNext = features->pNext, .cooperative = VK_TRUE};
    features->pNext = chained;
    features->extensions[features->extensionCount++] = name;
}

SluiceResult sluiceRequireNeuralPaths(const SluiceNeuralPaths *pPaths, void *pNext,
                                      VkPhysicalDeviceVulkan12Features *pVulkan12,
                                      SluiceNeuralPathFeatures *pFeatures)
{
    if (!pPaths || !pVulkan12 || !pFeatures)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceNeuralPaths paths = {.structSize = sizeof paths};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceNeuralPaths), &paths, pPaths, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    static_assert(sizeof(struct feature_structs) <= sizeof pFeatures->storage,
                  "too little storage");
    struct feature_structs *structs = (void *)pFeatures->storage;
    *pFeatures = (SluiceNeuralPathFeatures){.pNext = pNext};
    if (paths.integerDot) {
        structs->dot = (VkPhysicalDeviceShaderIntegerDotProductFeaturesKHR){
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_INTEGER_DOT_PRODUCT_FEATURES_KHR,
            .pNext = pFeatures->pNext,
            .shaderIntegerDotProduct = VK_TRUE};
        pFeatures->pNext = &structs->dot;
        pFeatures->extensions[pFeatures->extensionCount++] =
            VK_KHR_SHADER_INTEGER_DOT_PRODUCT_EXTENSION_NAME;
    }
    if (paths.vectorInt8 || paths.vectorFp8)
        add_cooperative(pFeatures, SLC_VECTOR_EXTENSION, SLC_VECTOR_FEATURES, &structs->vector);
    if (paths.matrix) {
        add_cooperative(pFeatures, SLC_MATRIX_EXTENSION, SLC_MATRIX_FEATURES, &structs->matrix);
        structs->control = (VkPhysicalDeviceSubgroupSizeControlFeaturesEXT){
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES_EXT,
            .pNext = pFeatures->pNext,
            .computeFullSubgroups = VK_TRUE};
        pFeatures->pNext = &structs->control;
        pFeatures->extensions[pFeatures->extensionCount++] =
            VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME;
    }
    if (paths.half || paths.vectorFp8)
        pVulkan12->shaderFloat16 = VK_TRUE;
    if (paths.matrix)
        pVulkan12->shaderInt8 = VK_TRUE;
    if (paths.matrix || paths.vectorInt8 || paths.vectorFp8)
        pVulkan12->vulkanMemoryModel = VK_TRUE;
    return SLUICE_SUCCESS;
}
