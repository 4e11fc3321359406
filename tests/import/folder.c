#include "folder.h"

#include "base/atomic_file.h"
#include "btf/direction/direction.h"

#include <fts.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

test_folder folder_make(void)
{
    test_folder folder = {.path = "photographs-XXXXXX"};
    assert_non_null(mkdtemp(folder.path));
    snprintf(folder.dataset, sizeof folder.dataset, "%s/out.btf.h5", folder.path);
    return folder;
}

void folder_remove(const test_folder *folder)
{
    char *const roots[] = {(char *)folder->path, NULL};
    FTS *tree = fts_open(roots, FTS_PHYSICAL | FTS_NOCHDIR, NULL);
    for (FTSENT *entry; (entry = fts_read(tree));) {
        if (entry->fts_info != FTS_D)
            remove(entry->fts_path);
    }
    fts_close(tree);
}

static void path_of(const test_folder *folder, const char *name, char path[512])
{
    snprintf(path, 512, "%s/%s", folder->path, name);
    char *slash = strrchr(path, '/');
    *slash = 0;
    mkdir(path, 0777);
    *slash = '/';
}

void folder_put_image(const test_folder *folder, const char *name, const weft_image *image)
{
    char path[512];
    path_of(folder, name, path);
    weft_error error = {0};
    if (weft_image_write(path, image, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.message);
}

void folder_put_grey(const test_folder *folder, const char *name, int width, int height, float value)
{
    weft_image image;
    assert_int_equal(weft_image_create(width, height, &image, NULL), WEFT_OK);
    for (int i = 0; i < 3 * width * height; i++)
        image.pixels[i] = value;
    folder_put_image(folder, name, &image);
    weft_image_free(&image);
}

void folder_put_text(const test_folder *folder, const char *name, const char *text)
{
    char path[512];
    path_of(folder, name, path);
    assert_int_equal(weft_write_file(path, text, strlen(text), NULL), WEFT_OK);
}

void folder_truncate(const test_folder *folder, const char *name)
{
    char path[512];
    path_of(folder, name, path);
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(truncate(path, status.st_size / 2), 0);
}

weft_code folder_import(const test_folder *folder, const weft_import_options *options, weft_error *error)
{
    weft_import_options defaults = weft_import_defaults();
    weft_import_report report;
    weft_code code = weft_import(folder->path, folder->dataset, options ? options : &defaults, NULL, &report, error);
    if (code == WEFT_OK)
        weft_import_report_free(&report);
    return code;
}

imported folder_open(const test_folder *folder)
{
    imported import = {0};
    weft_error error = {0};
    if (weft_dataset_open(folder->dataset, &import.dataset, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    import.layout = weft_dataset_get_layout(import.dataset);
    size_t count = (size_t)import.layout->width * (size_t)import.layout->height * (size_t)import.layout->image_count;
    import.samples = malloc(3 * count * sizeof *import.samples);
    import.mask = malloc(count);
    assert_int_equal(weft_dataset_read_block(import.dataset, 0, 0, import.layout->width, import.layout->height,
                                             import.samples, import.mask, &error),
                     WEFT_OK);
    return import;
}

void imported_close(imported *import)
{
    weft_dataset_close(import->dataset);
    free(import->samples);
    free(import->mask);
}

static size_t index_of(const imported *import, int x, int y, int image)
{
    return ((size_t)y * (size_t)import->layout->width + (size_t)x) * (size_t)import->layout->image_count +
           (size_t)image;
}

float imported_sample(const imported *import, int x, int y, int image, int channel)
{
    return weft_float_of_half(import->samples[3 * index_of(import, x, y, image) + (size_t)channel]);
}

uint8_t imported_mask(const imported *import, int x, int y, int image)
{
    return import->mask[index_of(import, x, y, image)];
}

int imported_image(const imported *import, double tl, double pl, double tv, double pv)
{
    weft_vec3 light = weft_direction_of_angles((weft_angles){weft_rad_of_deg(tl), weft_rad_of_deg(pl)});
    weft_vec3 view = weft_direction_of_angles((weft_angles){weft_rad_of_deg(tv), weft_rad_of_deg(pv)});
    for (int i = 0; i < import->layout->image_count; i++) {
        weft_vec3 at = import->layout->view[import->layout->view_of_image[i]];
        if (weft_dot(import->layout->light[i], light) > 1 - 1e-9 && weft_dot(at, view) > 1 - 1e-9)
            return i;
    }
    fail_msg("no image for tl %g pl %g tv %g pv %g", tl, pl, tv, pv);
    return -1;
}
