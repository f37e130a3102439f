#include "report.h"

#include "../common/text.h"

#include <inttypes.h>
#include <stdio.h>

static const char *yes_no(bool value)
{
    return value ? "yes" : "no";
}

static const char *true_false(bool value)
{
    return value ? "true" : "false";
}

static const char *type_name(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return "software";
    default: return "other";
    }
}

static void print_version(FILE *out, uint32_t version)
{
    fprintf(out, "%u.%u.%u", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
            VK_API_VERSION_PATCH(version));
}

/* Prints a size in the smallest unit that keeps the number below 10240. Round sizes stay round. */
static void print_bytes(FILE *out, uint64_t size)
{
    static const char *const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    int unit = 0;
    while (unit < 4 && size >= 10240) {
        size /= 1024;
        unit++;
    }
    fprintf(out, "%" PRIu64 " %s\n", size, units[unit]);
}

static void print_queue(FILE *out, const SluiceVulkanDeviceCapabilities *c)
{
    fprintf(out, "  sparse binding queue    family %u, %u %s, %s\n", c->sparseQueueFamilyIndex,
            c->sparseQueueCount, c->sparseQueueCount == 1 ? "queue" : "queues",
            c->dedicatedSparseQueue ? "neither draws nor computes" : "shared with other work");
}

void print_limits(FILE *out, const struct device_report *r)
{
    const SluiceVulkanDeviceCapabilities *c = &r->capabilities;
    fprintf(out, "device %u: %s\n", r->index, c->deviceName);
    fprintf(out, "  type                    %s\n", type_name(c->deviceType));
    fprintf(out, "  driver                  %s %s\n", c->driverName, c->driverInfo);
    fprintf(out, "  Vulkan                  ");
    print_version(out, c->apiVersion);
    fprintf(out, "\n  streams                 %s%s\n", r->missing[0] ? "no: " : "yes", r->missing);
    fprintf(out, "  sparse residency        %s\n", yes_no(c->sparse));
    if (c->sparse)
        print_queue(out, c);
    fprintf(out, "  sparse address space    ");
    print_bytes(out, c->sparseAddressSpaceSize);
    fprintf(out, "  device-local memory     ");
    print_bytes(out, c->deviceLocalMemorySize);
    fprintf(out, "  standard tile shapes    %s\n", yes_no(c->standardTiles));
    fprintf(out, "  sparse cube maps        %s\n", yes_no(c->sparse && c->sparseCubes));
    fprintf(out, "  unbound texels read 0   %s\n", yes_no(c->residencyNonResidentStrict));
    fprintf(out, "  residency codes         %s\n",
            !c->shaderResourceResidency ? "no"
            : c->residencyCodesExact    ? "yes"
                                        : "yes, not to be trusted");
    fprintf(out, "  LOD clamp operand       %s\n", yes_no(c->shaderResourceMinLod));
    fprintf(out, "  aliased pages           %s\n", yes_no(c->sparseResidencyAliased));
    fprintf(out, "  BC formats              %s\n", yes_no(c->textureCompressionBC));
    fprintf(out, "  anisotropy              %g\n",
            c->samplerAnisotropy ? (double)c->maxSamplerAnisotropy : 1.0);
    fprintf(out, "  largest 2D image        %ux%u, %u layers\n", c->maxImageExtent,
            c->maxImageExtent, c->maxImageArrayLayers);
    fprintf(out, "  tiles a process binds   ");
    if (c->maxTouchedTiles)
        fprintf(out, "at most %u\n", c->maxTouchedTiles);
    else
        fprintf(out, "any number\n");
    fprintf(out, "  time stamps             ");
    if (c->timestampPeriod > 0.0f)
        fprintf(out, "%g ns\n", (double)c->timestampPeriod);
    else
        fprintf(out, "no\n");
}

static void print_format(SluiceFormat format, const struct format_report *f)
{
    const SluiceVulkanFormatCapabilities *c = &f->capabilities;
    char granularity[32] = "-", tile[32] = "-", packed[64] = "-";
    if (c->granularityWidth) {
        snprintf(granularity, sizeof granularity, "%ux%u", c->granularityWidth,
                 c->granularityHeight);
        snprintf(tile, sizeof tile, "%ux%u", c->tileWidth, c->tileHeight);
    }
    if (f->has_layout)
        snprintf(packed, sizeof packed, "%u of %u, %u pages (%s)", f->layout.regularMipCount,
                 f->layout.mipLevelCount, f->layout.packedTileCount,
                 f->layout.driverTail ? "tail" : "no tail");
    printf("  %-26s %-6s %-6s %-7s %-9s %-9s %s\n", sluiceGetFormatName(format), yes_no(c->sparse),
           yes_no(c->sampled), yes_no(c->linearFilter), granularity, tile, packed);
}

