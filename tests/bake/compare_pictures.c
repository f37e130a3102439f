/* compare_pictures A B [X Y]: whether B is the part of A from (X, Y) on, channel by channel of
 * those A has. */
#include <stdio.h>
#include <stdlib.h>

#include <vips/vips.h>

static int is_part(VipsImage *a, VipsImage *b, int x, int y)
{
    VipsImage *part, *channels, *same;
    double least;
    int width = vips_image_get_width(b), height = vips_image_get_height(b);
    if (vips_extract_area(a, &part, x, y, width, height, NULL) != 0 ||
        vips_extract_band(b, &channels, 0, "n", vips_image_get_bands(a), NULL) != 0 ||
        vips_equal(part, channels, &same, NULL) != 0 || vips_min(same, &least, NULL) != 0)
        return 0;
    g_object_unref(same);
    g_object_unref(channels);
    g_object_unref(part);
    return least == 255;
}

int main(int argc, char **argv)
{
    if ((argc != 3 && argc != 5) || VIPS_INIT(argv[0]) != 0)
        return 2;
    VipsImage *a = vips_image_new_from_file(argv[1], NULL);
    VipsImage *b = vips_image_new_from_file(argv[2], NULL);
    int x = argc == 5 ? atoi(argv[3]) : 0, y = argc == 5 ? atoi(argv[4]) : 0;
    int same = a && b && is_part(a, b, x, y);
    if (!a || !b)
        fprintf(stderr, "%s\n", vips_error_buffer());
    if (a)
        g_object_unref(a);
    if (b)
        g_object_unref(b);
    vips_shutdown();
    return same ? 0 : 1;
}
