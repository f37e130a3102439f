/* Writes the page of a sweep that is made of formulas: write_page KIND FOLDER, which is
 * FOLDER/page.html. KIND is plain, hostile, bare: runs have no files; long: they have 900 frames;
 * failed: all of them did; single: the base alone. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "page.h"
#include "page_sweep.h"

static void add_files(const struct page_sweep *s, uint32_t frames)
{
    for (uint32_t i = 0; i < PAGE_SWEEP_DONE - 1; i++)
        page_sweep_add_frames(s, i, frames);
    page_sweep_add_file(s, PAGE_SWEEP_DONE - 1, "frames.csv", "frame,psnr_db\n0,word\n", 21);
    for (uint32_t i = 0; i < PAGE_SWEEP_DONE; i++) {
        for (uint32_t frame = 0; frame < 3; frame++) {
            page_sweep_add_picture(s, i, "frame", frame, (uint8_t)(10 + i), 10 + frame);
            page_sweep_add_picture(s, i, "truth", frame, 1, 10 + frame);
        }
        page_sweep_add_picture(s, i, "flip", 0, (uint8_t)(30 + i), 10);
    }
}

int main(int argc, char **argv)
{
    static struct page_sweep s;
    char path[600];
    if (argc != 3)
        return 2;
    mkdir(argv[2], 0777);
    page_sweep_init(&s, argv[2], strcmp(argv[1], "hostile") == 0);
    for (uint32_t i = 0; i < PAGE_SWEEP_POINTS && strcmp(argv[1], "failed") == 0; i++)
        s.points[i].state = SWEEP_FAILED;
    if (strcmp(argv[1], "single") == 0) {
        s.sweep.points = &s.points[PAGE_SWEEP_BASE];
        s.sweep.point_count = 1;
        s.sweep.base = 0;
    }
    if (strcmp(argv[1], "bare") != 0)
        add_files(&s, strcmp(argv[1], "long") == 0 ? 900 : 60);
    if (strcmp(argv[1], "hostile") == 0)
        page_sweep_add_file(&s, 1, "frames.csv", "frame,</script><b>x\n0,1\n1,inf\n", 31);
    snprintf(path, sizeof path, "%s/page.html", argv[2]);
    return page_write(&s.sweep, s.recommendations, PAGE_SWEEP_RECOMMENDATIONS, path) ? 0 : 1;
}
