/*
 * Makes a scene like a film set: many instances of meshes in PLY files, each mesh with a texture.
 *
 *     film_set [--instances N] [--meshes N] [--triangles N] [--texture-size N] FOLDER
 *
 * FOLDER takes scene.pbrt, mesh-*.ply and texture-*.dds. The same options give the same bytes. The
 * camera stands in the middle, among the objects, so that rays see some of them and never most.
 * Textures are BC1 with all mips. Levels above 256 texels are holes in the files, and white. So
 * textures of any size take little of the disk.
 */
#define _FILE_OFFSET_BITS 64
#define _XOPEN_SOURCE 700

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PI 3.14159265358979
#define SPACING 3.0 /* between instances */
#define DRAWN 256u  /* texels of the largest level that is written */

static struct {
    uint32_t instances, meshes, triangles, texture_size;
    const char *folder;
} set = {1000000, 1000, 1000, 256, NULL};

static void fail(const char *what)
{
    fprintf(stderr, "film_set: %s: %s\n", what, strerror(errno));
    exit(1);
}

/** FOLDER/NAME-00000.ENDING */
static FILE *create(const char *name, uint32_t number, const char *ending)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s-%05u.%s", set.folder, name, number, ending);
    FILE *file = fopen(path, "wb");
    if (!file)
        fail(path);
    return file;
}

static void finish(FILE *file)
{
    if (ferror(file) || fclose(file) != 0)
        fail("writing");
}

/** 0 to 1, by two numbers. */
static double chance(uint32_t a, uint32_t b)
{
    uint64_t x = (uint64_t)a << 32 | b;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return (double)((x ^ x >> 31) >> 11) / 9007199254740992.0;
}

static void put(FILE *file, uint32_t value)
{
    const uint8_t bytes[4] = {value & 255, value >> 8 & 255, value >> 16 & 255, value >> 24};
    fwrite(bytes, 1, 4, file);
}

static void put_float(FILE *file, double value)
{
    const float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    put(file, bits);
}

/* Meshes: lumpy balls of rows x 2 rows squares. */

static uint32_t row_count(void)
{
    const uint32_t rows = (uint32_t)lround(sqrt(set.triangles / 4.0));
    return rows < 2 ? 2 : rows;
}

static void put_vertex(FILE *file, uint32_t mesh, uint32_t row, uint32_t column)
{
    const uint32_t rows = row_count();
    const double u = column / (2.0 * rows), v = row / (double)rows;
    const double around = 2 * PI * u, down = PI * v;
    const double lumps = 2 + floor(4 * chance(mesh, 1)), depth = 0.3 * chance(mesh, 2);
    const double radius = 1 + depth * cos(lumps * around) * sin(down) * sin(down);
    put_float(file, radius * cos(around) * sin(down));
    put_float(file, radius * sin(around) * sin(down));
    put_float(file, (0.5 + chance(mesh, 3)) * cos(down));
    put_float(file, u);
    put_float(file, v);
}

static void put_triangle(FILE *file, uint32_t a, uint32_t b, uint32_t c)
{
    fputc(3, file);
    put(file, a);
    put(file, b);
    put(file, c);
}

static void write_mesh(uint32_t mesh)
{
    const uint32_t rows = row_count(), columns = 2 * rows, line = columns + 1;
    FILE *file = create("mesh", mesh, "ply");
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\nelement vertex %u\nproperty float x\n"
            "property float y\nproperty float z\nproperty float u\nproperty float v\n"
            "element face %u\nproperty list uchar int vertex_indices\nend_header\n",
            (rows + 1) * line, 2 * rows * columns);
    for (uint32_t row = 0; row <= rows; row++)
        for (uint32_t column = 0; column <= columns; column++)
            put_vertex(file, mesh, row, column);
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++) {
            const uint32_t at = row * line + column;
            put_triangle(file, at, at + line, at + 1);
            put_triangle(file, at + 1, at + line, at + line + 1);
        }
    finish(file);
}

/* Textures */

static void write_dds_header(FILE *file, uint32_t levels)
{
    const uint32_t size = set.texture_size;
    const uint32_t words[37] = {
        0x20534444, 124, 0xa1007, size, size, size / 4 * (size / 4) * 8, 1, levels,
        /* 11 reserved words */
        [19] = 32, 4, 0x30315844 /* DX10 */, [27] = 0x401008, /* texture with mips */
        [32] = 72 /* BC1_UNORM_SRGB */, 3 /* 2D */, 0, 1};
    for (uint32_t i = 0; i < 37; i++)
        put(file, words[i]);
}

/** 5, 6 and 5 bits of a color. */
static uint32_t pick_color(uint32_t mesh, uint32_t which)
{
    return (uint32_t)(65535 * chance(mesh, 10 + which));
}

/** Returns the size of the file. */
static uint64_t write_texture(uint32_t mesh)
{
    FILE *file = create("texture", mesh, "dds");
    uint64_t end = 148;
    uint32_t levels = 1;
    while (set.texture_size >> levels)
        levels++;
    write_dds_header(file, levels);
    for (uint32_t size = set.texture_size; size > 0; size /= 2) {
        const uint32_t blocks = (size + 3) / 4;
        for (uint32_t i = 0; i < blocks * blocks && size <= DRAWN; i++) {
            const uint32_t across = i % blocks * 8 / blocks, along = i / blocks * 8 / blocks;
            put(file, pick_color(mesh, (across + along) % 2));
            put(file, 0);
        }
        end += (uint64_t)blocks * blocks * 8;
        if (size > DRAWN && fseeko(file, (off_t)end, SEEK_SET) != 0)
            fail("a texture");
    }
    finish(file);
    return end;
}