void print_table(const struct device_report *r, bool follows)
{
    if (follows)
        printf("\n");
    print_limits(stdout, r);
    printf("\n  %-26s %-6s %-6s %-7s %-9s %-9s levels apart of %ux%u\n", "format", "sparse",
           "sample", "filter", "says", "tile", r->width, r->height);
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++)
        print_format((SluiceFormat)f, &r->formats[f]);
}

static void print_string(const char *name, const char *text)
{
    printf("\"%s\":", name);
    text_write_json(stdout, text);
    printf(",");
}

static void print_flag(const char *name, bool value)
{
    printf("\"%s\":%s,", name, true_false(value));
}

static void print_number(const char *name, uint64_t value)
{
    printf("\"%s\":%" PRIu64 ",", name, value);
}

static void print_json_device(const struct device_report *r)
{
    const SluiceVulkanDeviceCapabilities *c = &r->capabilities;
    print_number("index", r->index);
    print_string("deviceName", c->deviceName);
    print_string("deviceType", type_name(c->deviceType));
    print_string("driverName", c->driverName);
    print_string("driverInfo", c->driverInfo);
    printf("\"apiVersion\":\"");
    print_version(stdout, c->apiVersion);
    printf("\",");
    print_flag("streams", !r->missing[0]);
    print_string("missing", r->missing);
    print_flag("sparse", c->sparse);
    print_number("sparseQueueFamilyIndex", c->sparseQueueFamilyIndex);
    print_number("sparseQueueCount", c->sparseQueueCount);
    print_flag("dedicatedSparseQueue", c->dedicatedSparseQueue);
    print_number("sparseAddressSpaceSize", c->sparseAddressSpaceSize);
    print_number("deviceLocalMemorySize", c->deviceLocalMemorySize);
    print_flag("standardTiles", c->standardTiles);
    print_flag("sparseCubes", c->sparseCubes);
    print_flag("residencyNonResidentStrict", c->residencyNonResidentStrict);
    print_flag("shaderResourceResidency", c->shaderResourceResidency);
    print_flag("residencyCodesExact", c->residencyCodesExact);
    print_flag("shaderResourceMinLod", c->shaderResourceMinLod);
    print_flag("sparseResidencyAliased", c->sparseResidencyAliased);
    print_flag("timelineSemaphore", c->timelineSemaphore);
    print_flag("fragmentStoresAndAtomics", c->fragmentStoresAndAtomics);
    print_flag("textureCompressionBC", c->textureCompressionBC);
    print_flag("samplerAnisotropy", c->samplerAnisotropy);
    printf("\"maxSamplerAnisotropy\":%g,", (double)c->maxSamplerAnisotropy);
    print_number("maxImageExtent", c->maxImageExtent);
    print_number("maxImageArrayLayers", c->maxImageArrayLayers);
    print_number("maxStorageBufferRange", c->maxStorageBufferRange);
    print_number("maxTouchedTiles", c->maxTouchedTiles);
    printf("\"timestampPeriod\":%g,", (double)c->timestampPeriod);
}

static void print_json_layout(const struct device_report *r, const struct format_report *f)
{
    const SluiceVulkanSparseImageLayout *l = &f->layout;
    printf(",\"layout\":{");
    print_number("width", r->width);
    print_number("height", r->height);
    print_number("mipLevelCount", l->mipLevelCount);
    print_number("regularMipCount", l->regularMipCount);
    print_number("packedTileCount", l->packedTileCount);
    print_flag("driverTail", l->driverTail);
    print_number("tailSize", l->tailSize);
    print_number("metadataSize", l->metadataSize);
    print_number("imageSize", l->imageSize);
    print_number("alignment", l->alignment);
    printf("\"memoryTypeBits\":%u}", l->memoryTypeBits);
}

static void print_json_format(const struct device_report *r, SluiceFormat format)
{
    const struct format_report *f = &r->formats[format];
    const SluiceVulkanFormatCapabilities *c = &f->capabilities;
    printf("%s{", format == 1 ? "" : ",");
    print_string("format", sluiceGetFormatName(format));
    print_flag("sparse", c->sparse);
    print_flag("sampled", c->sampled);
    print_flag("linearFilter", c->linearFilter);
    print_number("granularityWidth", c->granularityWidth);
    print_number("granularityHeight", c->granularityHeight);
    print_number("tileWidth", c->tileWidth);
    print_number("tileHeight", c->tileHeight);
    print_number("maxWidth", c->maxWidth);
    print_number("maxHeight", c->maxHeight);
    print_number("maxMipLevelCount", c->maxMipLevelCount);
    print_number("maxArrayLayerCount", c->maxArrayLayerCount);
    printf("\"maxImageSize\":%" PRIu64, c->maxImageSize);
    if (f->has_layout)
        print_json_layout(r, f);
    printf("}");
}

void print_json(const struct device_report *r)
{
    printf("{");
    print_json_device(r);
    printf("\"formats\":[");
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++)
        print_json_format(r, (SluiceFormat)f);
    printf("]}\n");
}
