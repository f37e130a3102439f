/**
 * Any bytes as an OpenEXR file: an error or an image, all of whose levels can be asked for. Built
 * with -fsanitize=fuzzer it is a fuzz target; with -DFUZZ_REPLAY it is a program that takes files
 * and folders of inputs.
 */
#define _POSIX_C_SOURCE 200809L
#define _XOPEN_SOURCE 700

#include <sluice/exr.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* In strips, so that a large image needs little memory; errors are as good as texels. */
static void read_level(SluiceImageSource *source, const SluiceImageInfo *info, uint32_t level)
{
    enum { STRIP = 64 };
    uint32_t width = info->width >> level ? info->width >> level : 1;
    uint32_t height = info->height >> level ? info->height >> level : 1;
    size_t pitch = (size_t)width * sluiceFormatTexelSize(info->format);
    void *texels = malloc(pitch * STRIP);
    for (uint32_t y = 0; texels && y < height; y += STRIP) {
        uint32_t rows = height - y < STRIP ? height - y : STRIP;
        SluiceImageRegion region = {level, 0, y, width, rows};
        if (sluiceReadImageRegion(source, &region, texels, pitch) != SLUICE_SUCCESS)
            break;
    }
    free(texels);
}

static void read_file(const char *path, SluiceFormat format)
{
    SluiceExrImageSourceCreateInfo create = {
        .pPath = path, .format = format, .maxImageSize = 1 << 26};
    SluiceImageSource *source;
    SluiceImageInfo info;
    if (sluiceCreateExrImageSource(&create, &source) != SLUICE_SUCCESS)
        return;
    if (sluiceGetImageInfo(source, &info) != SLUICE_SUCCESS)
        abort();
    for (uint32_t level = 0; level < info.mipLevelCount; level++)
        read_level(source, &info, level);
    sluiceDestroyImageSource(source);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[] = "/tmp/fuzz-exr-XXXXXX";
    int descriptor = mkstemp(path);
    if (descriptor < 0)
        return 0;
    if (write(descriptor, data, size) == (ssize_t)size) {
        read_file(path, SLUICE_FORMAT_UNDEFINED);
        read_file(path, SLUICE_FORMAT_R8G8B8A8_SRGB);
    }
    close(descriptor);
    unlink(path);
    return 0;
}

#ifdef FUZZ_REPLAY
#include <dirent.h>
#include <sys/stat.h>

static int replay_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return 0;
    static uint8_t bytes[1 << 20];
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    LLVMFuzzerTestOneInput(bytes, size);
    return 1;
}

static int replay(const char *path)
{
    DIR *folder = opendir(path);
    if (!folder)
        return replay_file(path);
    int count = 0;
    char name[4096];
    for (struct dirent *entry; (entry = readdir(folder));)
        if (entry->d_name[0] != '.') {
            snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
            count += replay_file(name);
        }
    closedir(folder);
    return count;
}

int main(int argc, char **argv)
{
    int count = 0;
    for (int i = 1; i < argc; i++)
        count += replay(argv[i]);
    printf("%d inputs replayed\n", count);
    return count > 0 ? 0 : 1;
}
#endif
