#include "neural/neural_set.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/struct_size.h"
#include "neural/network.h"
#include "base/little_endian.h"

#include <stdio.h>
#include <string.h>

#define HEADER_SIZE 40u
#define MAGIC 0x5845544Eu /* NTEX */
#define VERSION 0x100u

/* Checks that chunks lie in the file. Versions 0.9.0 and 0.9.1 omit the final padding. */
static SluiceResult check_header(SluiceNeuralSet *set, const unsigned char header[HEADER_SIZE],
                                 uint64_t *text_offset, uint64_t *text_size)
{
    uint64_t size = set->file.size;
    *text_offset = slc_get_u64(header + 8);
    *text_size = slc_get_u64(header + 16);
    set->data_offset = slc_get_u64(header + 24);
    set->data_size = slc_get_u64(header + 32);
    if (slc_get_u32(header) != MAGIC)
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA, "is not a .ntc file");
    if (slc_get_u32(header + 4) != VERSION)
        return slc_input_fail(&set->file, SLUICE_ERROR_UNSUPPORTED,
                              "has the container version 0x%X; 0x100 is read",
                              slc_get_u32(header + 4));
    if (*text_offset > size || *text_size > size - *text_offset || *text_size == 0)
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                              "has its description outside of the file");
    if (set->data_offset > size || set->data_size > size - set->data_offset + 3)
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                              "has its data outside of the file");
    set->data_size = slc_min_u64(set->data_size, size - set->data_offset);
    if (*text_size > SLC_NEURAL_MAX_TEXT_SIZE)
        return slc_input_fail(&set->file, SLUICE_ERROR_LIMIT_EXCEEDED,
                              "has a description of %llu bytes; at most %u are read",
                              (unsigned long long)*text_size, SLC_NEURAL_MAX_TEXT_SIZE);
    return SLUICE_SUCCESS;
}

static SluiceResult read_text(SluiceNeuralSet *set)
{
    unsigned char header[HEADER_SIZE];
    uint64_t offset, size;
    SluiceResult result = slc_input_file_read(&set->file, 0, header, HEADER_SIZE);
    if (result == SLUICE_SUCCESS)
        result = check_header(set, header, &offset, &size);
    if (result != SLUICE_SUCCESS)
        return result;
    set->text_size = (size_t)size + 1;
    set->text = slc_alloc(&set->allocator, set->text_size, 1);
    if (!set->text)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    set->text[size] = '\0';
    return slc_input_file_read(&set->file, offset, set->text, (size_t)size);
}

/* Parses the text up to the first NUL. Its size counts one or more NULs. */
static SluiceResult parse_text(SluiceNeuralSet *set, struct slc_neural_document *document)
{
    struct slc_json json;
    char *text = set->text;
    slc_json_begin(&json, text, strlen(text));
    if (slc_neural_document_parse(document, &json))
        return SLUICE_SUCCESS;
    if (document->is_out_of_memory)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                          "has an error at byte %zu of its description: %s",
                          (size_t)(json.at - text), json.trouble);
}

static SluiceResult read_set(SluiceNeuralSet *set, struct slc_neural_document *document)
{
    SluiceResult result = slc_input_file_open(&set->file);
    if (result == SLUICE_SUCCESS)
        result = read_text(set);
    if (result == SLUICE_SUCCESS)
        result = parse_text(set, document);
    if (result == SLUICE_SUCCESS)
        result = slc_neural_check(set, document);
    if (result == SLUICE_SUCCESS)
        result = slc_neural_read_networks(set, document);
    set->info.fileSize = set->file.size;
    return result;
}

/* Opens a set. Allocates the document, which is too large for a thread's stack. */
static SluiceResult open_set(SluiceNeuralSet *set)
{
    struct slc_neural_document *document = slc_calloc(&set->allocator, 1, sizeof *document);
    if (!document)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    document->allocator = set->allocator;
    set->verified = slc_calloc(&set->allocator, SLC_NEURAL_MAX_GRIDS, sizeof *set->verified);
    SluiceResult result = set->verified ? read_set(set, document) : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    slc_neural_document_finish(document);
    slc_free(&set->allocator, document, 1, sizeof *document);
    return result;
}

SluiceResult sluiceOpenNeuralSet(const SluiceNeuralSetCreateInfo *pInfo, SluiceNeuralSet **pSet)
{
    if (!pInfo || !pSet)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceNeuralSetCreateInfo given = {.structSize = sizeof given};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceNeuralSetCreateInfo), &given, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!given.pPath && !given.pInput)
        return SLUICE_ERROR_NULL_POINTER;
    if (!slc_allocator_is_valid(given.pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceAllocationCallbacks cb = slc_allocator(given.pAllocator);
    SluiceNeuralSet *set = slc_calloc(&cb, 1, sizeof *set);
    if (!set)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    set->allocator = cb;
    struct slc_input_choice choice = {given.pPath, given.pInput, given.filePool};
    result = slc_input_file_init_choice(&set->file, &choice, &cb, &given.log);
    if (result == SLUICE_SUCCESS)
        result = open_set(set);
    if (result == SLUICE_SUCCESS)
        *pSet = set;
    else
        sluiceDestroyNeuralSet(set);
    return result;
}

void sluiceDestroyNeuralSet(SluiceNeuralSet *set)
{
    if (!set)
        return;
    SluiceAllocationCallbacks cb = set->allocator;
    slc_input_file_finish(&set->file);
    slc_free(&cb, set->text, set->text_size, 1);
    slc_free(&cb, set->verified, SLC_NEURAL_MAX_GRIDS, sizeof *set->verified);
    for (int kind = 0; kind < 2; kind++)
        slc_free(&cb, set->weights[kind],
                 slc_neural_blob_of(&set->shape, (SluiceNeuralWeightKind)kind).size, 1);
    slc_free(&cb, set, 1, sizeof *set);
}
