/** Structs of cooperative matrices and vectors, for Vulkan headers without them. */
#ifndef SLC_NEURAL_COOPERATIVE_H
#define SLC_NEURAL_COOPERATIVE_H

#include <vulkan/vulkan_core.h>

#include <stddef.h>

/* Numbers of Khronos' registry, under Sluice's names: newer headers define the official names. */
enum {
    SLC_VECTOR_FEATURES = 1000491000,
    SLC_VECTOR_PROPERTIES = 1000491001,
    SLC_VECTOR_COMBINATION = 1000491002,
    SLC_CONVERT_INFO = 1000491004,
    SLC_MATRIX_FEATURES = 1000506000,
    SLC_MATRIX_COMBINATION = 1000506001,
    SLC_MATRIX_PROPERTIES = 1000506002
};

enum {
    SLC_COMPONENT_FLOAT16 = 0,
    SLC_COMPONENT_SINT8 = 3,
    SLC_COMPONENT_SINT32 = 5,
    SLC_COMPONENT_UINT32 = 9,
    SLC_COMPONENT_SINT8_PACKED = 1000491000,
    SLC_COMPONENT_E4M3 = 1000491002,
    SLC_SCOPE_SUBGROUP = 3,
    SLC_LAYOUT_ROW_MAJOR = 0,
    SLC_LAYOUT_INFERENCING = 2
};

#define SLC_VECTOR_EXTENSION "VK_NV_cooperative_vector"
#define SLC_MATRIX_EXTENSION "VK_KHR_cooperative_matrix"

/** Layout of all these feature structs, and of VkPhysicalDeviceCooperativeMatrixFeaturesKHR. */
struct slc_cooperative_features {
    VkStructureType sType;
    void *pNext;
    VkBool32 cooperative;
    VkBool32 other; ///< training; robust buffer access
};

struct slc_vector_properties {
    VkStructureType sType;
    void *pNext;
    VkShaderStageFlags stages;
    VkBool32 training[2];
    uint32_t maxComponents;
};

struct slc_vector_combination {
    VkStructureType sType;
    void *pNext;
    int32_t inputType, inputInterpretation, matrixInterpretation, biasInterpretation, resultType;
    VkBool32 transpose;
};

struct slc_matrix_properties {
    VkStructureType sType;
    void *pNext;
    VkShaderStageFlags stages;
};

struct slc_matrix_combination {
    VkStructureType sType;
    void *pNext;
    uint32_t m, n, k;
    int32_t aType, bType, cType, resultType;
    VkBool32 saturates;
    int32_t scope;
};

struct slc_convert_info {
    VkStructureType sType;
    const void *pNext;
    size_t srcSize;
    VkDeviceOrHostAddressConstKHR srcData;
    size_t *pDstSize;
    VkDeviceOrHostAddressKHR dstData;
    int32_t srcComponentType, dstComponentType;
    uint32_t numRows, numColumns;
    int32_t srcLayout;
    size_t srcStride;
    int32_t dstLayout;
    size_t dstStride;
};

typedef VkResult(VKAPI_PTR *slc_get_vector_combinations)(VkPhysicalDevice device, uint32_t *count,
                                                         struct slc_vector_combination *list);
typedef VkResult(VKAPI_PTR *slc_get_matrix_combinations)(VkPhysicalDevice device, uint32_t *count,
                                                         struct slc_matrix_combination *list);
typedef VkResult(VKAPI_PTR *slc_convert_matrix)(VkDevice device,
                                                const struct slc_convert_info *info);

#endif /* SLC_NEURAL_COOPERATIVE_H */
