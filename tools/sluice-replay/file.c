#include "file.h"

#include "../common/input.h"

#define FILE_SIZE_MAX ((uint64_t)4 << 30)

bool read_file(const char *path, char **data, size_t *size)
{
    return input_read_file(path, FILE_SIZE_MAX, data, size);
}