/* The scene */

static void write_objects(FILE *file)
{
    for (uint32_t i = 0; i < set.meshes; i++)
        fprintf(file,
                "Texture \"t%u\" \"spectrum\" \"imagemap\" \"string filename\" "
                "\"texture-%05u.dds\" \"bool invert\" \"true\"\n"
                "ObjectBegin \"m%u\"\nMaterial \"matte\" \"texture Kd\" \"t%u\"\n"
                "Shape \"plymesh\" \"string filename\" \"mesh-%05u.ply\"\nObjectEnd\n",
                i, i, i, i, i);
}

/* Places in a square of rows, at random angles and sizes. The middle is free for the camera. */
static void write_instances(FILE *file)
{
    const uint32_t side = (uint32_t)ceil(sqrt((double)set.instances));
    for (uint32_t i = 0; i < set.instances; i++) {
        const double x = ((i % side) - 0.5 * (side - 1)) * SPACING;
        const double y = ((i / side) - 0.5 * (side - 1)) * SPACING;
        const double angle = 2 * PI * chance(i, 20), size = 0.6 + 0.8 * chance(i, 21);
        const double c = size * cos(angle), s = size * sin(angle);
        const uint32_t mesh = (uint32_t)(set.meshes * chance(i, 22));
        fprintf(file,
                "AttributeBegin\nConcatTransform [ %.6g %.6g 0 0 %.6g %.6g 0 0 0 0 %.6g 0 "
                "%.7g %.7g 0 1 ]\nObjectInstance \"m%u\"\nAttributeEnd\n",
                c, s, -s, c, size, x, y, mesh);
    }
}

static void write_scene(void)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/scene.pbrt", set.folder);
    FILE *file = fopen(path, "wb");
    if (!file)
        fail(path);
    const double ground = SPACING * sqrt((double)set.instances);
    fputs("LookAt 0 -24 9  0 0 1  0 0 1\nCamera \"perspective\" \"float fov\" 50\n"
          "Film \"image\" \"integer xresolution\" 1920 \"integer yresolution\" 1080\nWorldBegin\n"
          "LightSource \"distant\" \"point from\" [ -3 -4 6 ] \"rgb L\" [ 1 1 1 ]\n"
          "LightSource \"infinite\" \"rgb L\" [ 0.4 0.5 0.7 ]\n"
          "Material \"matte\" \"rgb Kd\" [ 0.3 0.3 0.25 ]\n",
          file);
    fprintf(file,
            "Shape \"trianglemesh\" \"point P\" [ %.7g %.7g -2 %.7g %.7g -2 %.7g %.7g -2 %.7g "
            "%.7g -2 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n",
            -ground, -ground, ground, -ground, ground, ground, -ground, ground);
    write_objects(file);
    write_instances(file);
    fputs("WorldEnd\n", file);
    finish(file);
}

static uint32_t parse_number(const char *text, uint32_t least, uint32_t most)
{
    char *end;
    const unsigned long value = strtoul(text, &end, 10);
    if (*end || end == text || value < least || value > most) {
        fprintf(stderr, "film_set: %s: from %u to %u\n", text, least, most);
        exit(2);
    }
    return (uint32_t)value;
}

static void parse(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : "";
        if (argv[i][0] != '-') {
            set.folder = argv[i];
            continue;
        }
        i++;
        if (strcmp(argv[i - 1], "--instances") == 0)
            set.instances = parse_number(value, 1, 10000000);
        else if (strcmp(argv[i - 1], "--meshes") == 0)
            set.meshes = parse_number(value, 1, 99999);
        else if (strcmp(argv[i - 1], "--triangles") == 0)
            set.triangles = parse_number(value, 16, 100000000);
        else if (strcmp(argv[i - 1], "--texture-size") == 0)
            set.texture_size = parse_number(value, 4, 16384);
        else
            set.folder = NULL, i = argc;
    }
}

int main(int argc, char **argv)
{
    uint64_t texture_bytes = 0;
    parse(argc, argv);
    if (!set.folder) {
        fputs("usage: film_set [--instances N] [--meshes N] [--triangles N] [--texture-size N] "
              "FOLDER\n",
              stderr);
        return 2;
    }
    if (mkdir(set.folder, 0777) != 0 && errno != EEXIST)
        fail(set.folder);
    for (uint32_t i = 0; i < set.meshes; i++) {
        write_mesh(i);
        texture_bytes += write_texture(i);
    }
    write_scene();
    const uint32_t triangles = 4 * row_count() * row_count();
    printf("{\"name\": \"set.instances\", \"value\": %u, \"unit\": \"\"}\n"
           "{\"name\": \"set.meshes\", \"value\": %u, \"unit\": \"\"}\n"
           "{\"name\": \"set.triangles\", \"value\": %.0f, \"unit\": \"\"}\n"
           "{\"name\": \"set.texture_bytes\", \"value\": %.0f, \"unit\": \"B\"}\n",
           set.instances, set.meshes, (double)set.instances * triangles, (double)texture_bytes);
    return 0;
}
